// Which processors the threads of this process may use.
#pragma once

#include <sched.h>

namespace duet::compare {

/// While it lives, all threads that the process has, and those they start, share the first `count` of the processors
/// that the calling thread could use before. Throws Error where there are not so many.
class Processors {
public:
    explicit Processors(int count);
    ~Processors();
    Processors(const Processors&) = delete;
    Processors& operator=(const Processors&) = delete;

    /// How many the calling thread may use.
    static int available();

private:
    cpu_set_t before_;
};

} // namespace duet::compare
