// A look through the text of an OBJ or MTL file before tinyobjloader reads it, which takes malformed numbers for 0,
// wraps large indices and only warns of those out of range.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace duet {

/// No coordinate or other number of a mesh is larger: squared lengths must not overflow in float.
inline constexpr double kMaxMeshNumber = 1e18;

struct ObjCounts {
    std::size_t positions = 0, texture_coordinates = 0, normals = 0, faces = 0, corners = 0;
    std::vector<std::string> material_files; ///< of the mtllib lines, as written, one a line
};

/// Reads a text file for tinyobjloader: at most 4 GiB, without NUL bytes; lines continued by a backslash are joined,
/// and the number of lines kept. Throws Error.
std::string read_obj_text(const std::filesystem::path& path);

/// Checks each v, vt, vn and f line: enough numbers, each well-formed, finite and at most kMaxMeshNumber; faces of at
/// least three corners whose indices name vertices that the file has (a negative one: those before the line). Throws
/// Error with path and line.
ObjCounts check_obj(const std::filesystem::path& path, std::string_view text);

/// Checks the numbers of those MTL keys that are used. Throws Error with path and line.
void check_mtl(const std::filesystem::path& path, std::string_view text);

} // namespace duet
