// This file declares LatestJob, which runs the newest of the jobs that it is given, on a thread of its own.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace duet::compare {

/// A LatestJob suits a window, in which each new request makes the previous one obsolete: a new job stops the running
/// job and replaces the waiting one.
class LatestJob {
public:
    /// The argument is set when the job must stop. A job handles its own exceptions.
    using Job = std::function<void(const std::atomic<bool>& stop)>;

    LatestJob();
    /// Stops the running job, and waits for its end.
    ~LatestJob();
    LatestJob(const LatestJob&) = delete;
    LatestJob& operator=(const LatestJob&) = delete;

    /// Runs a job as soon as the running one has ended.
    void start(Job job);
    /// Returns whether a job runs or waits.
    bool busy() const;

private:
    void run();

    mutable std::mutex mutex_; // guards all members below except stop_
    std::condition_variable changed_;
    Job waiting_;
    bool running_ = false, ended_ = false;
    std::atomic<bool> stop_ = false;
    std::thread thread_; // last: it uses the members above
};

} // namespace duet::compare
