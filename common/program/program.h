// What every program of the project does around its work: exit codes, interruption, progress.
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace duet {

inline constexpr int kExitOk = 0;       ///< done
inline constexpr int kExitFailed = 1;   ///< a comparison over its threshold, a result that could not be written
inline constexpr int kExitUnusable = 2; ///< arguments or input that cannot be used
inline constexpr int kExitInterrupted = 130;

/// Runs the program's body and turns what it throws into one line on standard error, `NAME: message`, and an exit code.
int run_program(const std::string& name, const std::function<int()>& body);

/// While it lives, SIGINT and SIGTERM set a flag instead of ending the program; a second signal ends it. One at a time.
class InterruptFlag {
public:
    InterruptFlag();
    ~InterruptFlag();
    InterruptFlag(const InterruptFlag&) = delete;
    InterruptFlag& operator=(const InterruptFlag&) = delete;

    const std::atomic<bool>& flag() const;
    bool raised() const { return flag().load(); }
};

/// A line on standard error with a bar, the time gone and the time left; silent where standard error is no terminal, or
/// on request.
class ProgressBar {
public:
    ProgressBar(std::string label, bool quiet);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// fraction in [0, 1]; redraws at most ten times a second.
    void update(double fraction);
    /// Erases the line.
    void finish();

private:
    std::string label_;
    bool visible_;
    double start_, last_drawn_ = -1;
};

/// "850 ms", "12.3 s", "4 min 05 s", "2 h 07 min".
std::string readable_seconds(double seconds);

} // namespace duet
