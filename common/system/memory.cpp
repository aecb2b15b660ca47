#include "common/system/memory.h"

#include <algorithm>

#include <sys/resource.h>
#include <unistd.h>

namespace duet {

std::int64_t peak_memory_bytes() {
    rusage usage{};
    if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return std::int64_t{1024} * usage.ru_maxrss; // Linux counts it in KiB
}

void limit_memory() {
#if defined(_SC_PHYS_PAGES) && defined(RLIMIT_AS) && !defined(__SANITIZE_ADDRESS__) && !defined(__EMSCRIPTEN__)
    const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
    rlimit limit{};
    if (pages <= 0 || page <= 0 || ::getrlimit(RLIMIT_AS, &limit) != 0) return;
    limit.rlim_cur = std::min(limit.rlim_cur, static_cast<rlim_t>(pages) * static_cast<rlim_t>(page));
    ::setrlimit(RLIMIT_AS, &limit); // a failure leaves the program without a limit, as before
#endif
}

} // namespace duet
