// A batch advances several paths at surfaces of one kind (BatchedSurfaces) together with SIMD, one path per lane.
#pragma once

#include "common/vec/simd.h"
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/path_state.h"
#include "raytrace/wavefront/shadow_rays.h"

#include <span>

namespace duet::raytrace {

/// This is the number of paths in a batch, which is the number of lanes of doubles.
inline constexpr std::size_t kPathLanes = kDoubleLanes;

/// Describes one path of a batch. It refers to data of the caller.
struct BatchPath {
    std::uint32_t index; ///< identifies the path of a shadow ray
    Ray* ray;       ///< the ray that has hit; the next ray if the path continues
    const Hit* hit; ///< the hit of that ray
    const Shape* shape; ///< shape at the hit
    const Bsdf* bsdf;   ///< BSDF at the hit
    const VertexRandomSamples* random_samples;
    PathState* state;
    bool continues = false;
};

/// Says which pairs of VertexRandomSamples that are drawn for a batch.
struct UsedDimensions {
    bool direction = false, light = false, lobe = false, roulette = false;
};
/// Returns what paths at surfaces of this scattering use after `depth` scatterings.
UsedDimensions used_dimensions(const RenderPlan& plan, BatchedSurfaces::BsdfKind scattering, int depth);

/// Advances up to kPathLanes paths at surfaces of one kind of plan.batched, after `depth` < plan.max_depth scatterings,
/// as Path::advance does one path. Shadow rays are added to `shadows`, to be traced later. The result for each path is
/// bit-equal to that for the path alone: the formulas are the same templates (path.h), and all operations are rounded
/// the same in every lane.
void advance_batch(const RenderPlan& plan, BatchedSurfaces::Kind kind, std::span<BatchPath> paths, int depth,
                   ShadowRays& shadows, RayCounts& counts);

} // namespace duet::raytrace
