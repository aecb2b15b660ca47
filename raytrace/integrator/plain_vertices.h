// Path vertices on plain surfaces, several side by side: each number of theirs is a lane of a batch.
#pragma once

#include "common/vec/simd.h"
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/path_state.h"
#include "raytrace/integrator/shadow_rays.h"

#include <span>

namespace duet::raytrace {

/// As many go side by side as the machine has lanes of doubles.
inline constexpr std::size_t kPathLanes = kDoubleLanes;

/// One of the paths that stand at such vertices. Refers to what the caller keeps.
struct PlainPath {
    std::uint32_t index; ///< by which its shadow rays are known
    Ray* ray;       ///< that has arrived; if the path goes on, the one that goes on
    const Hit* hit; ///< that it has found
    const Shape* shape; ///< there
    const Bsdf* bsdf;   ///< of it
    const VertexNumbers* numbers;
    PathState* state;
    bool goes_on = false;
};

/// Which pairs of VertexNumbers are drawn for them.
struct NumbersUsed {
    bool direction = false, light = false, lobe = false, roulette = false;
};
/// Of paths at surfaces that scatter so, after `depth` scatterings.
NumbersUsed numbers_used(const RenderPlan& plan, PlainSurfaces::Scattering scattering, int depth);

/// Scatters up to kPathLanes paths at surfaces of one kind of plan.plain, after `depth` < plan.max_depth scatterings;
/// shadow rays are left to be sent. What happens to each is what happens to it alone (path.h), to the same bits: all that is
/// used is rounded the same in every lane, and most of it is the very same functions, written over their number type.
void scatter_plain(const RenderPlan& plan, PlainSurfaces::Kind kind, std::span<PlainPath> paths, int depth,
                  ShadowRays& shadows, RayCounts& counts);

} // namespace duet::raytrace
