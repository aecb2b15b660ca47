// Limits the resolution of the images that prepare() renders once for all views to what the scene's image can show.
// Thus a small image of a scene with many lights and mirrors takes little time.
#pragma once

#include "common/scene/scene.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace duet::raster {

/// Derives limits from the number of pixels of the scene's image.
struct PrepareLimits {
    explicit PrepareLimits(const Scene& scene)
        : pixels_(static_cast<std::int64_t>(scene.width) * scene.height) {}

    /// Returns the side of shadow maps. They have at most 64 texels per pixel of the image.
    int shadow_map_side(int finest) const { return std::min(finest, power_of_two(8)); }
    /// Returns the side of radiance maps of reflections, and of the shapes of glass objects. They have at most 16
    /// texels per pixel of the image. Above a side of 256 they have at most one, because a sphere of few pixels shows a
    /// whole map and would skip most of its texels.
    int radiance_map_side(int finest) const {
        return std::min({finest, power_of_two(4), std::max(256, power_of_two(1))});
    }
    /// Returns the number of irradiance probes, about one per 16 pixels at most.
    int irradiance_probes(int most) const { return at_most(most, pixels_ / 16); }
    /// Returns the number of reflection probes, at most one per 64 pixels.
    int reflection_probes(int most) const { return at_most(most, pixels_ / 64); }

private:
    /// Returns the largest power of two up to `factor` times the side of a square image with that many pixels, and at
    /// least 64.
    int power_of_two(double factor) const {
        const double side = factor * std::sqrt(static_cast<double>(pixels_));
        return static_cast<int>(std::bit_floor(static_cast<unsigned>(std::max(side, 64.0))));
    }
    static int at_most(int most, std::int64_t pixels) {
        return static_cast<int>(std::clamp<std::int64_t>(pixels, 1, most));
    }

    std::int64_t pixels_;
};

} // namespace duet::raster
