// These functions compute hashes of bytes, which serve as names for data that depend on files and texts.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace duet {

/// Returns a hash of a state, the number of bytes and the bytes, taken eight at a time. Calls can be chained: pass the
/// result as the next state. The result depends on the byte order of the CPU.
std::uint64_t hash_bytes(std::uint64_t state, std::string_view bytes);

/// Formats a number as 16 lowercase hexadecimal digits.
std::string to_hex(std::uint64_t value);

} // namespace duet
