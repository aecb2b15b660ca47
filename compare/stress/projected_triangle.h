// A triangle as the rays through pixels see it, in extended precision: where its visible part ends, and what is there.
#pragma once

#include "common/camera/camera.h"

#include <array>

namespace duet::compare {

using Extended = long double; ///< 64 bits of significand on x86-64: 2^11 times finer than double
using Vec3x = Vec3T<Extended>;

/// Barycentric coordinates of b and c, and depth (camera-space −z).
struct ProjectedPoint {
    double u, v, depth;
};

/// The ray through a pixel is o + depth·d with d linear in the pixel, so of each corner the volume d·(Pⱼ × Pₖ), corners
/// taken from o, is linear too. Those three, and 1/depth, which is linear as well, bound the visible part by straight
/// lines of the picture, wherever the corners are: before the near plane, on the plane of the eye, behind it. (Möller
/// and Trumbore 1997 solve for the same volumes.) Perspective views only.
class ProjectedTriangle {
public:
    ProjectedTriangle(const Pinhole& pinhole, const std::array<Vec3, 3>& corners);

    /// Whether the eye lies in the triangle's plane, or the corners on a line: nothing is seen of it.
    bool edge_on() const { return volume_ == 0; }
    /// The least distance to the four lines in pixels: positive inside the visible part, negative outside, where the
    /// part itself is at least as far away. Minus infinity where all of it is before the near plane; a triangle in the
    /// near plane is seen.
    double inside(Vec2d pixel) const;
    /// What the ray through the pixel sees of the triangle's plane; of the triangle where inside() >= 0.
    ProjectedPoint at(Vec2d pixel) const;
    /// By how many times the relative rounding errors of corners, eye and products may grow in at()'s results: large
    /// where the eye lies next to the triangle's plane, or a corner next to the eye and far from the world's origin.
    double condition(Vec2d pixel) const;

private:
    struct Line {
        Extended x, y, constant; ///< positive inside

        Extended at(Vec2d p) const { return x * p.x + y * p.y + constant; }
    };
    std::array<Line, 3> edges_; ///< barycentric coordinate i over depth
    Line near_;                 ///< 1/near − 1/depth
    Extended volume_;
    Extended size_ = 0; ///< of the terms that add up to volume_ in a point's volumes, for a ray's direction of length 1
    Vec3d direction_, direction_dx_, direction_dy_;
    Extended near_distance_;
};

/// How far a sample is on the wrong side of the triangle's visible part, in pixels; 0 where it is on the right one.
double displacement(const ProjectedTriangle& triangle, Vec2d pixel, bool covered);

} // namespace duet::compare
