// Declares batches, which advance several paths at surfaces of one kind (BatchedSurfaces) together with SIMD, one path
// per lane.
#pragma once

#include "raytrace/wavefront/batch_path.h"
#include "raytrace/wavefront/shadow_rays.h"

#include <span>

namespace duet::raytrace {

/// Says which pairs of VertexRandomSamples are drawn for a batch.
struct UsedDimensions {
    bool direction = false, light = false, lobe = false, roulette = false;
};
/// Returns the random samples that paths at surfaces of this scattering use after `depth` scatterings.
UsedDimensions used_dimensions(const RenderPlan& plan, BatchedSurfaces::BsdfKind scattering, int depth);

/// Advances up to kPathLanes paths at surfaces of one kind of plan.batched, after `depth` < plan.max_depth scatterings,
/// in the same way as Path::advance. Shadow rays are added to `shadows`, to be traced later. The result for each path
/// is bit-equal to that of Path: the formulas are the same templates (path.h), and all operations round equally in
/// every lane.
void advance_batch(const RenderPlan& plan, BatchedSurfaces::Kind kind, std::span<BatchPath> paths, int depth,
                   ShadowRays& shadows, RayCounts& counts);

} // namespace duet::raytrace
