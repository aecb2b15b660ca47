// Your normal maps. The pictures show your map of a shield, and the shield in the light. For now it is flat.
#include "raster/lessons/08-normal-maps/lab.h"

namespace duet::lab {

std::optional<Tangents> tangents(std::array<Vec3, 3> p, std::array<Vec2, 3> uv) {
    not_attempted(); // Remove this line when you start.
    (void)p, (void)uv;
    // The two edges from p[0] are two equations for along_u and along_v. The page solves them.
    return std::nullopt;
}

TangentFrame tangent_frame(Vec3 n, Tangents tangents) {
    not_attempted(); // Remove this line when you start.
    (void)n;
    // Subtract the part of along_u that points along n. What is at right angles to two vectors? On which side?
    return {tangents.along_u, tangents.along_v};
}

Vec3 decode_normal(Rgb texel) {
    not_attempted(); // Remove this line when you start.
    (void)texel;
    // From [0, 1] to [-1, 1].
    return {0, 0, 1};
}

Vec3 perturb(Vec3 n, TangentFrame frame, Vec3 mapped) {
    not_attempted(); // Remove this line when you start.
    (void)frame, (void)mapped;
    return n;
}

ImageRgb normal_map(const ImageFloat& heights) {
    not_attempted(); // Remove this line when you start.
    // For now all normals point straight away from the surface.
    return ImageRgb(heights.width(), heights.height(), Rgb(0.5f, 0.5f, 1));
}

} // namespace duet::lab
