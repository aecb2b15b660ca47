// This header builds simple scenes for the tests of compare/.
#pragma once

#include "common/scene/build_scene.h"

namespace duet::test {

/// Returns a scene with one gray material and no shapes.
inline Scene empty_scene(int width = 64, int height = 48) {
    Scene scene;
    scene.path = "test.json";
    scene.width = width;
    scene.height = height;
    scene.materials.emplace_back(Diffuse{});
    scene.material_names.emplace_back("grey");
    return scene;
}

/// Adds a shape with a transform, and with an end transform if it moves. Returns the object's index.
inline std::uint32_t add(Scene& scene, Shape shape, const Mat4& to_world = {}, const Mat4* to_world_end = nullptr) {
    add_object(scene, "", std::move(shape), 0).place(to_world, to_world_end != nullptr ? *to_world_end : to_world);
    return static_cast<std::uint32_t>(scene.objects.size() - 1);
}

} // namespace duet::test
