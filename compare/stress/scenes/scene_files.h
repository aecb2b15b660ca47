// The meshes and images that random scenes use.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace duet::compare {

/// Writes small meshes and images into a folder: a closed mesh, an open one, a soup with slivers and triangles of no
/// area, quads, and a mesh with materials of its own; images with and without alpha, and an environment with a bright
/// spot. Returns the names for each definition of the scene's schema that has a key `file`.
std::map<std::string, std::vector<std::string>> write_scene_files(const std::filesystem::path& folder);

} // namespace duet::compare
