// Questions about the materials that a scene's objects have; a file may describe others.
#pragma once

#include "common/scene/scene.h"

#include <algorithm>

namespace duet {

/// Whether `predicate`, of a Material, holds for one that an object has.
template <typename Predicate> bool any_used_material(const Scene& scene, const Predicate& predicate) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
        return std::any_of(object.materials.begin(), object.materials.end(),
                           [&](std::uint32_t material) { return predicate(scene.materials[material]); });
    });
}

} // namespace duet
