// Triangle meshes from OBJ files.
#pragma once

#include "common/vec/vec.h"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace duet::lesson {

/// A corner of a triangle, in the space of the mesh.
struct MeshVertex {
    Vec3 p, n; ///< the point, and the surface's normal there, of unit length
    Vec2 uv;   ///< where in the texture; (0, 0) is its lower left corner
};
/// Three vertices a triangle, counter-clockwise seen from outside.
using Mesh = std::vector<MeshVertex>;

/// Reads an OBJ file with faces such as "f 1/1/1 2/2/2 3/3/3". Throws a std::exception where it is missing or wrong.
inline Mesh read_obj(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + ": can't be opened");
    std::vector<Vec3> points, uvs, normals;
    Mesh mesh;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string key;
        Vec3 v;
        if (words >> key && key[0] == 'v') words >> v.x >> v.y >> v.z; // a texture coordinate has no z: it stays 0
        if (key == "v") points.push_back(v);
        if (key == "vt") uvs.push_back(v);
        if (key == "vn") normals.push_back(normalize(v));
        Mesh face;
        std::size_t p = 0, uv = 0, n = 0; // the first point of the file has the number 1
        for (char slash{}; key == "f" && words >> p >> slash >> uv >> slash >> n;)
            face.push_back({points.at(p - 1), normals.at(n - 1), {uvs.at(uv - 1).x, uvs.at(uv - 1).y}});
        for (std::size_t i = 2; i < face.size(); ++i) mesh.insert(mesh.end(), {face[0], face[i - 1], face[i]});
    }
    return mesh;
}

} // namespace duet::lesson
