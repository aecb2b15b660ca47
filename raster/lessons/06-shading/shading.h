// How bright a surface is, and meshes placed in the world.
#pragma once

#include "common/image/rgb.h"
#include "raster/lessons/05-clipping/clip.h"

namespace duet::lesson {

/// The triangles of a mesh in the world and in clip space. Points go by the matrix itself; normals by the transpose of
/// its inverse, so that they stay at right angles to the surface where it is stretched.
inline std::vector<Triangle> place_mesh(const Mesh& mesh, const Mat4& world_from_mesh, const Mat4& clip_from_world) {
    const Mat4 mesh_from_world = inverse_affine(world_from_mesh);
    std::vector<Triangle> triangles(mesh.size() / 3);
    for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
        const Vec3 p = transform_point(world_from_mesh, mesh[i].p);
        const Vec3 n = normalize(transform_normal(mesh_from_world, mesh[i].n));
        triangles[i / 3][i % 3] = {clip_from_world * Vec4(p, 1), p, n, mesh[i].uv};
    }
    return triangles;
}

/// What a surface is like: the diffuse color, and how strong and how small its highlights are.
struct Surface {
    Rgb diffuse{0.8f};
    float specular = 0.4f, shininess = 60;
};

/// The light of one white light source that a surface reflects to the eye. n is the normal; to_light and to_eye lead
/// away from the surface; all three have length 1. (Phong 1975, "Illumination for Computer Generated Pictures", with
/// the half vector of Blinn 1977, "Models of Light Reflection for Computer Synthesized Pictures")
inline Rgb blinn_phong(Vec3 n, Vec3 to_light, Vec3 to_eye, const Surface& surface) {
    const float cosine = dot(n, to_light);
    if (cosine <= 0) return Rgb(0); // the light source is behind the surface
    const Vec3 half = normalize(to_light + to_eye);
    const float highlight = surface.specular * std::pow(max(dot(n, half), 0.0f), surface.shininess);
    return surface.diffuse * cosine + Rgb(highlight);
}

} // namespace duet::lesson
