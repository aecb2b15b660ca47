// The library's normals (common/geometry/surface_point.h) and its cosine (raster/shading/phong_model.h). It has Phong's
// mirror direction in place of Blinn's half vector, and means of normals only within its surface points, so these two
// are the lesson's.
#include "common/geometry/surface_point.h"
#include "common/vec/matrix.h"
#include "raster/lessons/06-shading/lab.h"
#include "raster/lessons/06-shading/shading.h"
#include "raster/shading/phong_model.h"

namespace duet::lab {

float lambert(Vec3 n, Vec3 to_light) {
    const raster::Direction<float> normal{n, 1};
    return raster::PhongFactors<float>(normal, normal, normalize(to_light)).cosine;
}

std::optional<Vec3> flat_normal(Vec3 a, Vec3 b, Vec3 c) {
    if (cross(b - a, c - a) == Vec3()) return std::nullopt; // the scene loader leaves such triangles out
    const Mesh mesh{.positions = {a, b, c}, .normals = {}, .uvs = {}, .triangles = {{0, 1, 2}}, .material_slots = {}};
    Hit hit;
    hit.object = hit.primitive = 0, hit.u = hit.v = 0.25f, hit.t = 1;
    return surface_point(mesh, hit, Ray{}, Mat4(), Mat4(), true).ng;
}

Vec3 transform_normal(std::array<Vec3, 3> columns, Vec3 n) {
    Mat4 m;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) m[r][c] = columns[c][r];
    return normalize(duet::transform_normal(inverse_affine(m), n));
}

Vec3 interpolated_normal(std::array<Vec3, 3> normals, Vec3 weights) {
    return normalize(normals[0] * weights.x + normals[1] * weights.y + normals[2] * weights.z);
}

Rgb blinn_phong(Vec3 p, Vec3 n, Vec3 light, Vec3 eye, Rgb diffuse, float specular, float shininess) {
    return lesson::blinn_phong(n, normalize(light - p), normalize(eye - p), {diffuse, specular, shininess});
}

} // namespace duet::lab
