// Path vertices on matt surfaces, several side by side: each number of theirs is a lane of a batch.
#pragma once

#include "common/vec/simd.h"
#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/path_state.h"

#include <span>

namespace duet::raytrace {

/// As many go side by side as the machine has lanes of doubles.
inline constexpr std::size_t kMattLanes = kDoubleLanes;

/// One of the paths that stand at such vertices. Refers to what the caller keeps.
struct MattPath {
    Ray* ray;       ///< that has arrived; if the path goes on, the one that goes on
    const Hit* hit; ///< that it has found
    const VertexNumbers* numbers;
    PathState* state;
    Rgb light{};    ///< that the vertex adds to the path
    bool goes_on = false;
};

/// Scatters up to kMattLanes paths at surfaces of one kind of plan.matt (never kNone), after `depth` < plan.max_depth
/// scatterings. What happens to each is what happens to it alone (path.cpp), to the same bits: all that is used is
/// rounded the same in every lane, and most of it is the very same functions, written over their number type.
void scatter_matt(const RenderPlan& plan, MattSurfaces::Kind kind, std::span<MattPath> paths, int depth,
                  RayCounts& counts);

} // namespace duet::raytrace
