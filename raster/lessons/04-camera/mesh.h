// Triangle meshes from OBJ files.
#pragma once

#include "common/vec/vec.h"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace duet::lesson {

/// A corner of a triangle, in the space of the mesh.
struct MeshVertex {
    Vec3 p;  ///< the point
    Vec3 n;  ///< the surface's normal there, of unit length
    Vec2 uv; ///< where in the texture; (0, 0) is its lower left corner
};
/// Three vertices a triangle, counter-clockwise seen from outside.
using Mesh = std::vector<MeshVertex>;

/// Reads an OBJ file whose faces name a point, a texture coordinate and a normal for each corner ("f 1/1/1 2/2/2
/// 3/3/3"). A face of n corners becomes a fan of n - 2 triangles. Throws a std::exception where the file is missing or
/// a face names what it doesn't have.
inline Mesh read_obj(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + ": can't be opened");
    std::vector<Vec3> points, normals;
    std::vector<Vec2> uvs;
    Mesh mesh;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string key;
        Vec3 v;
        words >> key;
        if (key == "v" && words >> v.x >> v.y >> v.z) points.push_back(v);
        if (key == "vn" && words >> v.x >> v.y >> v.z) normals.push_back(normalize(v));
        if (key == "vt" && words >> v.x >> v.y) uvs.push_back({v.x, v.y});
        if (key != "f") continue;
        Mesh corners;                     // of one face
        std::size_t p = 0, uv = 0, n = 0; // the first point of the file has the number 1
        for (char slash{}; words >> p >> slash >> uv >> slash >> n;)
            corners.push_back({points.at(p - 1), normals.at(n - 1), uvs.at(uv - 1)});
        for (std::size_t i = 2; i < corners.size(); ++i)
            mesh.insert(mesh.end(), {corners[0], corners[i - 1], corners[i]});
    }
    return mesh;
}

} // namespace duet::lesson
