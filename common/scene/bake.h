// Objects that stand still and are placed once are moved into world space, which saves each ray a transform.
#pragma once

#include "common/scene/scene.h"

#include <array>
#include <optional>

namespace duet {

/// Transforms the object's shape, which nothing else uses, and makes its transform the identity, where that changes
/// nothing to be seen:
/// - not where a texture is looked up in the object's space (noise, solid checkers);
/// - a sphere only under a rotation, reflection and uniform scale, and a textured one under no rotation or reflection;
/// - a mesh with normals only under the same: their lengths, and so the weights of their interpolation, would change at
/// each vertex;
/// - mirrored quads and triangles keep their front side by an exchange of edges or corners, so not where the texture
/// coordinates would be
///   exchanged, too;
/// - quads that share corners (a box) only if their corners, as rounded, still meet.
/// The front of a surface is the image of its front under any of these transforms, mirroring or not.
void bake(Scene& scene, Object& object);

/// A quad, a triangle or a sphere under an affine map, its front side being the image of its front. Of a sphere only
/// where the map keeps it one.
Quad transformed(const Quad& quad, const Mat4& to_world);
std::array<Vec3, 3> transformed(const std::array<Vec3, 3>& triangle, const Mat4& to_world);
std::optional<Sphere> transformed(const Sphere& sphere, const Mat4& to_world);

} // namespace duet
