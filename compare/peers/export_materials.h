// This file exports the materials of a scene for export_scene().
#pragma once

#include "common/scene/scene.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace duet::compare {

/// Throws the Error that a feature of the scene has no counterpart.
[[noreturn]] void fail_unsupported(const Scene& scene, const std::string& what);

/// Returns the list [r, g, b].
nlohmann::json rgb_json(Rgb c);

/// Returns the list of a scene's materials, writes their images to an existing folder, and adds to `notes` what is not
/// exact. Materials that no object uses are replaced by Diffuse, because they may not be exportable. Throws an Error
/// that names any feature without a counterpart.
nlohmann::json export_materials(const std::filesystem::path& folder, const Scene& scene, std::set<std::string>& notes);

} // namespace duet::compare
