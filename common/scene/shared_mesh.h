// This file finds the meshes that a scene shares with the scene before an edit, of which results can be used again.
#pragma once

#include "common/scene/scene.h"

#include <optional>

namespace duet {

/// Returns the index in `before.shapes` of the mesh `scene.shapes[shape]`. Returns nothing if the scenes do not share
/// it (see Transforms), or if the shape is no mesh: what other shapes need is computed in no time.
inline std::optional<std::size_t> shared_mesh(const Scene& before, const Scene& scene, std::size_t shape) {
    if (!std::holds_alternative<Mesh>(scene.shapes[shape])) return std::nullopt;
    const std::size_t index = before.shapes.index_of(scene.shapes.shared(shape), shape);
    return index < before.shapes.size() ? std::optional(index) : std::nullopt;
}

} // namespace duet
