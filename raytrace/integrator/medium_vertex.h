// Declares medium vertices, at which a medium scatters a path. They have the same functions as vertices on surfaces
// (vertex.h).
#pragma once

#include "common/medium/phase_function.h"
#include "raytrace/integrator/light_sampling.h"

namespace duet::raytrace {

/// Represents a point at which a medium scatters a path.
struct MediumVertex {
    Vec3 p;
    Vec3 direction; ///< unit direction of the arriving ray
    float time = 0;
    float asymmetry = 0; ///< asymmetry of the medium's phase function
};

/// Returns the light receiver, which light reaches from all directions.
inline LightReceiver light_receiver(const MediumVertex& vertex) { return {vertex.p, Vec3(0, 0, 0)}; }
/// Returns the phase function. The weight of the collision already contains the scattering coefficient.
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
