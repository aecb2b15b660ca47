// This file declares how much memory the program has used, and limits it.
#pragma once

#include <cstdint>

namespace duet {

/// Returns the most memory, in bytes, that the program has held at once so far, as the operating system counts it: with
/// its code, its libraries and what it read. It is 0 where the system does not tell.
std::int64_t peak_memory_bytes();

/// Makes allocations throw std::bad_alloc from where the program would hold more than the computer's memory and swap
/// space. Without a limit, the system would end the program, or another one, without a message. The limit also holds
/// for programs that this one starts. It exists on Linux, but not with the address sanitizer, which reserves more.
void limit_memory();

} // namespace duet
