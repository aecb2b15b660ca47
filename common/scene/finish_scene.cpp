// This file computes the data that is derived from a scene's description, once for both pipelines.
#include "common/medium/density_grid.h"
#include "common/scene/bake.h"
#include "common/scene/build_scene.h"
#include "common/scene/emitter_texture.h"
#include "common/scene/motion_bounds.h"
#include "common/scene/scene.h"
#include "common/system/error.h"
#include "common/system/escape.h"
#include "common/system/parallel.h"

#include <algorithm>

namespace duet {

namespace {

/// Beyond this bound the squares of coordinates come close to float's range. It is slightly above 1e18, the limit for
/// numbers in files.
constexpr float kMaxCoordinate = 1.001e18f;

void bake_single_objects(Scene& scene) {
    std::vector<std::uint32_t> uses(scene.shapes.size());
    for (const Object& object : scene.objects) ++uses[object.shape];
    for (Object& object : scene.objects)
        if (!object.identity && !object.moving && uses[object.shape] == 1) bake(scene, object);
}

/// Sets Mesh::closed. Meshes that are shared, and have not been baked, know it already.
void find_closed_meshes(SharedList<Shape>& shapes, Transforms transforms) {
    parallel_for(shapes.size(), 0, [&](std::size_t i) {
        const auto* mesh = std::get_if<Mesh>(&shapes[i]);
        if (mesh == nullptr || (transforms == Transforms::kKept && mesh->closed)) return;
        const bool closed = is_closed_outwards(*mesh);
        if (mesh->closed != closed) std::get<Mesh>(shapes.edit(i)).closed = closed;
    });
}

void find_bounds(Scene& scene) {
    scene.bounds = Box3();
    for (const Object& object : scene.objects) {
        const Box3 box = motion_bounds(object, scene.shapes[object.shape]);
        const Vec3 extent = max(abs(box.low), abs(box.high));
        if (!is_finite(extent) || max_component(extent) > kMaxCoordinate)
            throw Error(message(scene.path.string(), ": the object ", quoted_text(object.name),
                                " reaches beyond 1e18 meters, to ", max_component(extent)));
        scene.bounds.extend(box);
    }
    if (scene.objects.empty()) scene.bounds = Box3{Vec3(scene.camera.look_at), Vec3(scene.camera.look_at)};
}

/// Returns the value of a texture's red channel if it is the same everywhere, and nothing otherwise.
std::optional<float> constant_red(const TextureSet& set, const Texture& texture) {
    const auto if_equal = [](Rgb a, Rgb b) { return a.r == b.r ? std::optional(a.r) : std::nullopt; };
    if (const auto* checker = std::get_if<CheckerTexture>(&texture)) return if_equal(checker->even, checker->odd);
    if (const auto* noise = std::get_if<NoiseTexture>(&texture)) return if_equal(noise->low, noise->high);
    const auto& pixels = set.images[std::get<ImageTexture>(texture).image].pixels();
    const bool constant =
        !pixels.empty() && std::ranges::all_of(pixels, [&](Rgb pixel) { return pixel.r == pixels.front().r; });
    return constant ? std::optional(pixels.front().r) : std::nullopt;
}

/// Raises the mean free paths of solids to the least that positions in float can resolve. A path below it in all
/// channels becomes 0, which is a diffuse surface.
void limit_mean_free_paths(Scene& scene) {
    // This is a fraction of the largest coordinate. Origins of rays are offset by up to 1 % of such a length.
    constexpr float kLeast = 1.0f / 65536;
    std::vector<float> extents(scene.materials.size());
    for (const Object& object : scene.objects) {
        const Box3 box = motion_bounds(object, scene.shapes[object.shape]);
        const float extent = max_component(max(abs(box.low), abs(box.high)));
        for (const std::uint32_t material : object.materials) extents[material] = max(extents[material], extent);
    }
    for (std::size_t i = 0; i < extents.size(); ++i) {
        Rgb* path = mean_free_path(scene.materials[i]);
        if (path == nullptr || is_black(*path)) continue;
        const auto* principled = std::get_if<Principled>(&scene.materials[i]);
        if (principled != nullptr && principled->subsurface.value == 0) {
            *path = Rgb();
            continue;
        }
        const float least = kLeast * extents[i];
        const Rgb raised(max(path->r, least), max(path->g, least), max(path->b, least));
        *path = max_component(*path) < least ? Rgb() : raised;
    }
}

/// Drops what costs time and changes no pixel: lights that emit nothing, media that do nothing, and masks that hide
/// nothing. The alpha channel of many an image is 1 everywhere.
void drop_ineffective(Scene& scene) {
    std::erase_if(scene.lights, [](const Light& light) { return is_black(light); });
    std::erase_if(scene.media, [](const Medium& m) {
        return (is_black(m.scattering) && is_black(m.absorption)) || (m.density && m.density->largest() == 0);
    });
    for (SurfaceMaps& maps : scene.maps) {
        if (maps.opacity.constant()) continue;
        const Texture& texture = scene.textures.textures[static_cast<std::size_t>(maps.opacity.texture)];
        if (const std::optional<float> red = constant_red(scene.textures, texture))
            maps.opacity = ScalarSlot(maps.opacity.value * *red);
    }
}

/// Returns the light of an emissive primitive of a static object. The result is empty for a primitive without area,
/// and for a sphere that its transform makes an ellipsoid: only BSDF sampling finds such emitters.
std::optional<SurfaceLight> surface_light(const Shape& shape, const Mat4& to_world, std::uint32_t primitive) {
    SurfaceLight light;
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        const std::optional<Sphere> moved = transformed(*sphere, to_world);
        if (!moved || !(moved->radius > 0)) return std::nullopt;
        light.shape = *moved;
        return light;
    }
    Vec3d area;
    if (const auto* list = std::get_if<QuadList>(&shape)) {
        const Quad quad = transformed(list->quads[primitive], to_world);
        area = cross(Vec3d(quad.u), Vec3d(quad.v));
        light.shape = quad;
    } else {
        const PrimitiveVertices c = primitive_vertices(shape, primitive);
        const auto [a, b, d] = transformed(std::array{c.p[0], c.p[1], c.p[2]}, to_world);
        area = cross(Vec3d(b) - Vec3d(a), Vec3d(d) - Vec3d(a));
        light.shape = SurfaceLight::Triangle{a, b, d};
    }
    if (!(length_squared(area) > 0)) return std::nullopt;
    return light;
}

void add_surface_lights(Scene& scene) {
    std::erase_if(scene.lights, [](const Light& light) { return std::holds_alternative<SurfaceLight>(light); });
    scene.first_surface_light = scene.lights.size();
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
        const Object& object = scene.objects[o];
        if (object.moving || std::none_of(object.materials.begin(), object.materials.end(),
                                          [&](std::uint32_t m) { return emitter(scene.materials[m]) != nullptr; }))
            continue;
        const Shape& shape = scene.shapes[object.shape];
        for (std::uint32_t p = 0; p < primitive_count(shape); ++p) {
            const Emissive* emissive = emitter(scene.materials[material_index(scene, o, p)]);
            if (emissive == nullptr) continue;
            std::optional<SurfaceLight> light = surface_light(shape, object.to_world, p);
            if (!light) continue;
            light->two_sided = emissive->two_sided;
            light->radiance = mean_radiance(scene, o, p, *emissive);
            light->object = o;
            light->primitive = p;
            scene.lights.push_back(*light);
        }
    }
}

void check_power(const Scene& scene) {
    const float radius = 0.5f * length(scene.bounds.diagonal());
    for (const Light& light : scene.lights)
        if (!std::isfinite(light_power(light, radius)))
            throw Error(scene.path.string() + ": a light's power is beyond what a float holds: radiance times area, or "
                                              "irradiance times the scene's cross-section");
}

void add_texture_needs(const Scene& scene, std::int32_t index, SceneNeeds& needs) {
    if (index < 0) return;
    needs.textures = true;
    const auto* image = std::get_if<ImageTexture>(&scene.textures.textures[static_cast<std::size_t>(index)]);
    if (image == nullptr) return;
    needs.image_textures = true;
    needs.footprints = needs.footprints || uses_footprint(image->filter);
}

void add_material_needs(const Scene& scene, const Material& material, SceneNeeds& needs) {
    if (const auto* metal = std::get_if<Metal>(&material)) {
        const bool smooth = sqr(metal->roughness.value) < MetalBsdf::kSmoothAlpha,
                   varies = !metal->roughness.constant();
        needs.specular = needs.specular || smooth || varies;
        needs.glossy = needs.glossy || !smooth;
    }
    if (const Emissive* emissive = emitter(material); emissive != nullptr && emissive->radiance_texture >= 0)
        needs.emitter_textures = true;
    if (const auto* glass = std::get_if<Dielectric>(&material)) {
        needs.transmission = true;
        needs.specular = needs.specular || glass->thin || glass->smooth() || !glass->roughness.constant();
        needs.glossy = needs.glossy || (!glass->thin && !glass->smooth());
        needs.interiors = needs.interiors || glass->has_interior_medium();
    }
    if (std::holds_alternative<Principled>(material) || std::holds_alternative<Coated>(material))
        needs.layers = needs.glossy = true;
    needs.subsurface = needs.subsurface || has_subsurface(material);
    for_each_texture(material, [&](std::int32_t texture) { add_texture_needs(scene, texture, needs); });
}

void add_map_needs(const Scene& scene, const SurfaceMaps& maps, SceneNeeds& needs) {
    needs.normal_maps = needs.normal_maps || maps.perturbs_normal();
    needs.alpha = needs.alpha || maps.has_transparency();
    for_each_texture(maps, [&](std::int32_t texture) { add_texture_needs(scene, texture, needs); });
}

SceneNeeds find_needs(const Scene& scene) {
    SceneNeeds needs;
    std::vector<bool> used(scene.materials.size());
    for (const Object& object : scene.objects) {
        for (const std::uint32_t material : object.materials) used[material] = true;
        const Shape& shape = scene.shapes[object.shape];
        const auto* mesh = std::get_if<Mesh>(&shape);
        needs.meshes = needs.meshes || mesh != nullptr;
        needs.quads = needs.quads || std::holds_alternative<QuadList>(shape);
        needs.spheres = needs.spheres || std::holds_alternative<Sphere>(shape);
        needs.smooth_normals = needs.smooth_normals || (mesh != nullptr && !mesh->normals.empty());
        needs.instances = needs.instances || !object.identity;
        needs.motion = needs.motion || object.moving;
    }
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) {
            add_material_needs(scene, scene.materials[i], needs);
            add_map_needs(scene, scene.maps[i], needs);
        }
    needs.lens = scene.camera.aperture_radius > 0;
    needs.media = !scene.media.empty();
    needs.environment = !is_black(scene.environment);
    needs.delta_lights = scene.first_surface_light > 0;
    needs.surface_lights = scene.lights.size() > scene.first_surface_light;
    return needs;
}

} // namespace

void finish_scene(Scene& scene, Transforms transforms) {
    scene.maps.resize(scene.materials.size());
    check_scene(scene);
    drop_ineffective(scene);
    build_mipmaps(scene.textures);
    if (transforms == Transforms::kBaked) bake_single_objects(scene);
    find_bounds(scene);
    limit_mean_free_paths(scene);
    find_closed_meshes(scene.shapes, transforms);
    add_surface_lights(scene);
    check_power(scene);
    scene.needs = find_needs(scene);
}

} // namespace duet
