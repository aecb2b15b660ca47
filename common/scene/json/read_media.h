// This file reads the media of scene files.
#pragma once

#include "common/medium/medium.h"
#include "common/scene/json/json_reader.h"

#include <vector>

namespace duet {

/// Throws Error unless "low" is below "high" on each axis.
void check_corners(const JsonValue& value, const Box3& box);
/// Reads "media".
std::vector<Medium> read_media(const JsonValue& media);

} // namespace duet
