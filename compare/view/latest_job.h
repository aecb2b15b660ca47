// LatestJob runs the newest of the jobs that it is given, on a thread of its own.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace duet::compare {

/// A LatestJob serves a window, whose next wish makes the one before pointless: a new job stops the one that runs and
/// replaces the one that waits.
class LatestJob {
public:
    /// The argument is set when the job shall stop. A job handles its own exceptions.
    using Job = std::function<void(const std::atomic<bool>& stop)>;

    LatestJob();
    /// Stops the job that runs, and waits for its end.
    ~LatestJob();
    LatestJob(const LatestJob&) = delete;
    LatestJob& operator=(const LatestJob&) = delete;

    /// Runs a job as soon as the one that runs has ended.
    void start(Job job);
    /// Returns whether a job runs or waits.
    bool busy() const;

private:
    void run();

    mutable std::mutex mutex_; // guards all below but stop_
    std::condition_variable changed_;
    Job waiting_;
    bool running_ = false, ended_ = false;
    std::atomic<bool> stop_ = false;
    std::thread thread_; // last: it uses the members above
};

} // namespace duet::compare
