// The objects of scene files: shapes, groups and instances, flattened to Scene::objects.
#pragma once

#include "common/scene/json/json_reader.h"
#include "common/scene/json/read_materials.h"
#include "common/scene/scene.h"

namespace duet {

/// At most this many objects, counting the groups and instances that stand between.
inline constexpr std::size_t kMaxObjects = 10'000'000;
/// Groups and instances nested at most this deep.
inline constexpr std::size_t kMaxGroupDepth = 64;

/// Appends the objects of the array to the scene, with their shapes and the materials of their MTL files. Groups and
/// instances are flattened, their transforms composed in double; members are named "group/member".
void read_objects(const JsonValue& objects, const NameIndex& materials, ImageCache& images, Scene& scene);

/// Appends a mesh's materials and textures to the scene; the scene's material index of each slot. Names become
/// "stem:name".
std::vector<std::uint32_t> add_obj_materials(const std::filesystem::path& file, const struct ObjFile& obj,
                                             ImageCache& images, Scene& scene);

} // namespace duet
