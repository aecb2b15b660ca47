// This file queries the materials that a scene's objects use; a file may describe further materials.
#pragma once

#include "common/scene/scene.h"

#include <algorithm>

namespace duet {

/// Returns whether predicate(material) holds for a material that some object uses.
template <typename Predicate> bool any_used_material(const Scene& scene, const Predicate& predicate) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
        return std::any_of(object.materials.begin(), object.materials.end(),
                           [&](std::uint32_t material) { return predicate(scene.materials[material]); });
    });
}

} // namespace duet
