// This file reads the camera, lights and environment of scene files.
#pragma once

#include "common/scene/json/json_reader.h"
#include "common/scene/scene.h"

namespace duet {

/// Reads "camera". These functions throw Error with the JSON path of what they cannot use.
Camera read_camera(const JsonValue& camera);
/// Reads one element of "lights".
Light read_light(const JsonValue& light);
/// Reads the environment, and appends its image file to `files` where there is one.
Environment read_environment(const JsonValue& environment, std::vector<std::filesystem::path>& files);

} // namespace duet
