// This file bakes transforms: static objects whose shape is used once are moved into world space, which saves a
// transform per ray.
#pragma once

#include "common/scene/scene.h"

#include <array>
#include <optional>

namespace duet {

/// Transforms the object's shape into world space and sets the object's transform to the identity. No other object
/// may use the shape. The object is left unchanged where baking would change the image. The conditions are:
/// - No texture is evaluated in object space (noise, solid checkers).
/// - A sphere is only baked under rotation, reflection and uniform scale, and a textured sphere only without rotation
///   and reflection.
/// - A mesh with normals is only baked under rotation, reflection and uniform scale. Other maps change the lengths of
///   the normals, and so their weights in interpolation.
/// - Mirrored quads and triangles keep their front side by an exchange of edges or corners. They are not baked where
///   this would also exchange their texture coordinates.
/// - Quads that share corners (a box) are only baked if their rounded corners still coincide.
///
/// Under any of these transforms, mirroring or not, the front of a surface is the image of its front.
void bake(Scene& scene, Object& object);

/// Each overload returns the shape under an affine map, such that its front is the image of its front. A sphere has
/// no result where the map would not keep it a sphere.
Quad transformed(const Quad& quad, const Mat4& to_world);
std::array<Vec3, 3> transformed(const std::array<Vec3, 3>& triangle, const Mat4& to_world);
std::optional<Sphere> transformed(const Sphere& sphere, const Mat4& to_world);

} // namespace duet
