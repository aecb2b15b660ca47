// This file tests whether a minimal displacement of a pixel's ray makes it hit a different primitive.
#pragma once

#include "common/camera/camera.h"
#include "compare/hits/reference_tracer.h"

#include <limits>

namespace duet::compare {

/// This is the displacement of a ray, in pixels, that accounts for the rasterizer's edges. The rasterizer snaps
/// vertices to 1/256 pixel, which moves them by at most 1/512 per axis, or 0.0028 pixel in all. Every point that the
/// snapped triangle covers therefore lies within this distance of the unsnapped triangle.
inline constexpr double kEdgeRadius = 1.0 / 128;

/// Where a hidden face meets the face in front of it at an edge, both are at the same distance. Rounding then
/// decides which one a pipeline returns (at equal distances: the lower primitive). The hidden face counts as
/// visible if |Δt|·|cos θ| / t is at most this tolerance, which is about ten float roundings.
inline constexpr double kTieTolerance = 1e-6;

/// Holds the distances at which displaced rays hit a primitive.
struct DistanceRange {
    double low = std::numeric_limits<double>::infinity(), high = 0;
    void extend(double t) { low = min(low, t), high = max(high, t); }
    bool empty() const { return !(low <= high); }
};
/// Returns whether rays hit both primitives, and one distance is in both ranges.
inline bool overlap(const DistanceRange& a, const DistanceRange& b) { return a.low <= b.high && b.low <= a.high; }

/// Says which of two pipelines' hits are found by double-precision rays within kEdgeRadius of the pixel center.
struct EdgeSearch {
    bool found_a = false, found_b = false; ///< whether a ray has the pipeline's hit as its closest hit
    bool tied_a = false, tied_b = false;   ///< whether a ray hits the primitive within kTieTolerance of its closest hit
    /// These are the distances at which rays hit the two primitives, even behind others. Where the pixel's ray misses a
    /// primitive, the rasterizer may take any of these for its distance: it moves the point into the triangle.
    DistanceRange range_a, range_b;
    bool center_hits_both = false; ///< whether the undisplaced ray hits both primitives, even behind others
    ReferenceHit center;           ///< closest hit of the undisplaced ray

    bool both() const { return found_a && found_b; }
    bool both_or_tied() const {
        const bool moved = (found_a || found_b) && !center_hits_both && overlap(range_a, range_b);
        return ((found_a || tied_a) && (found_b || tied_b)) || moved;
    }
};

/// Returns the width of a pixel at distance t, in meters.
double pixel_width(const Pinhole& pinhole, Vec2d pixel, double t);

/// Displaces the ray through `pixel` by up to `radius` pixels: first on circles, then into the parts of the two
/// primitives that lie within reach (however thin they are), then over a dense disk. It stops when both hits are found
/// or all of about 5,000 rays are tried. Each ray is traced through the whole scene: being close to an edge is not
/// enough, a ray must hit the primitive. The one exception is a primitive that projects to a line.
EdgeSearch search_edge(const ReferenceTracer& tracer, const Pinhole& pinhole, Vec2d pixel, double radius, const Hit& a,
                       const Hit& b);

} // namespace duet::compare
