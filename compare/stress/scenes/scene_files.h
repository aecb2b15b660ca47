// This file writes the meshes and images that random scenes use.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace duet::compare {

/// These are the numbers of points of the grid in smoke.raw along each axis.
inline constexpr std::array kGridPoints{4, 3, 5};

/// Writes small meshes, images and a grid of densities into a folder: a closed mesh, an open one, a soup with slivers
/// and triangles without area, quads, and a mesh with materials of its own; images with and without alpha, and an
/// environment with a bright spot. Returns the names for each definition of the scene's schema that has a key `file`.
std::map<std::string, std::vector<std::string>> write_scene_files(const std::filesystem::path& folder);

} // namespace duet::compare
