// Where on its sphere each of sixteen samples lies, side by side.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/geometry/sphere.h"
#include "raster/shader/strip_shader.h"

namespace duet::raster {

/// As find_hit() and surface_point() have it for one sample. In the sphere's own space; samples that see something else have any.
struct SphereStrip {
    using Vectors = std::array<StripOf<float>, 3>;

    Vectors n; ///< of the sphere, unit, where each sample sees it
    /// If asked for: below the points where the rays through the next pixels, to the right and down, meet its tangent plane.
    Vectors n_right, n_down;
    StripOf<float> side;  ///< 1 where it is seen from outside, -1 from inside
    StripOf<float> depth; ///< camera-space −z

    SphereStrip(const PassView& view, const StripPlace& place, const DrawSphere& sphere, bool steps);
};

} // namespace duet::raster
