// This file declares the program's greatest use of memory.
#pragma once

#include <cstdint>

namespace duet {

/// Returns the most memory, in bytes, that the program has held at once so far, as the operating system counts it: with
/// its code, its libraries and what it read. It is 0 where the system does not tell.
std::int64_t peak_memory_bytes();

} // namespace duet
