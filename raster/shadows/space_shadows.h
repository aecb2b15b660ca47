// Computes shadows at points in space, such as those of fog, by one shadow map lookup without a surface normal.
#pragma once

#include "raster/shadows/shadow_maps.h"

namespace duet::raster {

/// Samples the shadow maps at points in space, for one view at one time.
class SpaceShadows {
public:
    /// Keeps a reference to `data`, which must have its shadow maps.
    SpaceShadows(const RasterSceneData& data, const Vec3d& eye, float time);

    /// Returns the visible fraction of a light, an argument of RasterSceneData::light(), at points relative to the eye.
    /// Each cell of an area light is visible if its center is.
    Floats visibility(std::size_t light, const Vec3T<Floats>& p) const;

private:
    const Shadows& shadows_;
    MapsAtTime maps_;
    Vec3d eye_;
};

} // namespace duet::raster
