// What all ray kernels trace alike: the triangles of a mesh or a scene, alone or arranged, a camera, and lights.
#pragma once

#include "common/scene/scene.h"

#include <memory>
#include <string>
#include <vector>

namespace duet::compare {

enum class Arrangement {
    kAlone,   ///< as the file has it
    kRoom,    ///< within a closed box, the camera too
    kClutter, ///< 27 copies, each rotated in its own way, on a grid within a closed box: the honest incoherent test
    kInstances, ///< the same, but the copies are instances of one mesh: a hierarchy of two levels
};
/// "alone", "room", "clutter" or "instances"; throws Error for another name.
Arrangement parse_arrangement(const std::string& name);
const char* name_of(Arrangement arrangement);

/// One mesh of triangles in world space, the single object of its scene; or instances of one, and then a mesh in world
/// space.
struct KernelScene {
    std::string mesh; ///< the file's name without its ending
    Arrangement arrangement = Arrangement::kAlone;
    std::unique_ptr<const Scene> scene; ///< accelerators refer to it
    Camera camera;
    std::vector<Light> lights; ///< what shadow rays go to, each in its turn
    bool enclosed = false;     ///< every ray from the camera or a surface meets a triangle
    std::size_t left_out = 0;  ///< the file's spheres: what is compared is triangles

    const Mesh& mesh_of(std::size_t object) const { return std::get<Mesh>(scene->shapes[scene->objects[object].shape]); }
    const Mesh& triangles() const { return mesh_of(0); }
    std::size_t triangle_count() const; ///< of all objects
    /// Whether a ray that starts within must hit something: a single closed mesh, or all in a closed room.
    bool closed() const { return enclosed || (scene->objects.size() == 1 && triangles().closed); }
};

/// Whether the file is a bare mesh, which can be arranged; a scene file stands as it is.
bool is_bare_mesh(const std::filesystem::path& file);

/// A bare mesh as the loader frames it (without its ground), or a scene file with its own camera and lights: instances
/// in their places as the shutter opens, quads cut in two; a light that is a triangle there names it.
/// Throws Error as load_scene does, where nothing is left, and where a scene file is to be arranged.
KernelScene load_kernel_scene(const std::filesystem::path& file, Arrangement arrangement);

/// A triangle mesh within the closed box of half-side `half` around `center`: twelve triangles that face inwards.
Mesh enclosed(Mesh mesh, Vec3 center, float half);

/// 27 copies of the mesh, which is first scaled to fill [−1, 1]³ as far as its form allows: × 0.7, each rotated by
/// angles of its own, at the points of a grid of 1.1.
Mesh cluttered(const Mesh& mesh);

/// A mesh that is there already, with a camera; the light is a square above it, below the ceiling where there is one:
/// then it is two more triangles, the last.
KernelScene make_kernel_scene(std::string name, Arrangement arrangement, Mesh mesh, const Camera& camera);

} // namespace duet::compare
