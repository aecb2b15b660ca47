// Finds the sun in an image of the environment. As a light of its own it casts shadows, which probes and spherical
// harmonics are too coarse for (Debevec 2005, "A Median Cut Algorithm for Light Probe Sampling", turns all of an image
// into such lights).
#pragma once

#include "common/light/environment.h"
#include "common/light/light.h"

#include <optional>

namespace duet::raster {

/// Represents the brightest disk of the environment by a light, which sends what the disk adds to its surroundings.
struct EnvironmentSun {
    SunLight light;
    float sine;          ///< sine of the angular radius of an even disk whose light is spread as far
    Rgb around;          ///< mean radiance around the disk, in W/(m² sr)
    float cosine_radius; ///< cosine of the angle between the sun's direction and the disk's edge

    /// Returns the radiance that arrives from unit directions w if `light` replaces the disk. `radiance` is that of the
    /// environment.
    template <typename T> RgbT<T> without_sun(const Vec3T<T>& w, const RgbT<T>& radiance) const {
        const auto in_disk = -dot(w, broadcast<T>(light.direction)) > T(cosine_radius);
        const auto channel = [&](const T& all, float rest) { return select(in_disk, min(all, T(rest)), all); };
        return {channel(radiance.r, around.r), channel(radiance.g, around.g), channel(radiance.b, around.b)};
    }
};

/// Returns the sun of an image, or nothing if no small disk is bright enough to cast a visible shadow, or if the image
/// is too coarse to show one. The result is the same for any number of threads.
std::optional<EnvironmentSun> find_sun(const Environment& environment, int threads);

} // namespace duet::raster
