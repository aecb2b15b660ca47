// This file reads the media of scene files.
#pragma once

#include "common/scene/json/json_reader.h"
#include "common/scene/scene.h"

namespace duet {

class FileCache; // common/scene/file_cache.h

/// Throws Error unless "low" is below "high" on each axis.
void check_corners(const JsonValue& value, const Box3& box);
/// Reads "media" into the scene. Clouds and smoke come from the cache, unless it is null.
void read_media(const JsonValue& media, Scene& scene, FileCache* cache);

} // namespace duet
