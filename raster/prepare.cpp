// prepare() computes the data that all views of a scene share.
#include "raster/render.h"

#include "raster/geometry/geometry.h"
#include "raster/lighting/background.h"
#include "raster/prepare_limits.h"
#include "raster/probes/glass_shapes.h"
#include "raster/probes/irradiance_probes.h"
#include "raster/probes/reflection_probes.h"
#include "raster/probes/simplified_scene.h"
#include "raster/raster_scene.h"
#include "raster/shading/deferred.h"
#include "raster/shadows/shadow_maps.h"

#include "common/scene/alpha_mask.h"
#include "common/scene/motion_bounds.h"
#include "common/scene/shared_mesh.h"
#include "common/scene/used_materials.h"
#include "common/system/error.h"

#include <algorithm>

namespace duet::raster {
namespace {

bool all_opaque(const Scene& scene, const Object& object) {
    return std::none_of(object.materials.begin(), object.materials.end(), [&](std::uint32_t material) {
        return std::holds_alternative<Dielectric>(scene.materials[material]) || scene.maps[material].has_transparency();
    });
}

bool all_glass(const Scene& scene, const Object& object) {
    return std::all_of(object.materials.begin(), object.materials.end(), [&](std::uint32_t material) {
        return std::holds_alternative<Dielectric>(scene.materials[material]);
    });
}

std::optional<Rgb> uniform_color(const Scene& scene, const Object& object) {
    if (object.materials.size() != 1) return std::nullopt;
    const Material& material = scene.materials[object.materials.front()];
    if (scene.maps[object.materials.front()].perturbs_normal()) return std::nullopt;
    if (texture_slot(material).texture >= 0) return std::nullopt;
    return base_color(material, scene.textures, SurfacePoint{});
}

/// Returns the texture slot that gives the base color all over an object, if one filtered image texture does.
std::optional<RgbSlot> uniform_texture(const Scene& scene, const Object& object) {
    if (object.materials.size() != 1) return std::nullopt;
    const Material& material = scene.materials[object.materials.front()];
    const RgbSlot& slot = texture_slot(material);
    // Metal is excluded, because its colors may come from a table.
    if (slot.texture < 0 || std::holds_alternative<Metal>(material)) return std::nullopt;
    const auto* texture = std::get_if<ImageTexture>(&scene.textures.textures[static_cast<std::size_t>(slot.texture)]);
    const bool filtered =
        texture != nullptr && uses_footprint(texture->filter) && !scene.textures.mip_levels[texture->image].empty();
    return filtered ? std::optional(slot) : std::nullopt;
}

/// Returns true if the quads enclose a volume, as the six of a box do, and face outwards: each side of a quad is a
/// side of exactly one other quad in the opposite direction. Points that differ by rounding count as equal.
bool encloses(const QuadList& list) {
    struct Side {
        Vec3 from, to;
    };
    std::vector<Side> sides;
    double volume = 0;
    float size = 0;
    for (const Quad& quad : list.quads) {
        const std::array<Vec3, 4> c = corners(quad);
        for (std::size_t i = 0; i < 4; ++i) sides.push_back({c[i], c[(i + 1) % 4]});
        volume += dot(Vec3d(c[0] + c[2] - list.quads.front().corner * 2.0f), cross(Vec3d(quad.u), Vec3d(quad.v)));
        size = std::max({size, length(quad.u), length(quad.v)});
    }
    const auto same = [&](Vec3 a, Vec3 b) { return length(a - b) <= 1e-5f * size; };
    return volume > 0 && std::all_of(sides.begin(), sides.end(), [&](const Side& side) {
               return std::count_if(sides.begin(), sides.end(), [&](const Side& other) {
                          return same(side.from, other.to) && same(side.to, other.from);
                      }) == 1;
           });
}

RasterObject prepare_object(const Scene& scene, const Object& object) {
    const Shape& shape = scene.shapes[object.shape];
    RasterObject result;
    result.bounds = motion_bounds(object, shape);
    result.uniform_color = uniform_color(scene, object);
    result.uniform_texture = uniform_texture(scene, object);
    const Mesh* mesh = std::get_if<Mesh>(&shape);
    const auto* quads = std::get_if<QuadList>(&shape);
    result.closed = mesh != nullptr ? mesh->closed.value() : quads == nullptr || encloses(*quads);
    result.solid = mesh != nullptr && mesh->closed.value() && all_opaque(scene, object);
    return result;
}

std::shared_ptr<const RadianceMap> environment_map(const RasterSettings& settings, const Scene& scene) {
    const bool image = std::holds_alternative<ImageEnvironment>(scene.environment);
    const int side = image ? PrepareLimits(scene).radiance_map_side(256) : 32;
    const bool shown = settings.environment && scene.needs.environment;
    const auto arriving = [&](Vec3 w) {
        return RadianceMap::Arriving{shown ? radiance(scene.environment, w) : Rgb(), kInfinity};
    };
    return std::make_shared<const RadianceMap>(side, arriving, RadianceMap::Source{}, settings.threads);
}

/// Packs the shapes of a scene. Those of meshes that `before` has as well are taken from there.
SharedList<PackedShape> packed_shapes(const Scene& scene, const RasterSceneData* before) {
    SharedList<PackedShape> packed;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const auto known = before != nullptr ? shared_mesh(before->scene, scene, i) : std::nullopt;
        if (known)
            packed.push_back(before->shapes.shared(*known));
        else
            packed.push_back(PackedShape(scene.shapes[i]));
    }
    return packed;
}

/// Holds the light of an environment, which takes passes over all of its image.
struct EnvironmentLight {
    std::optional<EnvironmentSun> sun;
    IrradianceHarmonics sky; ///< irradiance without the sun
    Rgb mean;                ///< mean radiance, with the sun
};
EnvironmentLight environment_light(const Scene& scene, const RasterSettings& settings) {
    EnvironmentLight light;
    if (settings.shading == Shading::kLit && settings.environment)
        light.sun = find_sun(scene.environment, settings.threads);
    light.sky = environment_irradiance(scene.environment, light.sun ? &*light.sun : nullptr, settings.threads);
    light.mean = mean_radiance(scene.environment);
    return light;
}

/// Describes a scene, without the data that Shading::kLit reads. The packed meshes that it shares with the scene
/// `before`, which may be null, are taken from there.
RasterSceneData describe(const Scene& scene, const EnvironmentLight& environment, const RasterSceneData* before) {
    RasterSceneData data{.scene = scene,
                         .sun = environment.sun,
                         .sky_irradiance = environment.sky,
                         .shapes = packed_shapes(scene, before),
                         .texture_samplers = texture_samplers(scene.textures),
                         .ambient = environment.mean};
    for (const Material& material : scene.materials) data.lobes_of_color.push_back(LobesOfColor::of(material));
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const Shape& shape = scene.shapes[object.shape];
        data.objects.push_back(prepare_object(scene, object));
        const auto emits = [&](std::uint32_t material) { return emitter(scene.materials[material]) != nullptr; };
        const bool object_emits = std::ranges::any_of(object.materials, emits);
        data.any_emits = data.any_emits || object_emits;
        if (std::ranges::all_of(object.materials, emits)) data.emitters.push_back(i);
        const bool sphere = std::holds_alternative<Sphere>(shape);
        const bool alpha = can_be_seen_through(scene, object);
        if (alpha)
            (sphere ? data.alpha_spheres : data.alpha_polygonal).push_back(i);
        else
            (sphere ? data.spheres : data.polygonal).push_back(i);
        if (all_glass(scene, object) && !alpha) data.glass.push_back(i);
        data.primitives += primitive_count(shape);
        const bool stretched = sphere && surface_light_index(scene, i, 0) < 0;
        data.unsampled_emitters = data.unsampled_emitters || ((object.moving || stretched) && object_emits);
    }
    std::size_t packed = 0;
    for (std::size_t i = 0; i < data.shapes.size(); ++i)
        packed += data.shapes[i].vertices.size() * sizeof(PackedVertex) +
                  data.shapes[i].halves.size() * sizeof(PackedShape::Triangle);
    data.memory_bytes =
        static_cast<std::int64_t>(packed + sizeof(RasterSceneData) + data.objects.size() * sizeof(RasterObject) +
                                  scene.objects.size() * sizeof(std::uint32_t));
    data.geometries = std::make_shared<ObjectPool<Geometry>>();
    data.deferred_frames = std::make_shared<ObjectPool<DeferredFrame>>();
    return data;
}

/// Renders the irradiance probes. They see a scene of simplified meshes.
std::shared_ptr<const IrradianceProbes> irradiance_probes(const RasterSettings& settings, const RasterSceneData& data) {
    const std::optional<Scene> simple = simplified_scene(data, IrradianceProbes::detail(data));
    if (!simple) return std::make_shared<const IrradianceProbes>(data, data, settings);
    RasterSceneData seen = describe(*simple, {data.sun, data.sky_irradiance, data.ambient}, &data);
    seen.shadows = data.shadows;
    return std::make_shared<const IrradianceProbes>(data, seen, settings);
}

/// Renders the probes of deferred shading, if there is light that they can store and a surface that they can light. If
/// `before` is not null, its probes are reused.
void prepare_probes(const RasterSettings& settings, RasterSceneData& data, const RasterSceneData* before) {
    const Scene& scene = data.scene;
    if (scene.objects.empty() || is_dark(data, settings)) return;
    if (settings.indirect_light) {
        data.irradiance_probes = before ? before->irradiance_probes : irradiance_probes(settings, data);
        data.memory_bytes += static_cast<std::int64_t>(data.irradiance_probes->memory_bytes());
    }
    if (!any_used_material(scene, reflects)) return;
    data.environment_map = before ? before->environment_map : environment_map(settings, scene);
    data.reflection_probes =
        before ? before->reflection_probes : std::make_shared<const ReflectionProbes>(data, settings);
    data.glass_shapes = std::make_shared<const GlassShapes>(data, settings);
    data.memory_bytes += static_cast<std::int64_t>(data.environment_map->memory_bytes() +
                                                   data.reflection_probes->memory_bytes() +
                                                   data.glass_shapes->memory_bytes());
}

/// Renders the data that Shading::kLit reads: shadow maps, then the probes, whose light is shadowed by the maps.
void prepare_lit(const RasterSettings& settings, RasterSceneData& data, const RasterSceneData* before) {
    if (settings.shadows && data.light_count() > 0) {
        data.shadows = std::make_shared<const Shadows>(data, settings);
        data.memory_bytes += data.shadows->memory_bytes();
    }
    prepare_probes(settings, data, before);
}

/// Implements prepare(). If `before` is not null, its probes and the packed meshes that both scenes share are reused.
RasterScene prepare_after(const RasterSceneData* before, const Scene& scene, const RasterSettings& settings) {
    RasterSceneData data = describe(scene, environment_light(scene, settings), before);
    if (settings.shadow_map_side < 64 || settings.shadow_map_side > 8192)
        throw Error(message("shadow maps of ", settings.shadow_map_side, " texels a side: expected 64 to 8192"));
    if (settings.shadow_cells < 1 || settings.shadow_cells > Shadows::kMaxCells)
        throw Error(message(settings.shadow_cells, " pieces a light's side: expected 1 to ", Shadows::kMaxCells));
    if (settings.shading == Shading::kLit && settings.output != Output::kReversedDepth)
        prepare_lit(settings, data, before);
    return RasterScene(std::make_shared<const RasterSceneData>(std::move(data)));
}

} // namespace

RasterScene prepare(const Scene& scene, const RasterSettings& settings) {
    return prepare_after(nullptr, scene, settings);
}

std::optional<RasterScene> prepare_edited(const Scene& scene, const RasterSettings& settings,
                                          const RasterScene& before) {
    const RasterSceneData& data = before.data();
    const bool fits = data.objects.size() == scene.objects.size() &&
                      (data.reflection_probes != nullptr) == any_used_material(scene, reflects) &&
                      (data.irradiance_probes != nullptr) == settings.indirect_light;
    return fits ? std::optional(prepare_after(&data, scene, settings)) : std::nullopt;
}

} // namespace duet::raster
