// What a rough metal mirrors of the environment.
#pragma once

#include "common/light/environment.h"

#include <array>
#include <vector>

namespace duet::raster {

/// The environment seen through GGX lobes about each direction: the first factor of the split sum (Karis 2013, «Real
/// Shading in Unreal Engine 4»), in which viewer and normal are taken to be the lobe's axis. Constant environments and
/// skies, which are linear in the direction, exactly; of a picture a map for each of several roughnesses, in between
/// interpolated.
class Prefiltered {
public:
    /// Filters a picture, in parallel; the result is the same for any number of threads.
    Prefiltered(const Environment& environment, int threads);

    /// Radiance about w (unit). `environment` is the one it was made for. alpha in (0, 1].
    Rgb at(const Environment& environment, Vec3 w, float alpha) const;
    std::int64_t memory_bytes() const;

    /// The axis that stands for a lobe: between mirror direction and normal, the closer to this the rougher (Lagarde
    /// and de Rousiers 2014, «Moving Frostbite to Physically Based Rendering», §4.9.3).
    static Vec3 axis(Vec3 normal, Vec3 mirrored, float alpha);

    static constexpr int kMaps = 6; ///< roughness 1/6, 2/6 … 1; smoother ones are blended with the picture itself
    static constexpr int kSamples = 256;

private:
    std::vector<ImageRgb> maps_;
    std::array<float, 33> mean_cosine_{}; ///< of a sky's lobes, by roughness in equal steps
};

} // namespace duet::raster
