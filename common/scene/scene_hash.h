// This file identifies a scene by the content of its files.
#pragma once

#include "common/scene/scene.h"

#include <string>

namespace duet {

/// Returns a 64-bit hash, as 16 hexadecimal digits, of the bytes of Scene::files in order. The paths and names of the
/// files do not matter. Throws Error for a file that can no longer be read.
std::string hash_scene_files(const Scene& scene);

} // namespace duet
