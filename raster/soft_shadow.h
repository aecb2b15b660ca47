// Soft shadows of lights that have an area, from the depths that their centre sees.
#pragma once

#include "common/light/light.h"
#include "raster/cube_map.h"

#include <cstdint>
#include <span>
#include <vector>

namespace duet::raster {

/// A light's outline as its shadows know it: a parallelogram, a triangle, or a ball, which to each receiver is the disk
/// that faces it.
struct Emitter {
    enum class Kind { kParallelogram, kTriangle, kBall };
    Kind kind = Kind::kBall;
    Vec3d center; ///< from which its maps are drawn
    Vec3d u, v;   ///< edges (not of a ball)
    Vec3d normal; ///< of its plane, on the side that emits (not of a ball)
    double radius = 0;

    /// Of one surface light.
    static Emitter of(const SurfaceLight& light);
    /// Of several at once: the smallest rectangle around them along one of the first one's edges where they lie in one
    /// plane and face the same way; else a ball around them.
    static Emitter of(std::span<const SurfaceLight> lights);
};

/// How many taps a receiver takes: squares of these; `refine` where those of `filter` do not agree.
struct SoftTaps {
    int search = 4, filter = 3, refine = 4;
};

/// The part of a light's irradiance that arrives, in [0, 1], estimated from the depths its centre sees:
/// percentage-closer soft shadows (Fernando 2005). Blockers are searched in the cone between the receiver and the
/// light; their mean place, as a fraction of the way, says how wide the penumbra is; the part of as wide a piece of
/// the map that the light sees past them is the answer.
///
/// Departures from Fernando's, so that nothing need be guessed: taps lie where lines from the receiver to points of the
/// light meet the plane, parallel to the light, in which blockers are taken to be, so that the filter has the light's
/// own shape whatever its direction; what a tap finds counts where it stands over the receiver's plane, before the light,
/// so that a flat surface does not shade itself, however steep; and the search counts it only where the line to it from
/// the receiver goes on to the light, so that the walls of a corner are no blockers.
///
/// `key` chooses the jitter of the taps.
float soft_visibility(const CubeMap& map, const Emitter& light, const Receiver& receiver, SoftTaps taps,
                      std::uint64_t key);

} // namespace duet::raster
