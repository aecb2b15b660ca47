// Defines the data that the rasterizer computes once per scene, for any number of views.
#pragma once

#include "common/scene/scene.h"
#include "common/system/object_pool.h"
#include "raster/gbuffer/surface_lobes.h"
#include "raster/geometry/packed_shape.h"
#include "raster/lighting/environment_irradiance.h"
#include "raster/settings.h"
#include "raster/shader/texture_sampler.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace duet::raster {

/// Holds the properties of an object that do not depend on the view.
struct RasterObject {
    Box3 bounds;        ///< in world space, over all of the object's motion
    std::optional<Rgb> uniform_color;       ///< base color, if it is the same all over the object
    std::optional<RgbSlot> uniform_texture; ///< texture slot, if one filtered texture determines the base color
    bool closed = false; ///< whether it is a sphere, box or mesh that is closed and oriented outwards
    bool solid = false; ///< whether it is an opaque, closed mesh, oriented outwards: back faces are hidden
};

struct DeferredFrame; // raster/shading/deferred.h
struct Geometry; // raster/geometry/geometry.h
class Shadows;        // raster/shadows/shadow_maps.h
class IrradianceProbes; // raster/probes/irradiance_probes.h
class RadianceMap; // raster/probes/radiance_map.h
class ReflectionProbes; // raster/probes/reflection_probes.h
class GlassShapes; // raster/probes/glass_shapes.h

/// Holds the result of prepare(), which is computed once per scene for any number of views.
struct RasterSceneData {
    const Scene& scene;
    std::vector<RasterObject> objects{};  ///< parallel to Scene::objects
    std::vector<std::optional<LobesOfColor>> lobes_of_color{}; ///< parallel to Scene::materials
    bool any_emits = false;               ///< whether any surface emits light
    std::vector<std::uint32_t> emitters{}; ///< indices of the objects all of whose materials emit, in order
    std::vector<std::uint32_t> polygonal{}; ///< indices of the mesh and quad objects without alpha, in order
    std::vector<std::uint32_t> spheres{};  ///< indices of the sphere objects without alpha, in order
    /// These lists hold the alpha-masked and alpha-blended objects, which are neither in `polygonal` nor in `spheres`
    /// (raster/shading/alpha_layers.h).
    std::vector<std::uint32_t> alpha_polygonal{}, alpha_spheres{};
    /// This list holds the objects of `polygonal` and `spheres` whose materials are all glass, in order
    /// (raster/probes/glass_shapes.h).
    std::vector<std::uint32_t> glass{};
    std::int64_t primitives = 0;          ///< triangles, quads and spheres of all objects
    /// This is the sun of an environment image, if Shading::kLit shows one. Diffuse surfaces and media receive its
    /// light as that of light(scene.lights.size()).
    std::optional<EnvironmentSun> sun{};
    IrradianceHarmonics sky_irradiance; ///< irradiance from the environment without its sun
    SharedList<PackedShape> shapes{};     ///< parallel to Scene::shapes
    std::vector<TextureSampler> texture_samplers{}; ///< one per image
    Rgb ambient{};                        ///< mean radiance of the environment, the ambient light of Shading::kPhong
    /// This is true if the scene has emissive surfaces that are not lights: moving objects, or non-uniformly scaled
    /// spheres.
    bool unsampled_emitters = false;
    std::int64_t memory_bytes = 0;
    std::shared_ptr<const Shadows> shadows{};   ///< null if the settings or the scene need none
    std::shared_ptr<const IrradianceProbes> irradiance_probes{}; ///< null if the settings need none
    std::shared_ptr<const RadianceMap> environment_map{}; ///< of the environment alone; null if the settings need none
    std::shared_ptr<const ReflectionProbes> reflection_probes{}; ///< null if the settings need none
    std::shared_ptr<const GlassShapes> glass_shapes{}; ///< null if the settings need none
    /// Returns a light: one of Scene::lights, or the sun, which comes after them.
    Light light(std::size_t index) const { return index < scene.lights.size() ? scene.lights[index] : sun->light; }
    std::size_t light_count() const { return scene.lights.size() + (sun ? 1 : 0); }
    /// Returns whether any object but `excluded` has an alpha mask or alpha blending.
    bool has_layers(std::uint32_t excluded = kNoObject) const {
        const auto counts = [&](std::uint32_t object) { return object != excluded; };
        return std::ranges::any_of(alpha_polygonal, counts) || std::ranges::any_of(alpha_spheres, counts);
    }
    std::shared_ptr<ObjectPool<Geometry>> geometries{}; ///< one for each rendering that runs at the same time
    std::shared_ptr<ObjectPool<DeferredFrame>> deferred_frames{}; ///< one for each rendering that runs at the same time
};

} // namespace duet::raster
