// Implements the random walk of a path inside a solid with subsurface scattering (common/material/subsurface.h).
#pragma once

#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/path_state.h"

#include <optional>

namespace duet::raytrace {

/// Describes the surface at which a path leaves a solid.
struct SolidExit {
    Ray ray;     ///< the last segment of the walk, which arrives from inside
    Ray outside; ///< ray of a viewer in front of the surface, with the same hit
    Hit hit;
    int collisions = 0; ///< number of collisions of the walk
};

/// Describes a solid that a path has entered.
struct EnteredSolid {
    SolidInterior interior;   ///< interior at the point of entry
    std::uint32_t object = 0; ///< index into Scene::objects
};

/// Follows a path that has entered a solid until it leaves through a surface with subsurface scattering, which may
/// belong to another solid. `ray` starts inside, and `hit` is its hit. Returns nothing if the path ends inside. `path`
/// is multiplied by the weight of the walk, and u in [0, 1) decides it.
///
/// The distances between collisions are drawn in proportion to the transmittance of a channel, which is chosen by the
/// throughput. Solids that overlap, or lie inside each other, count as one, with the interior of the solid that the
/// path has entered first. Other surfaces inside, such as the eyes in a head, reflect light diffusely by their base
/// color; `emitted` is increased by their emission times the throughput. Paths of little throughput end by Russian
/// roulette, and all paths end after 30,000 rays: in a white solid that is hundreds of mean free paths deep, 1 % of the
/// light is lost. Paths that leave an open mesh through its hole end as far from the scene as the scene is large.
std::optional<SolidExit> random_walk(const RenderPlan& plan, const EnteredSolid& solid, Ray ray, Hit hit, float u,
                                     PathThroughputT<float>& path, Rgb& emitted, RayCounts& counts);

} // namespace duet::raytrace
