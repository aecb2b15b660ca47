// The surface points of the paths of a batch.
#pragma once

#include "common/geometry/surface_point.h"
#include "raytrace/wavefront/lanes.h"

namespace duet::raytrace::lanes {

#if XSIMD_WITH_AVX

/// Returns the geometry of the points that the paths have hit on surfaces of this form, one path per lane.
SurfaceGeometryT<Floats> surface_points(std::span<const BatchPath> paths, PlainSurfaces::Form form);

#endif

} // namespace duet::raytrace::lanes
