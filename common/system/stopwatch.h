// This file defines a stopwatch for wall-clock time.
#pragma once

#include <chrono>

namespace duet {

/// Measures wall-clock time.
class Stopwatch {
public:
    /// Returns the seconds since construction or the last call of restart() or lap().
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    void restart() { start_ = Clock::now(); }
    /// Returns the same as seconds() and restarts the stopwatch.
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
