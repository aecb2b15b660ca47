// This file reads the camera of scene files.
#pragma once

#include "common/camera/camera.h"
#include "common/scene/json/json_reader.h"

namespace duet {

/// Reads "camera". Throws Error with the JSON path of what it cannot use.
Camera read_camera(const JsonValue& camera);

} // namespace duet
