// A medium vertex is a vertex of a path in a medium, which scatters it. It has the same functions as a vertex on a
// surface (vertex.h).
#pragma once

#include "common/medium/phase_function.h"
#include "raytrace/integrator/light_sampling.h"

namespace duet::raytrace {

/// Represents a point at which a medium scatters a path.
struct MediumVertex {
    Vec3 p;
    Vec3 direction; ///< of the ray that arrives, unit
    float time = 0;
    float asymmetry = 0; ///< of the medium's phase function
};

/// Returns the light receiver, which light reaches from all sides.
inline LightReceiver light_receiver(const MediumVertex& vertex) { return {vertex.p, Vec3(0, 0, 0)}; }
/// Returns the phase function. The weight of the collision contains the coefficient of scattering.
inline Rgb scattering(const MediumVertex& vertex, Vec3 wi) {
    return Rgb(phase(vertex.direction, wi, vertex.asymmetry));
}
/// Returns the density, by solid angle, with which the phase function is sampled. It equals the phase function.
inline float scattering_pdf(const MediumVertex& vertex, Vec3 wi) {
    return phase(vertex.direction, wi, vertex.asymmetry);
}
/// Returns a ray from the point in direction w, without an offset.
inline Ray spawn_ray(const RenderPlan&, const MediumVertex& vertex, Vec3 w) {
    Ray ray{vertex.p, w};
    ray.time = vertex.time;
    return ray;
}

} // namespace duet::raytrace
