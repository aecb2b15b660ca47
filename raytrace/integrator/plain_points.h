// These are the surface points of paths at batched surfaces (PlainSurfaces), one path per lane. They have the
// members of SurfacePoint that such surfaces need, bit-equal.
#pragma once

#include "common/geometry/surface_point.h"
#include "common/vec/robust_batch.h"
#include "raytrace/integrator/lanes.h"

namespace duet::raytrace::lanes {

#if XSIMD_WITH_AVX

/// Holds points whose shading normal is the geometric normal.
struct FlatPoints {
    Vec p, p_error, ng;

    const Vec& ns() const { return ng; }
    const Vec& horizon() const { return ng; }
    /// Returns the origin of a ray toward w, like offset_origin of a SurfacePoint.
    Vec origin(const Vec& w) const {
        return offset_origin(p, p_error, select(dot(w, ng) < Floats(0.0f), -ng, ng));
    }
};

/// Holds points of meshes with vertex normals.
struct SmoothPoints {
    Vec p, p_error, ng, shading, above, lift; ///< `shading` and `above` are SurfacePoint's ns and horizon

    const Vec& ns() const { return shading; }
    const Vec& horizon() const { return above; }
    Vec origin(const Vec& w) const;
};

/// These compute the points of paths at surfaces of one PlainSurfaces::Form: quads and meshes without vertex
/// normals, meshes with vertex normals, and spheres.
FlatPoints flat_points(std::span<const PlainPath> paths);
SmoothPoints smooth_points(std::span<const PlainPath> paths);
FlatPoints round_points(std::span<const PlainPath> paths);

#endif

} // namespace duet::raytrace::lanes
