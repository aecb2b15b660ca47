// This file bounds the light that a set of lights can send to a point, from bounds on their positions and normals.
#pragma once

#include "common/light/light.h"
#include "common/vec/box.h"

namespace duet {

/// A LightReceiver is a shading point p that receives light on the side of the unit vector n, or from all directions
/// where n is (0, 0, 0).
template <typename T> struct LightReceiverT {
    Vec3T<T> p, n;
};
using LightReceiver = LightReceiverT<float>;

/// LightBounds bound a set of lights by a box around their positions and a cone around their normals. Each light
/// emits at most 90° from its normal (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with
/// Adaptive Tree Splitting", §4.1).
struct LightBounds {
    Box3 box;
    Vec3 axis{0, 0, 1};    ///< axis of the cone of normals, unit
    float cos_normals = 2; ///< cosine of the cone's half angle; −1: lights emit in all directions; above 1: empty set
    float intensity = 0;   ///< sum of the lights' intensities along their normals, W/sr, averaged over channels

    bool empty() const { return cos_normals > 1; }
    /// Grows the bounds so that they also bound the lights of `other`, which may be empty.
    void extend(const LightBounds& other);
};

/// Returns the bounds of a point, spot or surface light. They are empty where the light emits nothing. A sun has no
/// bounds and must not be passed (an invariant).
LightBounds light_bounds(const Light& light);

/// Returns an estimate of the irradiance at the receiver from lights within the bounds, in W/m²:
/// intensity / distance² with the smallest angles that the bounds allow (as in eq. 3 of the paper above). It is 0
/// only where no light within the bounds can reach the receiver.
float irradiance_estimate(const LightBounds& bounds, const LightReceiver& receiver);

} // namespace duet
