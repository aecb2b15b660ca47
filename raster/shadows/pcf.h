// Computes shadows of point, spot and sun lights with SIMD: percentage-closer filtering (Reeves, Salesin and Cook 1987,
// "Rendering Antialiased Shadows with Depth Maps") with receiver plane depth bias (Isidoro 2006, "Shadow Mapping:
// GPU-based Tips and Techniques").
#pragma once

#include "raster/geometry/packet.h"
#include "raster/shadows/shadow_map.h"

namespace duet::raster {

/// Samples one shadow map at points relative to an eye.
class SharpShadowMap {
public:
    SharpShadowMap(const ShadowMap& map, const Vec3d& eye);

    /// Returns the lit fraction of points with unit normals, over 4 × 4 texels with the weights of the quadratic
    /// B-spline, or over a box of 4 × 4 texels if the map is dithered. `inside` receives the lanes that lie in the map;
    /// other lanes are unspecified.
    Floats visibility(const Vec3T<Floats>& p, const Vec3T<Floats>& n, xsimd::batch_bool<float>& inside) const;
    /// Returns the lit fraction of points in space, which have no normal, interpolated between the four nearest texels.
    Floats visibility(const Vec3T<Floats>& p, xsimd::batch_bool<float>& inside) const;

private:
    struct Texels {
        Floats x, y, depth; ///< position in the map, and depth of a point
    };
    Texels texels(const Vec3T<Floats>& p, xsimd::batch_bool<float>& inside) const;
    /// Represents the receiver's plane as a linear function of texel coordinates, in the units of the map's values.
    struct Plane {
        Floats at, dx, dy, rounding;
        Floats rising, falling, steepest; ///< tolerances per texel of distance
    };
    Plane plane(const Floats& x, const Floats& y, const Floats& depth, const Vec3T<Floats>& n) const;

    const ShadowMap& map_;
    std::array<Vec4, 4> to_texel_; ///< maps points relative to the eye to (x·w, y·w, depth, w)
    Vec3 direction_, direction_dx_, direction_dy_, origin_dx_, origin_dy_;
    float near_;
};

} // namespace duet::raster
