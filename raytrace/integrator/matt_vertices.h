// Path vertices on matt surfaces, several side by side: each number of theirs is a lane of a batch.
#pragma once

#include "common/vec/simd.h"
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/path_state.h"
#include "raytrace/integrator/shadow_rays.h"

#include <span>

namespace duet::raytrace {

/// As many go side by side as the machine has lanes of doubles.
inline constexpr std::size_t kMattLanes = kDoubleLanes;

/// One of the paths that stand at such vertices. Refers to what the caller keeps.
struct MattPath {
    std::uint32_t index; ///< by which its shadow rays are known
    Ray* ray;       ///< that has arrived; if the path goes on, the one that goes on
    const Hit* hit; ///< that it has found
    const VertexNumbers* numbers;
    PathState* state;
    bool goes_on = false;
};

/// Scatters up to kMattLanes paths at surfaces of one kind of plan.matt (never kNone), after `depth` < plan.max_depth
/// scatterings; shadow rays are left to be sent. What happens to each is what happens to it alone (path.cpp), to the same bits: all that is used is
/// rounded the same in every lane, and most of it is the very same functions, written over their number type.
void scatter_matt(const RenderPlan& plan, MattSurfaces::Kind kind, std::span<MattPath> paths, int depth,
                  ShadowRays& shadows, RayCounts& counts);

} // namespace duet::raytrace
