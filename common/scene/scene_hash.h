// Which scene this is, by the content of its files.
#pragma once

#include "common/scene/scene.h"

#include <string>

namespace duet {

/// 64 bits, as 16 hexadecimal digits, of the bytes of Scene::files in order. Where a file lies and what it is called
/// does not matter. Throws Error for a file that can no longer be read.
std::string hash_scene_files(const Scene& scene);

} // namespace duet
