// This file reads the objects of scene files. Shapes, groups and instances are flattened to Scene::objects.
#pragma once

#include "common/scene/json/json_reader.h"
#include "common/scene/json/read_materials.h"
#include "common/scene/scene.h"

namespace duet {

/// A scene may have at most this many objects, including intermediate groups and instances.
inline constexpr std::size_t kMaxObjects = 10'000'000;
/// Appends the objects of the array to the scene, with their shapes and the materials of their MTL files. Groups and
/// instances are flattened, and their transforms are composed in double. Members are named "group/member".
void read_objects(const JsonValue& objects, const NameIndex& materials, ImageCache& images, Scene& scene);

} // namespace duet
