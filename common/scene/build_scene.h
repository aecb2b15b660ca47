// These functions build a scene in code. finish_scene() completes the scene, and each pipeline's prepare() then takes
// it.
#pragma once

#include "common/scene/scene.h"

namespace duet {

/// Adds a material and returns its index. Messages use its name.
std::uint32_t add_material(Scene& scene, std::string name, Material material, SurfaceMaps maps = {});
/// Adds an object with a shape of its own and one material, an index that add_material() returned. Object::place() may
/// move it. The reference is valid until another object is added.
Object& add_object(Scene& scene, std::string name, Shape shape, std::uint32_t material, const Mat4& to_world = Mat4());

/// Throws Error, which names what is wrong and where, unless a scene's parts fit together: all indices are in range,
/// positions are finite, radii positive, directions of lights of unit length, objects placed by Object::place(), and
/// the camera's look-at point differs from its eye. Ranges of materials are not checked. finish_scene() calls it.
void check_scene(const Scene& scene);

} // namespace duet
