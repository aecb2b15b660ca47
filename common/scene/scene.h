// The scene: one description for both pipelines. Immutable once loaded.
#pragma once

#include "common/camera/camera.h"
#include "common/geometry/footprint.h"
#include "common/geometry/shape.h"
#include "common/geometry/surface_point.h"
#include "common/light/environment.h"
#include "common/light/light.h"
#include "common/material/material.h"
#include "common/material/surface_maps.h"
#include "common/system/sabotage.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace duet {

/// A shape placed in the world; groups and instances of a file are flattened to a list of these. Objects that stand
/// still and are placed once are baked: their shape is in world space and their transform the identity.
struct Object {
    std::string name;
    std::uint32_t shape = 0; ///< index into Scene::shapes
    std::vector<std::uint32_t>
        materials;            ///< index into Scene::materials, one a material slot of the shape; at least one
    bool identity = true;     ///< to_world is the identity, at all times
    bool moving = false;      ///< to_world_end differs from to_world
    Mat4 to_world, to_object; ///< at the start of the motion (time 0)
    Mat4 to_world_end;        ///< at its end (time 1); in between entries are interpolated
};

/// What the scene asks for: pipelines decide once, from this, what to leave out.
struct SceneNeeds {
    bool textures = false, image_textures = false;
    bool footprints = false;   ///< an image texture is filtered over what a sample stands for
    bool normal_maps = false;  ///< normal or bump maps
    bool lamp_textures = false; ///< an emissive surface emits a picture
    bool alpha = false;        ///< cut-outs, or surfaces that stop a part of the light only
    bool motion = false, lens = false;
    bool environment = false; ///< it is not black
    bool delta_lights = false, surface_lights = false;
    bool glossy = false;       ///< rough metal, frosted glass, and layers
    bool layers = false;       ///< layered materials: principled and coated ones
    bool insides = false;      ///< glass that absorbs, or has a priority
    bool specular = false;     ///< mirrors and glass
    bool transmission = false; ///< glass
    bool meshes = false, quads = false, spheres = false;
    bool smooth_normals = false;
    bool instances = false; ///< an object whose transform is not the identity
};

struct Scene {
    std::filesystem::path path; ///< the file it was loaded from
    std::vector<std::filesystem::path>
        files; ///< all that was read: `path`, then meshes, MTL files and pictures, in the order read
    Camera camera;
    int width = 640, height = 480;

    TextureSet textures;
    std::vector<Material> materials;
    std::vector<std::string> material_names; ///< parallel to materials
    std::vector<SurfaceMaps> maps;           ///< parallel to materials, or shorter: what is left has none
    std::vector<Shape> shapes;
    std::vector<Object> objects;
    std::vector<Light> lights; ///< as described, then one SurfaceLight for each emissive primitive that stands still
    std::size_t first_surface_light =
        0; ///< lights[first_surface_light …] are SurfaceLights, sorted by (object, primitive)
    Environment environment;
    Box3 bounds; ///< of all objects over all their motion
    SceneNeeds needs;
};

/// Fills in what follows from the rest: surface lights, bounds, needs, closedness of meshes; bakes single, still
/// objects. The last step of every loader, and of tests that build scenes by hand.
void finish_scene(Scene& scene);

/// An object's transform and its inverse at a time in [0, 1] of the motion.
struct ObjectTransform {
    Mat4 to_world, to_object;
};
ObjectTransform object_transform(const Object& object, float time);

/// A ray in the world, as the object sees it: the direction is not normalized, so t means the same.
inline Ray to_object_space(const Ray& ray, const Mat4& to_world, const Mat4& to_object) {
    Ray local = ray;
    local.origin = sabotaged(Guard::kPlaceDifference) ? transform_point(to_object, ray.origin)
                                                      : transform_point_back(to_world, to_object, ray.origin);
    local.direction = transform_vector(to_object, ray.direction);
    return local;
}

/// The surface point of a hit, with material, by the one way that both pipelines share: its normal as the material's
/// maps have it; with the footprint of its ray at the hit, where one is given and some texture is filtered. Maps ask for all detail.
SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit, const RayFootprint* footprint = nullptr,
                           SurfaceDetail detail = SurfaceDetail::kAll);
/// The part of the light that the surface stops at a hit, in [0, 1]; 0 in a hole. 1 without a look at the hit where its
/// material is whole.
float opacity(const Scene& scene, const Ray& ray, const Hit& hit);
/// What a material asks of its surface points: all of them, or no uv where neither a texture nor a map looks at them.
SurfaceDetail surface_detail(const Scene& scene, std::uint32_t material);
/// The material of a primitive.
std::uint32_t material_index(const Scene& scene, std::uint32_t object, std::uint32_t primitive);
/// The index in Scene::lights of the SurfaceLight of a primitive, or −1 where it emits nothing or moves.
std::int64_t surface_light_index(const Scene& scene, std::uint32_t object, std::uint32_t primitive);
/// The corners of a triangle or quad in its object's space: 3 or 4 points, in order (quad: corner, +u, +u+v, +v). Of a
/// baked object these are world space.
struct Corners {
    std::array<Vec3, 4> p;
    int count = 0;
};
Corners primitive_corners(const Shape& shape, std::uint32_t primitive);

/// Loads a scene file (.json) or a bare mesh (.obj: camera framed on it, sky and ground added). Throws Error.
Scene load_scene(const std::filesystem::path& path);

} // namespace duet
