// Lab 08: normal maps.
#pragma once

#include "common/image/image.h"
#include "tests/grading/lab.h"

#include <array>
#include <optional>

namespace duet::lab {

/// How a point of the surface moves as u and as v grow by 1.
struct Tangents {
    Vec3 along_u, along_v;
};

/// The tangents of a triangle with the corners p and their places uv in the texture. Any length. Nothing where the
/// three places lie on one line of the texture: where the determinant of the equations is 0.
std::optional<Tangents> tangents(std::array<Vec3, 3> p, std::array<Vec2, 3> uv);

/// The frame of a normal map: t along u and b along v, of unit length, at right angles to the normal and to each other.
struct TangentFrame {
    Vec3 t, b;
};

/// The frame about the unit normal n. t is the part of along_u that is at right angles to n. b is at right angles to
/// both, on the side of along_v: dot(b, along_v) >= 0. So the frame is left-handed where the texture is mirrored.
/// along_u is not parallel to n.
TangentFrame tangent_frame(Vec3 n, Tangents tangents);

/// The normal of a texel: red, green and blue from 0 to 1 are its components from -1 to 1. They are not encoded.
Vec3 decode_normal(Rgb texel);

/// The unit normal in the world: `mapped` counts along t, b and the unit normal n. mapped may have any length but 0.
Vec3 perturb(Vec3 n, TangentFrame frame, Vec3 mapped);

/// The normal map of a relief: for each texel its unit normal, as a color by the inverse of decode_normal. Heights are
/// in widths of a texel. The slope of a texel is half the difference of its two neighbors, along u (to the right) and
/// along v (up). The relief repeats beyond its edges. Row 0 of an image is its top row.
ImageRgb normal_map(const ImageFloat& heights);

} // namespace duet::lab

DUET_LAB(tangents, tangent_frame, decode_normal, perturb, normal_map)
