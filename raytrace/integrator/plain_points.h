// The points of plain surfaces that paths side by side stand at: of a SurfacePoint, what such a surface has, to the same
// bits.
#pragma once

#include "common/geometry/surface_point.h"
#include "common/vec/robust_batch.h"
#include "raytrace/integrator/lanes.h"

namespace duet::raytrace::lanes {

#if XSIMD_WITH_AVX

/// Where the shading normal is the geometric one.
struct FlatPoints {
    Vec p, p_error, ng;

    const Vec& ns() const { return ng; }
    const Vec& horizon() const { return ng; }
    /// As offset_origin of a SurfacePoint.
    Vec origin(const Vec& w) const {
        return offset_origin(p, p_error, select(dot(w, ng) < Floats(0.0f), -ng, ng));
    }
};

/// Of meshes with normals of their own.
struct SmoothPoints {
    Vec p, p_error, ng, shading, above, lift; ///< as SurfacePoint has ns and horizon

    const Vec& ns() const { return shading; }
    const Vec& horizon() const { return above; }
    Vec origin(const Vec& w) const;
};

/// All of one kind of PlainSurfaces: on quads and meshes without normals, on meshes with them, on spheres.
FlatPoints flat_points(std::span<const PlainPath> paths);
SmoothPoints smooth_points(std::span<const PlainPath> paths);
FlatPoints round_points(std::span<const PlainPath> paths);

#endif

} // namespace duet::raytrace::lanes
