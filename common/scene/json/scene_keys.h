// The keys of scene files, by kind of JSON object: what the readers accept, and what scene.schema.json must say.
#pragma once

#include "common/scene/json/json_reader.h"

namespace duet {

/// All kinds; their order is of no meaning.
const std::vector<JsonKeys>& scene_keys();
/// The keys of one kind, which must be known.
const JsonKeys& scene_keys(std::string_view kind);

} // namespace duet
