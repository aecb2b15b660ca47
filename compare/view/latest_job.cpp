#include "compare/view/latest_job.h"

#include <utility>

namespace duet::compare {

LatestJob::LatestJob() : thread_([this] { run(); }) {}

LatestJob::~LatestJob() {
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void LatestJob::start(Job job) {
    {
        const std::lock_guard lock(mutex_);
        waiting_ = std::move(job);
        stop_ = true;
    }
    changed_.notify_all();
}

bool LatestJob::busy() const {
    const std::lock_guard lock(mutex_);
    return running_ || waiting_;
}

void LatestJob::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return waiting_ || ended_; });
        if (ended_) return;
        Job job = std::exchange(waiting_, nullptr);
        running_ = true;
        stop_ = false;
        lock.unlock();
        job(stop_);
        job = nullptr; // frees the job's captures, outside of the lock
        lock.lock();
        running_ = false;
    }
}

} // namespace duet::compare
