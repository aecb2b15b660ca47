// How fine the images are that prepare() renders once for all views: no finer than the scene's image can show. So a
// small image of a scene with many lights and mirrors costs little.
#pragma once

#include "common/scene/scene.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace duet::raster {

/// Limits by the number of pixels of the scene's image. An image of 256 × 256 pixels or more has none of them, but for
/// the largest radiance maps.
struct PrepareLimits {
    explicit PrepareLimits(const Scene& scene)
        : pixels_(static_cast<std::int64_t>(scene.width) * scene.height) {}

    /// Shadow maps have at most 64 texels for a pixel of the image.
    int shadow_map_side(int finest) const { return std::min(finest, power_of_two(8)); }
    /// Radiance maps of reflections, and the shapes of glass objects, have at most 16 texels for a pixel; above a side
    /// of 256 at most one, because a ball of few pixels shows a whole map, and would skip most of its texels.
    int radiance_map_side(int finest) const {
        return std::min({finest, power_of_two(4), std::max(256, power_of_two(1))});
    }
    /// There is at most one irradiance probe for 16 pixels.
    int irradiance_probes(int most) const { return at_most(most, pixels_ / 16); }
    /// There is at most one reflection probe for 64 pixels.
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
