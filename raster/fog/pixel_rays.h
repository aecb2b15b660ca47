// Defines the camera rays that the froxel grid is computed for and applied to, and the integral along them.
#pragma once

#include "raster/gbuffer/gbuffer.h"

namespace duet::raster {

/// Returns (1 − exp(−x)) / x for x ≥ 0.
inline Floats mean_transmittance(const Floats& x) {
    return xsimd::select(x > Floats(1e-4f), -xsimd::expm1(-x) / max(x, Floats(1e-4f)), Floats(1.0f) - x * Floats(0.5f));
}
/// Returns the mean transmittance over media of an optical depth in which light arises evenly, per channel.
inline RgbT<Floats> mean_transmittance(const RgbT<Floats>& depth) {
    return {mean_transmittance(depth.r), mean_transmittance(depth.g), mean_transmittance(depth.b)};
}

/// Represents the camera rays of a batch of pixels, up to the visible surfaces.
struct PixelRays {
    Vec3T<Floats> origin, direction;
    Floats distance; ///< infinite for the background

    PixelRays(const GBuffer& gbuffer, int x, int y) {
        const Vec3T<Floats> p = gbuffer.points(x, y);
        const Floats to_p = gbuffer.projection.distance(p);
        direction = gbuffer.projection.to_viewer(p) * Floats(-1.0f);
        origin = p - direction * to_p;
        distance = xsimd::select(gbuffer.visible(x, y), to_p, Floats(kInfinity));
    }
};

/// Returns `first` in the first lane, and `step` more in each that follows.
inline Floats lane_offsets(float first, float step) {
    return Floats(first) + load(kLanesAsFloats, 0) * Floats(step);
}

} // namespace duet::raster
