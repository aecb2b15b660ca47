// This file controls the CPU affinity of this process's threads.
#pragma once

#include <sched.h>

namespace duet::compare {

/// During its lifetime, all threads of the process, and those they start, run on the first `count` processors
/// that the calling thread could use before. Throws Error if there are fewer.
class CpuAffinity {
public:
    explicit CpuAffinity(int count);
    ~CpuAffinity();
    CpuAffinity(const CpuAffinity&) = delete;
    CpuAffinity& operator=(const CpuAffinity&) = delete;

    /// Returns the number of processors that the calling thread may use.
    static int available();

private:
    cpu_set_t before_;
};

} // namespace duet::compare
