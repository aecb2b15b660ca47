#include "common/system/memory.h"

#include <algorithm>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/sysinfo.h>
#endif

namespace duet {

std::int64_t peak_memory_bytes() {
    rusage usage{};
    if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return std::int64_t{1024} * usage.ru_maxrss; // Linux counts it in KiB
}

void limit_memory() {
#if defined(__linux__)
    struct sysinfo system {};
    rlimit limit{};
    if (::sysinfo(&system) != 0 || ::getrlimit(RLIMIT_AS, &limit) != 0) return;
    const rlim_t memory = rlim_t{system.totalram + system.totalswap} * system.mem_unit;
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages; // all that the program has reserved
    if (pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) > memory) return; // by the address sanitizer
    limit.rlim_cur = std::min(limit.rlim_cur, memory);
    ::setrlimit(RLIMIT_AS, &limit); // a failure leaves the program without a limit, as before
#endif
}

} // namespace duet
