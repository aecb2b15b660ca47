#include "compare/frames/cpu_affinity.h"

#include "common/system/error.h"

#include <cstdlib>
#include <filesystem>

namespace duet::compare {
namespace {

/// Sets the affinity of all threads, including those of libraries. Errors for threads that have just ended are ignored.
void set_for_all_threads(const cpu_set_t& set) {
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
        sched_setaffinity(std::atoi(task.path().filename().c_str()), sizeof(set), &set);
}

} // namespace

CpuAffinity::CpuAffinity(int count) {
    sched_getaffinity(0, sizeof(before_), &before_);
    cpu_set_t chosen;
    CPU_ZERO(&chosen);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&chosen) < count; ++i)
        if (CPU_ISSET(i, &before_)) CPU_SET(i, &chosen);
    if (CPU_COUNT(&chosen) < count)
        throw Error(message(count, " threads: this process may use ", CPU_COUNT(&before_), " processors"));
    set_for_all_threads(chosen);
}

CpuAffinity::~CpuAffinity() { set_for_all_threads(before_); }

int CpuAffinity::available() {
    cpu_set_t set;
    sched_getaffinity(0, sizeof(set), &set);
    return CPU_COUNT(&set);
}

} // namespace duet::compare
