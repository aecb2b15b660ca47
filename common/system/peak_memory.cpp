#include "common/system/peak_memory.h"

#include <sys/resource.h>

namespace duet {

std::int64_t peak_memory_bytes() {
    rusage usage{};
    if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return std::int64_t{1024} * usage.ru_maxrss; // Linux counts it in KiB
}

} // namespace duet
