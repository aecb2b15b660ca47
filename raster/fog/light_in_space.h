// Computes the light that one emitter sends to points in space, away from surfaces.
#pragma once

#include "raster/lighting/frame_lights.h"

namespace duet::raster {

/// Represents pieces of camera rays. Each piece lies inside one froxel.
struct RayPieces {
    Vec3T<Floats> origin, direction; ///< origins and unit directions of the rays
    IntervalT<Floats> piece;
    Floats width; ///< width of the froxel across the ray, in meters

    Floats middle() const { return (piece.begin + piece.end) * Floats(0.5f); }
    Vec3T<Floats> p() const { return origin + direction * middle(); }
};

/// Returns ∫ L(w) dw over the directions in which a light is seen from the middle of each piece, without occlusion: its
/// radiance times its solid angle, or its irradiance if it has no extent. `to` is the light's direction from the
/// middle. The inverse square of the distance, which changes fast near a light, is averaged over the piece in closed
/// form (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media", §4).
RgbT<Floats> light_in_space(const FrameLight& light, const LightDirection& to, const RayPieces& rays);

} // namespace duet::raster
