// This file lists the keys of scene files by kind of JSON object. The readers accept these keys, and
// scene.schema.json must list the same ones.
#pragma once

#include "common/scene/json/json_reader.h"

namespace duet {

/// Returns the keys of all kinds, in no particular order.
const std::vector<JsonKeys>& scene_keys();
/// Returns the keys of one kind, which must exist.
const JsonKeys& scene_keys(std::string_view kind);

} // namespace duet
