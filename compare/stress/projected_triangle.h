// This header declares a triangle projected by the rays through pixels, in extended precision: the borders of its
// visible part, and the attributes inside.
#pragma once

#include "common/camera/camera.h"

#include <array>

namespace duet::compare {

using Extended = long double; ///< 64-bit significand on x86-64: 2^11 times finer than double
using Vec3x = Vec3T<Extended>;

/// Stores the barycentric coordinates of b and c, and the depth (camera-space −z).
struct ProjectedPoint {
    double u, v, depth;
};

/// Represents a triangle by linear functions of the pixel. The ray through a pixel is o + depth·d, with d linear in the
/// pixel. So for each pair of corners relative to o the volume d·(Pⱼ × Pₖ) is linear, too. These three volumes, and
/// 1/depth, which is also linear, bound the visible part by straight lines in the image. This holds for corners in
/// front of the near plane, in the plane of the eye, or behind the eye. (Möller and Trumbore 1997 solve for the same
/// volumes.) Only perspective views are supported.
class ProjectedTriangle {
public:
    ProjectedTriangle(const Pinhole& pinhole, const std::array<Vec3, 3>& corners);

    /// Returns whether the eye is in the triangle's plane or the corners are collinear; nothing is visible then.
    bool edge_on() const { return volume_ == 0; }
    /// Returns the least signed distance to the four lines in pixels. It is positive inside the visible part; outside
    /// it is negative, and the visible part is at least as far away. It is minus infinity if the whole triangle is in
    /// front of the near plane. A triangle in the near plane is visible.
    double inside(Vec2d pixel) const;
    /// Returns the intersection of the pixel's ray with the triangle's plane. It is in the triangle where inside() >=
    /// 0.
    ProjectedPoint at(Vec2d pixel) const;
    /// Returns the factor by which the relative rounding errors of corners, eye and products can grow in at()'s
    /// results. It is large where the eye is near the triangle's plane, or where a corner is near the eye and far
    /// from the world's origin.
    double condition(Vec2d pixel) const;

private:
    struct Line {
        Extended x, y, constant; ///< positive inside

        Extended at(Vec2d p) const { return x * p.x + y * p.y + constant; }
    };
    std::array<Line, 3> edges_; ///< barycentric coordinate i over depth
    Line near_;                 ///< 1/near − 1/depth
    Extended volume_;
    Extended size_ = 0; ///< sum of the terms of volume_ for a ray direction of length 1
    Vec3d direction_, direction_dx_, direction_dy_;
    Extended near_distance_;
};

/// Returns the distance in pixels of a wrongly covered or uncovered sample from the triangle's visible part; 0 where
/// the decision is right.
double displacement(const ProjectedTriangle& triangle, Vec2d pixel, bool covered);

} // namespace duet::compare
