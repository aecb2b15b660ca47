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

/// Reads the lines v, vt, vn and f of an OBJ file whose faces name a point, a texture coordinate and a normal for each
/// corner ("f 1/1/1 2/2/2 3/3/3"). A face of n corners becomes a fan of n - 2 triangles. Throws std::runtime_error
/// where the file is missing or a face names what the file doesn't have.
inline Mesh read_obj(const std::string& path) {
    std::vector<Vec3> points, normals;
    std::vector<Vec2> uvs;
    Mesh mesh;
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + ": can't be opened");
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "v" || key == "vn") {
            Vec3 v;
            words >> v.x >> v.y >> v.z;
            (key == "v" ? points : normals).push_back(key == "v" ? v : normalize(v));
        } else if (key == "vt") {
            Vec2 uv;
            words >> uv.x >> uv.y;
            uvs.push_back(uv);
        } else if (key == "f") {
            std::vector<MeshVertex> corners;
            std::size_t p = 0, uv = 0, n = 0;
            for (char slash; words >> p >> slash >> uv >> slash >> n;) {
                if (p - 1 >= points.size() || uv - 1 >= uvs.size() || n - 1 >= normals.size())
                    throw std::runtime_error(path + ": a face names a corner that the file doesn't have: " + line);
                corners.push_back({points[p - 1], normals[n - 1], uvs[uv - 1]});
            }
            for (std::size_t i = 2; i < corners.size(); ++i)
                mesh.insert(mesh.end(), {corners[0], corners[i - 1], corners[i]});
        }
    }
    return mesh;
}

} // namespace duet::lesson
