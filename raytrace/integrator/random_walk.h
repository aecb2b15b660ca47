// The random walk of a path inside of a solid with subsurface scattering (common/material/subsurface.h).
#pragma once

#include "raytrace/integrator/integrator.h"
#include "raytrace/integrator/path_state.h"

#include <optional>

namespace duet::raytrace {

/// The surface at which a path leaves a solid.
struct SolidExit {
    Ray ray;     ///< the last segment of the walk, which arrives from inside
    Ray outside; ///< along which a viewer outside, in front of the surface, has the same hit
    Hit hit;
    int collisions = 0; ///< how often the walk was scattered
};

/// The solid that a path has entered.
struct EnteredSolid {
    SolidInterior interior;   ///< where the path has entered
    std::uint32_t object = 0; ///< index into Scene::objects
};

/// Follows a path that has entered a solid until it leaves it by a surface with subsurface scattering, which may be
/// another one than it has entered. `ray` starts inside, and `hit` is what it hits. Returns nothing if the path ends
/// inside. `path` is multiplied by the weight of the walk, and u in [0, 1) decides it.
///
/// The distances between collisions are drawn in proportion to the light that arrives there, for a channel that is
/// chosen by the throughput. Solids that overlap, or lie inside of each other, count as one, with the interior of the
/// one that the path has entered first. What else is inside, such as the eyes in a head, reflects light diffusely by
/// its base color; `emitted` is increased by what it emits times the throughput. Paths of little throughput end by
/// Russian roulette, and all end after 30,000 rays: in a white solid that is hundreds of mean free paths deep, 1 % of
/// the light is lost.
std::optional<SolidExit> random_walk(const RenderPlan& plan, const EnteredSolid& solid, Ray ray, Hit hit, float u,
                                     PathThroughputT<float>& path, Rgb& emitted, RayCounts& counts);

} // namespace duet::raytrace
