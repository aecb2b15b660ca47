// Hashes of bytes: names for what depends on files and texts.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace duet {

/// A hash of a state and bytes: their number, then eight at a time. To be chained.
std::uint64_t hash_bytes(std::uint64_t state, std::string_view bytes);

/// 16 digits.
std::string hexadecimal(std::uint64_t value);

} // namespace duet
