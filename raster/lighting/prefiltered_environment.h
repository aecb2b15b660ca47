// This header declares the prefiltered environment for reflections on rough metal.
#pragma once

#include "common/light/environment.h"

#include <array>
#include <vector>

namespace duet::raster {

/// This is the environment convolved with GGX lobes about each direction: the first factor of the split sum (Karis
/// 2013, "Real Shading in Unreal Engine 4"), which assumes that viewer and normal coincide with the lobe's axis.
/// Constant environments and skies, which are linear in the direction, are exact. An image has a map for each of
/// several roughnesses, with interpolation between them.
class Prefiltered {
public:
    /// Filters an image in parallel; the result is the same for any number of threads.
    Prefiltered(const Environment& environment, int threads);

    /// Returns the prefiltered radiance about the unit vector w. `environment` must be the one given to the
    /// constructor. alpha is in (0, 1].
    Rgb at(const Environment& environment, Vec3 w, float alpha) const;
    std::int64_t memory_bytes() const;

    /// Returns the dominant direction of a lobe. It lies between the mirror direction and the normal, and approaches
    /// the normal as alpha grows (Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering",
    /// §4.9.3).
    static Vec3 axis(Vec3 normal, Vec3 mirror_direction, float alpha);

    static constexpr int kMaps = 6; ///< roughness 1/6, 2/6 … 1; smoother lobes blend with the unfiltered image
    static constexpr int kSamples = 256;

private:
    std::vector<ImageRgb> maps_;
    std::array<float, 33> mean_cosine_{}; ///< of a sky's lobes, at equal steps of roughness
};

} // namespace duet::raster
