// Lab 06: shading.
#pragma once

#include "common/image/rgb.h"
#include "tests/grading/lab.h"

#include <array>
#include <optional>

namespace duet::lab {

/// The cosine of the angle between a surface's unit normal and the direction to the light source, which may have any
/// length but 0. It is 0 where the light source is behind the surface.
float lambert(Vec3 n, Vec3 to_light);

/// The unit normal of a triangle. It points to the side from which the corners are counter-clockwise. Nothing for a
/// triangle without area: one whose edge vectors have the cross product (0, 0, 0).
std::optional<Vec3> flat_normal(Vec3 a, Vec3 b, Vec3 c);

/// The unit normal of a surface after a linear map, from the unit normal n before it. The map sends a vector v to
/// columns[0] * v.x + columns[1] * v.y + columns[2] * v.z. It has an inverse, and it may mirror. The result is the
/// direction of the inverse's transpose times n.
Vec3 transform_normal(std::array<Vec3, 3> columns, Vec3 n);

/// The unit normal at a point of a triangle, from the unit normals of its corners and the point's barycentric weights.
/// The weighted mean is never 0.
Vec3 interpolated_normal(std::array<Vec3, 3> normals, Vec3 weights);

/// The light that a surface reflects to the eye: the diffuse part of Lambert's law and a highlight of Blinn and Phong.
/// p is the point, n its unit normal, light and eye are positions. Black where the light source is behind the surface.
/// The light source is white, and its distance plays no part. The highlight is `specular` times a cosine to the power
/// `shininess`; it is not multiplied by the cosine of Lambert's law.
Rgb blinn_phong(Vec3 p, Vec3 n, Vec3 light, Vec3 eye, Rgb diffuse, float specular, float shininess);

} // namespace duet::lab

DUET_LAB(lambert, flat_normal, transform_normal, interpolated_normal, blinn_phong)
