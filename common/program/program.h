// This file holds what all programs of the project share: exit codes, interruption and progress.
#pragma once

#include "common/system/control.h"

#include <atomic>
#include <functional>
#include <string>

namespace duet {

inline constexpr int kExitOk = 0;       ///< done
inline constexpr int kExitFailed = 1;   ///< a comparison exceeds its threshold, or a result cannot be written
inline constexpr int kExitUnusable = 2; ///< unusable arguments or input
inline constexpr int kExitInterrupted = 130;

/// Runs the program's body and returns its exit code. An exception becomes one line on standard error, `NAME:
/// message`, and an exit code.
int run_program(const std::string& name, const std::function<int()>& body);

/// During the lifetime of an InterruptFlag, SIGINT and SIGTERM set a flag instead of terminating the program. A
/// second signal terminates it. Only one InterruptFlag may exist at a time.
class InterruptFlag {
public:
    InterruptFlag();
    ~InterruptFlag();
    InterruptFlag(const InterruptFlag&) = delete;
    InterruptFlag& operator=(const InterruptFlag&) = delete;

    const std::atomic<bool>& flag() const;
    bool raised() const { return flag().load(); }
};

/// A ProgressBar is a line on standard error with a bar, the elapsed time and the remaining time. It prints nothing
/// where standard error is not a terminal, or where `quiet` is set.
class ProgressBar {
public:
    ProgressBar(std::string label, bool quiet);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// Redraws the line, at most ten times a second. fraction is in [0, 1].
    void update(double fraction);
    /// Returns a control that updates the bar during step `step` of `steps` equal ones, and that `interrupt` stops.
    Control control(const InterruptFlag& interrupt, std::size_t step = 0, std::size_t steps = 1);
    /// Erases the line.
    void finish();

private:
    std::string label_;
    bool visible_;
    double start_, last_drawn_ = -1;
};

/// Formats a duration, for example "850 ms", "12.3 s", "4 min 05 s" or "2 h 07 min".
std::string format_duration(double seconds);

} // namespace duet
