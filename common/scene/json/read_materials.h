// This file reads the materials of scene files.
#pragma once

#include "common/scene/json/read_textures.h"

namespace duet {

/// Appends the materials of {"name": {…}, …} to the scene. Returns their indices by name.
NameIndex read_materials(const JsonValue& materials, const NameIndex& textures, Scene& scene);

} // namespace duet
