// What a caller holds in its hand while a rendering runs: it can stop it and watch it.
#pragma once

#include <atomic>
#include <functional>

namespace duet {

/// Passed to both pipelines' render functions.
struct Control {
    /// Set by a signal handler or another thread; the renderer finishes the tiles at hand and returns what it has.
    const std::atomic<bool>* stop = nullptr;
    /// Called with the fraction done, in [0, 1], never decreasing, from any thread but one call at a time; may be
    /// empty.
    std::function<void(double)> progress;

    bool stopped() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
    void report(double fraction) const {
        if (progress) progress(fraction);
    }
};

} // namespace duet
