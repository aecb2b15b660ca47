// This header contains a strict reader of the OBJ files that models/ writes. It is independent of the project's
// loader and writer.
#pragma once

#include "common/system/error.h"
#include "common/vec/vec.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace duet::test {

struct ObjText {
    struct Corner {
        std::size_t position, uv, normal;
    };
    std::vector<Vec3d> positions, normals;
    std::vector<Vec2d> uvs;
    std::vector<std::array<Corner, 3>> triangles;
};

/// Reads lines v, vt, vn and triangles "f p/t/n p/t/n p/t/n" or "f p//n …" (uv is then 0), and ignores comments,
/// mtllib and usemtl. Throws Error on anything else and on an index out of range.
inline ObjText read_obj_text(const std::filesystem::path& path) {
    std::ifstream in(path);
    if (!in) throw Error(path.string() + ": not found; the build's target \"models\" makes it");
    ObjText obj;
    std::string line, key;
    const auto index = [&](const char*& at, std::size_t count) {
        char* end = nullptr;
        const unsigned long i = std::strtoul(at, &end, 10);
        if (end == at || i < 1 || i > count) throw Error(path.string() + ": bad index in \"" + line + "\"");
        at = end;
        return static_cast<std::size_t>(i - 1);
    };
    while (std::getline(in, line)) {
        if (line.empty() || line[0] == '#' || line.starts_with("mtllib ") || line.starts_with("usemtl ")) continue;
        if (line.starts_with("f ")) {
            const char* at = line.c_str() + 1;
            std::array<ObjText::Corner, 3> triangle{};
            for (ObjText::Corner& corner : triangle) {
                corner.position = index(at, obj.positions.size());
                if (*at != '/') throw Error(path.string() + ": no slash in \"" + line + "\"");
                ++at;
                if (*at != '/') corner.uv = index(at, obj.uvs.size());
                if (*at != '/') throw Error(path.string() + ": no second slash in \"" + line + "\"");
                ++at;
                corner.normal = index(at, obj.normals.size());
            }
            if (*at != 0) throw Error(path.string() + ": not a triangle: \"" + line + "\"");
            obj.triangles.push_back(triangle);
            continue;
        }
        std::istringstream words(line);
        double x = 0, y = 0, z = 0;
        words >> key >> x >> y;
        if (key == "v" && words >> z)
            obj.positions.emplace_back(x, y, z);
        else if (key == "vn" && words >> z)
            obj.normals.emplace_back(x, y, z);
        else if (key == "vt" && words)
            obj.uvs.emplace_back(x, y);
        else
            throw Error(path.string() + ": unexpected \"" + line + "\"");
    }
    return obj;
}

} // namespace duet::test
