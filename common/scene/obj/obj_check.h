// This file validates the text of an OBJ or MTL file before tinyobjloader reads it. tinyobjloader reads malformed
// numbers as 0, wraps large indices, and only warns about indices out of range.
#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace duet {

/// No number of a mesh may be larger, so that squared lengths do not overflow in float.
inline constexpr double kMaxMeshNumber = 1e18;

/// Counts the elements of an OBJ file.
struct ObjCounts {
    std::size_t positions = 0, texture_coordinates = 0, normals = 0, faces = 0, corners = 0;
    std::vector<std::string> material_files; ///< contents of the mtllib lines, one per entry
};

/// Checks each v, vt, vn and f line and returns the counts of its elements. Each line must have enough numbers, each
/// well-formed, finite and at most kMaxMeshNumber. Faces must have at least three corners, whose indices refer to
/// vertices of the file (negative indices: to vertices before the line). Throws Error with path and line.
ObjCounts check_obj(const std::filesystem::path& path, std::istream& text);

/// Checks the numbers of the MTL keys that are used. Throws Error with path and line.
void check_mtl(const std::filesystem::path& path, std::istream& text);

} // namespace duet
