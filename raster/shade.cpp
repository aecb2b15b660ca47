#include "raster/shade.h"

#include "raster/light/direct.h"
#include "raster/light/environment_light.h"
#include "raster/screen/glass.h"
#include "raster/screen/mirrored.h"
#include "raster/shadow/shadows.h"
#include "raster/split.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

struct DirectLight {
    std::span<const Light> lights;
    const ShadingPoint& point;
    Visibility visibility;
    bool transformed_cosines;

    Direct operator()(const DiffuseBsdf& bsdf) const { return direct_light(lights, bsdf, point, visibility); }
    Direct operator()(const MetalBsdf& bsdf) const {
        return direct_light(lights, bsdf, point, visibility, transformed_cosines);
    }
    Direct operator()(const RoughDiffuseBsdf& bsdf) const { return direct_light(lights, bsdf, point, visibility); }
    /// Light on the outer side is reflected as by a metal of the same reflectance.
    Direct operator()(const RoughDielectricBsdf& bsdf) const {
        const MetalBsdf surface{Rgb(sqr((bsdf.eta - 1) / (bsdf.eta + 1))), bsdf.alpha};
        return direct_light(lights, surface, point, visibility, transformed_cosines);
    }
    Direct operator()(const DielectricBsdf&) const { return {}; }
    Direct operator()(const ThinDielectricBsdf&) const { return {}; }
    Direct operator()(const LayeredBsdf&) const { return {}; } // its layers are shaded separately
};

LightParts lit(const PreparedData& data, const Settings& settings, const PartSet& asked, const ShadingPoint& point,
               const Bsdf& bsdf, Vec3 to_viewer, const Screen* screen, TapRange taps);

/// Shades the layers separately, each weighted by its visibility at this viewing angle. All reflected light of the
/// environment counts as reflection, as in the path tracer's parts.
LightParts lit_layers(const PreparedData& data, const Settings& settings, PartSet asked, const ShadingPoint& point,
                      const LayeredBsdf& layers, Vec3 to_viewer, const Screen* screen, TapRange taps) {
    asked.environment = asked.reflection;
    asked.emission = false;
    const LayeredBsdf::Albedos seen = layers.albedos(std::abs(point.wo.z));
    const float under = 1 - seen.coat.r;
    LightParts sum;
    const auto add = [&](const Bsdf& layer, float weight) {
        const LightParts parts = lit(data, settings, asked, point, layer, to_viewer, screen, taps);
        sum.direct += parts.direct * weight;
        sum.shadowed += parts.shadowed * weight;
        sum.reflection += (parts.reflection + parts.environment) * weight;
    };
    if (!is_black(seen.diffuse)) add(DiffuseBsdf{seen.diffuse}, 1);
    add(MetalBsdf(layers.glossy.normal, layers.glossy.alpha), under);
    if (layers.coat > 0) add(MetalBsdf(Rgb(LayeredBsdf::kCoatNormal), layers.coat_alpha), layers.coat);
    return sum;
}

LightParts lit(const PreparedData& data, const Settings& settings, const PartSet& asked, const ShadingPoint& point,
               const Bsdf& bsdf, Vec3 to_viewer, const Screen* screen, TapRange taps) {
    if (const auto* layers = std::get_if<LayeredBsdf>(&bsdf))
        return lit_layers(data, settings, asked, point, *layers, to_viewer, screen, taps);
    const Scene& scene = data.scene;
    LightParts parts;
    if (asked.emission)
        parts.emission = emitted(scene.materials[point.surface.material], scene.textures, point.surface, to_viewer);
    if (asked.direct) {
        const Visibility visibility{settings.shadows ? data.shadows.get() : nullptr, taps};
        const Direct direct =
            std::visit(DirectLight{scene.lights, point, visibility, settings.transformed_cosines}, bsdf);
        parts.direct = direct.arriving, parts.shadowed = direct.shadowed;
    }
    const bool diffuse = is_diffuse(bsdf);
    if (shows_environment(data, settings) && (diffuse ? asked.environment : asked.reflection))
        (diffuse ? parts.environment : parts.reflection) =
            std::visit(EnvironmentLight(data, settings, point, screen), bsdf);
    const auto* metal = std::get_if<MetalBsdf>(&bsdf);
    if (metal != nullptr && asked.reflection && settings.screen_reflections && screen != nullptr &&
        !screen->first_look().radiance.empty() && metal->alpha <= kRoughestMirror)
        if (const std::optional<Rgb> mirrored = Mirrored(data, settings, *screen, point, *metal)(taps))
            parts.reflection = *mirrored;
    if (is_glass(data, point.surface.object) && asked.reflection && settings.screen_refractions && screen != nullptr &&
        screen->behind() != nullptr)
        parts.reflection = std::visit(SeenThrough(data, settings, *screen, point), bsdf);
    return parts;
}

/// Returns the transmittance of absorbing glass for one interface. The assumed path has half the mean length of
/// paths through a sphere that fills the object's box: 4/3 of the radius, which is 0.385 of the box's diagonal.
Rgb tint_by_absorption(const PreparedData& data, const Dielectric& glass, std::uint32_t object) {
    const float way = 0.385f / 2 * length(data.objects[object].bounds.diagonal());
    return {std::exp(-way * glass.absorption.r), std::exp(-way * glass.absorption.g),
            std::exp(-way * glass.absorption.b)};
}

Bsdf bsdf_of(const PreparedData& data, const SurfacePoint& surface) {
    const Material& material = data.scene.materials[surface.material];
    Bsdf bsdf = bsdf_at(material, data.scene.textures, surface);
    const auto* glass = data.scene.needs.insides ? std::get_if<Dielectric>(&material) : nullptr;
    if (glass == nullptr || is_black(glass->absorption)) return bsdf;
    const Rgb tint = tint_by_absorption(data, *glass, surface.object);
    if (auto* smooth = std::get_if<DielectricBsdf>(&bsdf)) smooth->tint *= tint;
    if (auto* rough = std::get_if<RoughDielectricBsdf>(&bsdf)) rough->tint *= tint;
    return bsdf;
}

Rgb background(const PreparedData& data, const Settings& settings, const Ray& ray) {
    if (const std::optional<Rgb> everywhere = constant_background(data, settings)) return *everywhere;
    return radiance(data.scene.environment, ray.direction);
}

} // namespace

LightParts shade_surface(const Prepared& prepared, const Settings& settings, const SurfacePoint& surface,
                         const Bsdf& bsdf, Vec3 to_viewer, const Screen* screen) {
    return lit(prepared.data(), settings, settings.parts, ShadingPoint(surface, to_viewer), bsdf, to_viewer, screen,
               TapRange{});
}

LightParts shade_hit(const Prepared& prepared, const Settings& settings, const Ray& ray, const Hit& hit,
                     const RayFootprint* footprint, const Screen* screen) {
    const PreparedData& data = prepared.data();
    if (!hit.valid())
        return {.emission = background(data, settings, ray),
                .direct = {},
                .environment = {},
                .reflection = {},
                .shadowed = {}};
    const SurfacePoint surface = surface_point(data.scene, ray, hit, footprint);
    return shade_surface(prepared, settings, surface, bsdf_of(data, surface), -ray.direction, screen);
}

Shaded shade(const PreparedData& data, const Settings& settings, const HitTile& tile, int x, int y) {
    const Ray& ray = tile.ray(x, y);
    const Hit& hit = tile.hit(x, y);
    if (!hit.valid()) return {.radiance = background(data, settings, ray), .normal = {}, .albedo = {}};
    const Scene& scene = data.scene;
    const RayFootprint footprint =
        scene.needs.footprints ? tile.footprint(x, y, settings.samples_per_pixel) : RayFootprint{};
    const std::uint32_t material = material_index(scene, hit.object, hit.primitive);
    const SurfacePoint surface = surface_point(scene, ray, hit, &footprint, surface_detail(scene, material));
    const ShadingPoint point(surface, -ray.direction);
    const auto color = [&] { return base_color(scene.materials[surface.material], scene.textures, surface); };
    Shaded result{.radiance = {}, .normal = point.ns, .albedo = settings.aovs.albedo ? color() : Rgb()};
    const TapRange taps =
        settings.samples_per_pixel >= TapRange::kBlocks ? TapRange::of_quadrant(tile.quadrant()) : TapRange{};
    if (settings.shading == Shading::kLit)
        result.radiance =
            lit(data, settings, settings.parts, point, bsdf_of(data, surface), -ray.direction, tile.screen(), taps)
                .sum();
    return result;
}

} // namespace duet::raster
