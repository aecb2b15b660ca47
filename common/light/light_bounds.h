// How much light a set of lights could send to a point: from bounds on where they are and which way they face.
#pragma once

#include "common/light/light.h"
#include "common/vec/box.h"

namespace duet {

/// Where light is gathered: at p, from the side of the unit vector n, or, where n is (0, 0, 0), from all around.
struct LightReceiver {
    Vec3 p, n;
};

/// The lights of a set lie within a ball, their normals within a cone, and each sends light at most 90° from its
/// normal (Conty Estevez and Kulla 2018, «Importance Sampling of Many Lights with Adaptive Tree Splitting», §4.1).
struct LightBounds {
    Box3 box;
    Vec3 axis{0, 0, 1};    ///< of the cone of normals, unit
    float cos_normals = 2; ///< of its half angle; −1: the lights shine all around; above 1: the set is empty
    float intensity = 0;   ///< sum of what each sends along its normal, W/sr, averaged over channels

    bool empty() const { return cos_normals > 1; }
    void extend(const LightBounds& other);
};

/// Of a point, spot or surface light. Empty where it sends nothing; a sun has none (an invariant).
LightBounds light_bounds(const Light& light);

/// An estimate of the irradiance at the receiver from lights within the bounds, W/m²: intensity / distance² by the
/// smallest angles that bounds allow (as eq. 3 there). 0 only where nothing within them can send it light.
float irradiance_estimate(const LightBounds& bounds, const LightReceiver& receiver);

} // namespace duet
