// Whether a pixel's ray, moved by next to nothing, sees another primitive.
#pragma once

#include "common/camera/camera.h"
#include "compare/hits/exact_trace.h"

namespace duet::compare {

/// How far a ray is displaced at most, in pixels. The rasterizer snaps vertices to 1/256 pixel: by at most 1/512 an
/// axis, 0.0028 pixel in all. So whatever its snapped triangle covers, the unsnapped one passes by within this
/// distance.
inline constexpr double kEdgeRadius = 1.0 / 128;

/// At the edge where a hidden face meets the one before it, both lie at the same distance; rounding then decides which
/// of the two a pipeline returns (equal distances: the lower primitive). This near, in |Δt|·|cos θ| / t, the hidden one
/// is as good as seen: some ten roundings of a float.
inline constexpr double kMeetingTolerance = 1e-6;

/// What rays within kEdgeRadius of the pixel's centre see of two pipelines' hits, in double precision.
struct EdgeSearch {
    bool found_a = false, found_b = false; ///< a ray returns it as its nearest hit
    bool tied_a = false, tied_b = false;   ///< a ray meets it within kMeetingTolerance of its nearest hit
    ExactHit center;                       ///< what the undisplaced ray returns

    bool both() const { return found_a && found_b; }
    bool both_or_tied() const { return (found_a || tied_a) && (found_b || tied_b); }
};

/// Displaces the ray through `pixel` on circles, then into the parts of the two primitives that lie within reach
/// (however thin they are), then over a dense disk, until both hits are found or all is tried: some 5,000 rays. Each
/// ray is traced through the whole scene: being near an edge counts for nothing, seeing the primitive does.
EdgeSearch search_edge(const ExactTracer& tracer, const Pinhole& pinhole, Vec2d pixel, const Hit& a, const Hit& b);

} // namespace duet::compare
