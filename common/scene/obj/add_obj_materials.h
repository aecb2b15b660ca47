// This file adds the materials of OBJ files to a scene.
#pragma once

#include "common/scene/json/read_materials.h"
#include "common/scene/obj/load_obj.h"
#include "common/scene/scene.h"

namespace duet {

/// Appends a mesh's materials and textures to the scene. Returns the scene's material index of each slot. The
/// materials are named "stem:name".
std::vector<std::uint32_t> add_obj_materials(const std::filesystem::path& file, const ObjFile& obj,
                                             ImageCache& images, Scene& scene);

} // namespace duet
