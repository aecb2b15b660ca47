// Renders an image sample by sample, for a window that shows it while it converges.
#pragma once

#include "raytrace/film/film.h"
#include "raytrace/render.h"

namespace duet::raytrace {

/// Keeps the film of one view in memory between steps. After n samples per pixel its film equals that of render() with
/// n samples per pixel, bit for bit, unless render() varies the number from pixel to pixel.
class ProgressiveRender {
public:
    /// Throws Error for the same settings as render(), and for settings with a film file, adaptive sampling, or a
    /// sampler that needs the number of samples.
    ProgressiveRender(const PathTracerScene& prepared, const View& view, const PathTracerSettings& settings);
    ~ProgressiveRender();

    /// Adds `samples` samples to each pixel. If `control` stops it, returns false: some pixels then have fewer samples,
    /// and the next call first adds the missing ones.
    bool add_samples(std::uint32_t samples, Control& control);
    /// Returns the film with the samples so far. No samples may be added while it is read.
    const Film& film() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace duet::raytrace
