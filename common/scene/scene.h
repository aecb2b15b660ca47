// This file defines the scene, the one description that both pipelines use. It is immutable once loaded.
#pragma once

#include "common/camera/camera.h"
#include "common/geometry/footprint.h"
#include "common/geometry/shape.h"
#include "common/geometry/surface_point.h"
#include "common/image/view_transform.h"
#include "common/light/environment.h"
#include "common/light/light.h"
#include "common/material/material.h"
#include "common/material/surface_maps.h"
#include "common/medium/medium.h"
#include "common/system/shared_list.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace duet {

/// An Object is a shape placed in the world. Groups and instances of a file are flattened to a list of objects.
/// Static objects whose shape is used once are baked: their shape is in world space and their transform is the
/// identity (see Transforms).
struct Object {
    std::string name{};
    std::uint32_t shape = 0; ///< index into Scene::shapes
    /// These are indices into Scene::materials, one for each material slot of the shape, and at least one.
    std::vector<std::uint32_t> materials{};
    std::uint32_t entry = 0;  ///< index of the element of the file's "objects" that the object belongs to
    bool identity = true;     ///< whether to_world is the identity at all times
    bool moving = false;      ///< whether to_world_end differs from to_world
    Mat4 to_world{}, to_object{}; ///< transform at the start of the motion (time 0), and its inverse
    Mat4 to_world_end{};          ///< transform at the end (time 1); entries are interpolated in between

    /// Sets the transform at the start and at the end of the motion, and the members that are derived from it.
    void place(const Mat4& start, const Mat4& end);
    /// Sets the transform of an object at rest.
    void place(const Mat4& at) { place(at, at); }
};

/// SceneNeeds lists the features that the scene uses. Pipelines use it to leave out code paths once, at the start.
struct SceneNeeds {
    bool textures = false, image_textures = false;
    bool footprints = false;       ///< an image texture is filtered over the sample's footprint
    bool normal_maps = false;      ///< normal or bump maps
    bool emitter_textures = false; ///< an emissive surface has a radiance texture
    bool alpha = false;            ///< alpha masks or alpha blending
    bool motion = false, lens = false;
    bool environment = false; ///< the environment is not black
    bool delta_lights = false, surface_lights = false;
    bool glossy = false;       ///< rough metal, frosted glass and layered materials
    bool layers = false;       ///< principled and coated materials
    bool interiors = false;    ///< glass that absorbs or has a priority
    bool media = false;        ///< fog, clouds, smoke
    bool subsurface = false;   ///< solids with subsurface scattering
    bool specular = false;     ///< mirrors and glass
    bool transmission = false; ///< glass
    bool meshes = false, quads = false, spheres = false;
    bool smooth_normals = false;
    bool instances = false; ///< an object whose transform is not the identity
};

/// A Scene is all that a file describes. It does not change once it is loaded.
struct Scene {
    std::filesystem::path path; ///< file that the scene was loaded from
    /// These are all files that were read, in order: `path`, then meshes, MTL files and images.
    std::vector<std::filesystem::path> files;
    Camera camera;
    int width = 640, height = 480;
    ViewTransform view_transform; ///< how 8-bit files show the image

    TextureSet textures;
    std::vector<Material> materials;
    std::vector<std::string> material_names; ///< parallel to materials
    std::vector<SurfaceMaps> maps; ///< parallel to materials, or shorter: the remaining materials have no maps
    SharedList<Shape> shapes;
    std::vector<Object> objects;
    /// The lights of the file come first. One SurfaceLight for each emissive primitive of a static object follows.
    std::vector<Light> lights;
    /// All lights from this index on are SurfaceLights, sorted by (object, primitive).
    std::size_t first_surface_light = 0;
    Environment environment;
    std::vector<Medium> media;
    Box3 bounds; ///< bounds of all objects over their whole motion
    SceneNeeds needs;
};

/// Says whether finish_scene() bakes static objects whose shape is used once. An editor keeps all transforms, so that
/// the shapes are the same objects before and after an edit, and what was computed from them can be used again.
enum class Transforms { kBaked, kKept };

/// Computes the scene's derived data: surface lights, bounds, needs, and whether meshes are closed. This is the last
/// step of every loader, and of programs that build a scene in code (build_scene.h). Throws Error where the scene's
/// parts do not fit together.
void finish_scene(Scene& scene, Transforms transforms = Transforms::kBaked);

/// An ObjectTransform is an object's transform and its inverse at a time in [0, 1] of the motion.
struct ObjectTransform {
    Mat4 to_world, to_object;
};
/// Returns the transform at a time in [0, 1]. Matrix entries are interpolated linearly between both ends of the motion.
ObjectTransform object_transform(const Object& object, float time);

/// Transforms a ray from world space to object space. The direction is not normalized, so t has the same meaning in
/// both spaces.
inline Ray to_object_space(const Ray& ray, const Mat4& to_world, const Mat4& to_object) {
    Ray local = ray;
    local.origin = transform_point_inverse(to_world, to_object, ray.origin);
    local.direction = transform_vector(to_object, ray.direction);
    return local;
}

/// Returns the surface point of a hit, including its material. Both pipelines use this function. The shading normal
/// includes the material's normal and bump maps, for which `detail` must be kAll. The footprint is set where
/// `footprint` is given and some texture of the scene is filtered.
SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit, const RayFootprint* footprint = nullptr,
                           SurfaceDetail detail = SurfaceDetail::kAll);
/// Returns the opacity of the surface at a hit, in [0, 1]: the fraction of light that it stops. For an opaque
/// material it returns 1 without evaluating the surface point.
float opacity(const Scene& scene, const Ray& ray, const Hit& hit);
/// Returns the detail of surface points that a material needs: all, or without uv where it has no texture and no map.
SurfaceDetail surface_detail(const Scene& scene, std::uint32_t material);
/// Returns the index of a primitive's material in Scene::materials.
std::uint32_t material_index(const Scene& scene, std::uint32_t object, std::uint32_t primitive);
/// Returns the index in Scene::lights of a primitive's SurfaceLight, or −1 where it emits nothing or moves.
std::int64_t surface_light_index(const Scene& scene, std::uint32_t object, std::uint32_t primitive);
/// PrimitiveVertices holds the vertices of a triangle or quad in its object's space, 3 or 4 points in order (quad:
/// corner, +u, +u+v, +v). For a baked object that is world space.
struct PrimitiveVertices {
    std::array<Vec3, 4> p;
    int count = 0;
};
/// Returns the vertices of a primitive of a mesh or a list of quads, not of a sphere.
PrimitiveVertices primitive_vertices(const Shape& shape, std::uint32_t primitive);

/// Loads a scene file (.json) or a bare mesh (.obj), for which it adds a camera, a ground, a sky and a sun. Throws
/// Error for a file that cannot be used.
Scene load_scene(const std::filesystem::path& path);
/// Reads the text of a scene file, as an editor holds it. Names of files are relative to the folder of `path`, which
/// itself is not read.
Scene parse_scene(const std::filesystem::path& path, std::string_view text);

} // namespace duet
