// This file reads the lights and the environment of scene files.
#pragma once

#include "common/scene/json/json_reader.h"
#include "common/scene/scene.h"

namespace duet {

/// Reads one element of "lights". These functions throw Error with the JSON path of what they cannot use.
Light read_light(const JsonValue& light);
/// Reads the environment, and appends its image file to `files` where there is one.
Environment read_environment(const JsonValue& environment, std::vector<std::filesystem::path>& files);

} // namespace duet
