// This file defines how a caller stops a running render and receives its progress.
#pragma once

#include <atomic>
#include <functional>

namespace duet {

/// The render functions of both pipelines take a Control. With the default values, a render runs to its end in silence.
struct Control {
    /// A signal handler or another thread sets this flag to stop the render. The renderer then finishes the tiles in
    /// progress and returns the result so far. A null pointer means that the render cannot be stopped.
    const std::atomic<bool>* stop = nullptr;
    /// The renderer calls this function with the completed fraction in [0, 1], which never decreases. Calls come from
    /// any thread, but one at a time. The function may be empty.
    std::function<void(double)> progress;

    bool stopped() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
    void report(double fraction) const {
        if (progress) progress(fraction);
    }
};

} // namespace duet
