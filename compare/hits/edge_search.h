// Whether a pixel's ray, moved by next to nothing, sees another primitive.
#pragma once

#include "common/camera/camera.h"
#include "compare/hits/exact_trace.h"

namespace duet::compare {

/// How far a ray is displaced at most, in pixels. The rasterizer snaps vertices to 1/256 pixel: by at most 1/512 an
/// axis, 0.0028 pixel in all. So whatever its snapped triangle covers, the unsnapped one passes by within this
/// distance.
inline constexpr double kEdgeRadius = 1.0 / 128;

/// Which of two pipelines' hits a ray within kEdgeRadius of the pixel's centre returns as its nearest, in double
/// precision.
struct EdgeSearch {
    bool found_a = false, found_b = false;
    ExactHit center; ///< what the undisplaced ray returns

    bool both() const { return found_a && found_b; }
};

/// Displaces the ray through `pixel` on circles, then into the parts of the two primitives that lie within reach
/// (however thin they are), then over a dense disk, until both hits are found or all is tried: some 5,000 rays. Each
/// ray is traced through the whole scene: being near an edge counts for nothing, seeing the primitive does.
EdgeSearch search_edge(const ExactTracer& tracer, const Pinhole& pinhole, Vec2d pixel, const Hit& a, const Hit& b);

} // namespace duet::compare
