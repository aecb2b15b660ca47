// Lab 05: clipping.
#pragma once

#include "common/vec/vec.h"
#include "tests/grading/lab.h"

#include <array>
#include <vector>

namespace duet::lab {

/// A corner of a triangle. It is in front of the near plane if clip.z >= 0, and behind it if clip.z < 0.
struct Vertex {
    Vec4 clip; ///< in clip space, before the division by w
    Vec2 uv;   ///< an attribute
};
using Triangle = std::array<Vertex, 3>;

/// The fraction of the way from a point in front (front_z >= 0) to a point behind (behind_z < 0) at which z is 0: a
/// number from 0 to 1.
float crossing_fraction(float front_z, float behind_z);

/// Where the edge of a and b crosses the near plane, with its attribute. One of the two is in front and the other
/// behind, in either order. The result is the same, bit for bit, if a and b are exchanged.
Vertex crossing(const Vertex& a, const Vertex& b);

/// The part of the triangle in front of the near plane as zero, one or two triangles, with the winding of the original.
/// They cover that part exactly once. A triangle that is in front as a whole is returned as it is. Triangles without
/// area may be among the result only where a corner lies on the plane (z == 0).
std::vector<Triangle> clip_near(const Triangle& triangle);

} // namespace duet::lab

DUET_LAB(crossing_fraction, crossing, clip_near)
