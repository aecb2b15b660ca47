// This file renders an image sample by sample, for a window that shows it while it converges.
#pragma once

#include "raytrace/film/film.h"
#include "raytrace/render.h"

namespace duet::raytrace {

/// A ProgressiveRender keeps the film of one view in memory between steps. After n samples per pixel its film equals
/// that of render() with n samples per pixel, bit for bit, unless render() varies their number from pixel to pixel.
class ProgressiveRender {
public:
    /// Throws Error as render() does, and for settings with a film file, adaptive sampling, or a sampler whose samples
    /// depend on how many there are.
    ProgressiveRender(const PathTracerScene& prepared, const View& view, const PathTracerSettings& settings);
    ~ProgressiveRender();

    /// Adds `samples` samples to each pixel. If `control` stops it, returns false: some pixels then have fewer samples,
    /// and the next call takes those first.
    bool add_samples(std::uint32_t samples, Control& control);
    /// Returns the samples so far. Nothing may add samples while it is read.
    const Film& film() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace duet::raytrace
