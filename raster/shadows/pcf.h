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
    /// Returns the surface points, relative to the eye, that the texels at points see at their centers. The map must be
    /// orthographic. A point outside of the map gets the nearest texel. The surface is very far away if the texel sees
    /// nothing.
    Vec3T<Floats> surface(const Vec3T<Floats>& p) const;
    /// Returns the depth of points in the map, in meters from the side of the light. `inside` receives the lanes that
    /// lie in the map with their surroundings, up to `spread` times their depth. The map must be orthographic.
    Floats depth(const Vec3T<Floats>& p, float spread, xsimd::batch_bool<float>& inside) const;
    const Vec3& direction() const { return direction_; } ///< of light, if the map is orthographic; unit
    float texel() const { return length(origin_dx_); }   ///< width of a texel in meters, if the map is orthographic
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
