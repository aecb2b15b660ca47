// This file defines the scenes that all ray kernels trace: the triangles of a mesh or a scene in an arrangement, a
// camera, and lights.
#pragma once

#include "common/scene/scene.h"

#include <memory>
#include <string>
#include <vector>

namespace duet::compare {

enum class Arrangement {
    kAlone,   ///< as in the file
    kRoom,    ///< inside a closed box, together with the camera
    kClutter, ///< 27 rotated copies on a grid inside a closed box: a test with incoherent rays
    kInstances, ///< the copies of kClutter as instances of one mesh, with a two-level BVH
};
/// Returns the arrangement "alone", "room", "clutter" or "instances". Throws Error for another name.
Arrangement parse_arrangement(std::string_view name);
/// Returns the name that parse_arrangement reads.
std::string_view name_of(Arrangement arrangement);

/// A KernelScene has triangle meshes only: one mesh in world space as the single object, or instances of one mesh
/// followed by a mesh in world space.
struct KernelScene {
    std::string mesh; ///< file name without its extension
    Arrangement arrangement = Arrangement::kAlone;
    std::unique_ptr<const Scene> scene; ///< scene to which accelerators refer
    Camera camera;
    std::vector<Light> lights; ///< targets of the shadow rays, used in turn
    bool enclosed = false;     ///< every ray from the camera or a surface hits a triangle
    std::size_t omitted_spheres = 0; ///< number of spheres in the file, which are omitted

    const Mesh& mesh_of(std::size_t object) const {
        return std::get<Mesh>(scene->shapes[scene->objects[object].shape]);
    }
    const Mesh& triangles() const { return mesh_of(0); }
    std::size_t triangle_count() const; ///< over all objects
    /// Returns whether a ray that starts inside must hit something: in a single closed mesh or in a closed room.
    bool closed() const { return enclosed || (scene->objects.size() == 1 && triangles().closed.value()); }
};

/// Returns whether the file is a bare mesh, which can be arranged. A scene file is used as it is.
bool is_bare_mesh(const std::filesystem::path& file);

/// Loads a bare mesh, framed by the loader but without the ground, or a scene file with its own camera and lights. In a
/// scene file, instances are transformed to world space at shutter opening, and quads are split into two triangles. An
/// area light refers to its triangles in the resulting mesh. Throws Error as load_scene does, if no triangle is left,
/// and if a scene file is to be arranged.
KernelScene load_kernel_scene(const std::filesystem::path& file, Arrangement arrangement);

/// Adds a closed box of half-side `half` around `center` to the mesh: twelve triangles that face inwards.
Mesh enclosed(Mesh mesh, Vec3 center, float half);

/// Returns 27 copies of the mesh. The mesh is first scaled uniformly to fit [−1, 1]³. Each copy is scaled by
/// 0.7, rotated by its own angles and placed on a grid with spacing 1.1.
Mesh cluttered(const Mesh& mesh);

/// Returns a scene of the given mesh and camera. The light is a square above the mesh. In a room it is below
/// the ceiling, and its two triangles are added as the last ones of the mesh.
KernelScene make_kernel_scene(std::string name, Arrangement arrangement, Mesh mesh, const Camera& camera);

} // namespace duet::compare
