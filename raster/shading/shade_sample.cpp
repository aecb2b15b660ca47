#include "raster/shading/shade_sample.h"

#include "raster/lighting/direct_lighting.h"
#include "raster/lighting/environment_light.h"
#include "raster/screen_space/screen_space_reflection.h"
#include "raster/screen_space/screen_space_refraction.h"
#include "raster/shading/light_components.h"
#include "raster/shadows/shadows.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

struct DirectLight {
    std::span<const Light> lights;
    const ShadingPoint& point;
    LightVisibility visibility;
    bool transformed_cosines;

    DirectRadiance operator()(const DiffuseBsdf& bsdf) const { return direct_light(lights, bsdf, point, visibility); }
    DirectRadiance operator()(const MetalBsdf& bsdf) const {
        return direct_light(lights, bsdf, point, visibility, transformed_cosines);
    }
    DirectRadiance operator()(const RoughDiffuseBsdf& bsdf) const {
        return direct_light(lights, bsdf, point, visibility);
    }
    /// Light on the outer side is reflected as by a metal of the same reflectance.
    DirectRadiance operator()(const RoughDielectricBsdf& bsdf) const {
        const MetalBsdf surface{Rgb(sqr((bsdf.eta - 1) / (bsdf.eta + 1))), bsdf.alpha};
        return direct_light(lights, surface, point, visibility, transformed_cosines);
    }
    DirectRadiance operator()(const DielectricBsdf&) const { return {}; }
    DirectRadiance operator()(const ThinDielectricBsdf&) const { return {}; }
    DirectRadiance operator()(const LayeredBsdf&) const { return {}; } // its layers are shaded separately
};

LightComponents shade_lit(const RasterSceneData& data, const RasterSettings& settings,
                          const LightComponentSet& requested, const ShadingPoint& point, const Bsdf& bsdf,
                          Vec3 to_viewer, const ScreenGBuffer* gbuffer, TapRange taps);

/// Shades the layers separately, each weighted by its visibility at this viewing angle. All reflected light of the
/// environment counts as reflection, as in the path tracer's parts.
LightComponents shade_lit_layers(const RasterSceneData& data, const RasterSettings& settings,
                                 LightComponentSet requested, const ShadingPoint& point, const LayeredBsdf& layers,
                                 Vec3 to_viewer, const ScreenGBuffer* gbuffer, TapRange taps) {
    requested.environment = requested.reflection;
    requested.emission = false;
    const LayeredBsdf::Albedos seen = layers.albedos(std::abs(point.wo.z));
    const float under = 1 - seen.coat.r;
    LightComponents sum;
    const auto add = [&](const Bsdf& layer, float weight) {
        const LightComponents parts = shade_lit(data, settings, requested, point, layer, to_viewer, gbuffer, taps);
        sum.direct += parts.direct * weight;
        sum.shadowed += parts.shadowed * weight;
        sum.reflection += (parts.reflection + parts.environment) * weight;
    };
    if (!is_black(seen.diffuse)) add(DiffuseBsdf{seen.diffuse}, 1);
    add(MetalBsdf(layers.glossy.f0, layers.glossy.alpha), under);
    if (layers.coat > 0) add(MetalBsdf(Rgb(LayeredBsdf::kCoatF0), layers.coat_alpha), layers.coat);
    return sum;
}

LightComponents shade_lit(const RasterSceneData& data, const RasterSettings& settings,
                          const LightComponentSet& requested, const ShadingPoint& point, const Bsdf& bsdf,
                          Vec3 to_viewer, const ScreenGBuffer* gbuffer, TapRange taps) {
    if (const auto* layers = std::get_if<LayeredBsdf>(&bsdf))
        return shade_lit_layers(data, settings, requested, point, *layers, to_viewer, gbuffer, taps);
    const Scene& scene = data.scene;
    LightComponents parts;
    if (requested.emission)
        parts.emission = emitted(scene.materials[point.surface.material], scene.textures, point.surface, to_viewer);
    if (requested.direct) {
        const LightVisibility visibility{settings.shadows ? data.shadows.get() : nullptr, taps};
        const DirectRadiance direct =
            std::visit(DirectLight{scene.lights, point, visibility, settings.transformed_cosines}, bsdf);
        parts.direct = direct.unshadowed, parts.shadowed = direct.shadowed;
    }
    const bool diffuse = is_diffuse(bsdf);
    if (shows_environment(data, settings) && (diffuse ? requested.environment : requested.reflection))
        (diffuse ? parts.environment : parts.reflection) =
            std::visit(EnvironmentLight(data, settings, point, gbuffer), bsdf);
    const auto* metal = std::get_if<MetalBsdf>(&bsdf);
    if (metal != nullptr && requested.reflection && settings.screen_reflections && gbuffer != nullptr &&
        !gbuffer->color_prepass().radiance.empty() && metal->alpha <= kMaxReflectionAlpha)
        if (const std::optional<Rgb> mirrored = ScreenSpaceReflection(data, settings, *gbuffer, point, *metal)(taps))
            parts.reflection = *mirrored;
    if (is_glass(data, point.surface.object) && requested.reflection && settings.screen_refractions &&
        gbuffer != nullptr && gbuffer->behind() != nullptr)
        parts.reflection = std::visit(ScreenSpaceRefraction(data, settings, *gbuffer, point), bsdf);
    return parts;
}

/// Returns the transmittance of absorbing glass for one interface. The assumed path has half the mean length of
/// paths through a sphere that fills the object's box: 4/3 of the radius, which is 0.385 of the box's diagonal.
Rgb tint_by_absorption(const RasterSceneData& data, const Dielectric& glass, std::uint32_t object) {
    const float path_length = 0.385f / 2 * length(data.objects[object].bounds.diagonal());
    return {std::exp(-path_length * glass.absorption.r), std::exp(-path_length * glass.absorption.g),
            std::exp(-path_length * glass.absorption.b)};
}

Bsdf bsdf_of(const RasterSceneData& data, const SurfacePoint& surface) {
    const Material& material = data.scene.materials[surface.material];
    Bsdf bsdf = bsdf_at(material, data.scene.textures, surface);
    const auto* glass = data.scene.needs.media ? std::get_if<Dielectric>(&material) : nullptr;
    if (glass == nullptr || is_black(glass->absorption)) return bsdf;
    const Rgb tint = tint_by_absorption(data, *glass, surface.object);
    if (auto* smooth = std::get_if<DielectricBsdf>(&bsdf)) smooth->tint *= tint;
    if (auto* rough = std::get_if<RoughDielectricBsdf>(&bsdf)) rough->tint *= tint;
    return bsdf;
}

Rgb background(const RasterSceneData& data, const RasterSettings& settings, const Ray& ray) {
    if (const std::optional<Rgb> everywhere = constant_background(data, settings)) return *everywhere;
    return radiance(data.scene.environment, ray.direction);
}

} // namespace

LightComponents shade_surface(const RasterScene& prepared, const RasterSettings& settings, const SurfacePoint& surface,
                              const Bsdf& bsdf, Vec3 to_viewer, const ScreenGBuffer* gbuffer) {
    return shade_lit(prepared.data(), settings, settings.components, ShadingPoint(surface, to_viewer), bsdf, to_viewer,
                     gbuffer, TapRange{});
}

LightComponents shade_hit(const RasterScene& prepared, const RasterSettings& settings, const Ray& ray, const Hit& hit,
                          const RayFootprint* footprint, const ScreenGBuffer* gbuffer) {
    const RasterSceneData& data = prepared.data();
    if (!hit.valid())
        return {.emission = background(data, settings, ray),
                .direct = {},
                .environment = {},
                .reflection = {},
                .shadowed = {}};
    const SurfacePoint surface = surface_point(data.scene, ray, hit, footprint);
    return shade_surface(prepared, settings, surface, bsdf_of(data, surface), -ray.direction, gbuffer);
}

ShadedSample shade_sample(const RasterSceneData& data, const RasterSettings& settings, const HitTile& tile, int x,
                          int y) {
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
    ShadedSample result{.radiance = {}, .normal = point.ns, .albedo = settings.aovs.albedo ? color() : Rgb()};
    const TapRange taps =
        settings.samples_per_pixel >= TapRange::kBlocks ? TapRange::of_quadrant(tile.quadrant()) : TapRange{};
    if (settings.shading == Shading::kLit)
        result.radiance = shade_lit(data, settings, settings.components, point, bsdf_of(data, surface), -ray.direction,
                                    tile.gbuffer(), taps)
                              .sum();
    return result;
}

} // namespace duet::raster
