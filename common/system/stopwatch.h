// Wall-clock time.
#pragma once

#include <chrono>

namespace duet {

class Stopwatch {
public:
    /// Seconds since construction or the last restart.
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    void restart() { start_ = Clock::now(); }
    /// Seconds since the last lap (or construction), and starts the next.
    double lap() {
        const double s = seconds();
        restart();
        return s;
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

} // namespace duet
