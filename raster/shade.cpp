#include "raster/shade.h"

#include "raster/direct.h"
#include "raster/ggx_table.h"
#include "raster/glass.h"
#include "raster/occlusion_image.h"
#include "raster/prefiltered.h"
#include "raster/screen.h"
#include "raster/screen_reflection.h"
#include "raster/shadows.h"
#include "raster/split.h"
#include "raster/surroundings.h"

#include "common/sampling/sobol.h"
#include "common/scene/used_materials.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// GGX alpha up to which metal mirrors what the picture shows (roughness 0.55): of rougher metal the few rays are so far apart
/// that each shows on a smooth surface where it goes from one thing to the next.
constexpr float kRoughestMirror = 0.3f;
constexpr int kMirrorRays = 8; ///< of a pixel of rough metal

bool shows_environment(const PreparedData& data, const Settings& settings) {
    return settings.environment && (data.scene.needs.environment || !settings.skips.environment);
}

/// What a diffuse surface in a pixel sees of the environment.
SkySeen sky_seen(const Settings& settings, const Screen* screen, const ShadingPoint& point) {
    if (screen == nullptr || screen->occlusion() == nullptr || settings.ambient_occlusion == AmbientOcclusion::kNone) return {};
    const Vec3 p = screen->relative(point.surface.p), place = screen->project(p);
    if (!(place.z > 0)) return {};
    const auto [x, y] = screen->pixel_at(place);
    return screen->occlusion()->at(x, y, p, point.ns);
}

/// Light from the environment, occluded as far as that is known.
class EnvironmentLight {
public:
    EnvironmentLight(const PreparedData& data, const Settings& settings, const ShadingPoint& point, const Screen* screen)
        : data_(data), settings_(settings), prefiltered_(settings.prefiltered_environment ? data.prefiltered.get() : nullptr),
          point_(point), screen_(screen) {}

    Rgb operator()(const DiffuseBsdf& bsdf) const {
        if (is_black(bsdf.albedo)) return {};
        return bsdf.albedo * kInvPi * received();
    }
    /// Of a rough one by the split sum; else what a smooth metal reflects.
    Rgb operator()(const MetalBsdf& bsdf) const {
        if (bsdf.smooth() || prefiltered_ == nullptr) return look_up(MetalBsdf{bsdf.reflectance, 0}, false);
        const Vec3 axis = Prefiltered::axis(point_.ns, mirrored(), bsdf.alpha);
        return prefiltered_->at(data_.scene.environment, axis, bsdf.alpha) * bsdf.albedo(std::abs(point_.wo.z));
    }
    Rgb operator()(const RoughDiffuseBsdf& bsdf) const {
        return bsdf.reflected(std::abs(point_.wo.z)) * kInvPi * received();
    }
    /// The mirror image, and what is seen through this side of the glass alone: refracted once, tinted as by two
    /// crossings; weighed by Fresnel's equations.
    Rgb operator()(const DielectricBsdf& bsdf) const {
        Rgb sum;
        for (const bool transmitted : {false, true}) sum += look_up(bsdf, transmitted);
        return sum;
    }

    /// The same, blurred.
    Rgb operator()(const RoughDielectricBsdf& bsdf) const {
        const DielectricBsdf smooth{bsdf.eta, bsdf.tint};
        if (prefiltered_ == nullptr) return (*this)(smooth);
        Rgb sum;
        for (const bool transmitted : {false, true}) sum += look_up(smooth, transmitted, bsdf.alpha);
        return sum;
    }
    /// The mirror image, and what is straight behind.
    Rgb operator()(const ThinDielectricBsdf& bsdf) const {
        const ThinDielectricBsdf::Parts parts = bsdf.parts(std::abs(point_.wo.z));
        Rgb sum = radiance(data_.scene.environment, normalize(point_.frame.to_world(-point_.wo))) * parts.transmitted;
        if (point_.receives(mirrored())) sum += radiance(data_.scene.environment, normalize(mirrored())) * parts.reflected;
        return sum;
    }
    Rgb operator()(const LayeredBsdf&) const { return {}; } // its layers are shaded each by itself

private:
    /// What arrives at a diffuse surface.
    Rgb received() const {
        return data_.irradiance.at(data_.scene.environment, point_.ns, sky_seen(settings_, screen_, point_));
    }
    Vec3 mirrored() const { return point_.frame.to_world({-point_.wo.x, -point_.wo.y, point_.wo.z}); }

    template <typename BsdfType> Rgb look_up(const BsdfType& bsdf, bool transmitted, float alpha = 0) const {
        // Importance leaves out the factor η² of radiance inside the medium, which the way out takes back.
        const float lobe = transmitted ? kOneMinusEpsilon : 0.0f;
        const auto sample = bsdf.sample(point_.wo, lobe, {0.5f, 0.5f}, TransportMode::kImportance);
        if (!sample || sample->transmitted != transmitted) return {};
        const Vec3 wi = point_.frame.to_world(sample->wi);
        if (point_.receives(wi) == transmitted) return {}; // the two normals disagree
        const Rgb crossings = transmitted ? sample->weight * sample->weight : sample->weight;
        const Vec3 way = normalize(wi);
        const Rgb light = alpha > 0 ? prefiltered_->at(data_.scene.environment, way, alpha) : radiance(data_.scene.environment, way);
        return light * crossings * sample->pdf;
    }

    const PreparedData& data_;
    const Settings& settings_;
    const Prefiltered* prefiltered_;
    const ShadingPoint& point_;
    const Screen* screen_;
};

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
    /// What shines on its outside is mirrored as by a metal of the same reflectance.
    Direct operator()(const RoughDielectricBsdf& bsdf) const {
        const MetalBsdf surface{Rgb(sqr((bsdf.eta - 1) / (bsdf.eta + 1))), bsdf.alpha};
        return direct_light(lights, surface, point, visibility, transformed_cosines);
    }
    Direct operator()(const DielectricBsdf&) const { return {}; }
    Direct operator()(const ThinDielectricBsdf&) const { return {}; }
    Direct operator()(const LayeredBsdf&) const { return {}; } // its layers are shaded each by itself
};

/// Ray number i of kMirrorRays from a rough metal: a (0,2)-net, of which each aligned part is one.
Vec2 mirror_ray(int i) { return net_point(static_cast<std::uint32_t>(i), kMirrorRays); }

/// What a smooth or not too rough metal mirrors, in directions of its lobe: the same few for every point, each as wide
/// as the part of the lobe that it stands for.
class Mirrored {
public:
    Mirrored(const PreparedData& data, const Settings& settings, const Screen& screen, const ShadingPoint& point, const MetalBsdf& bsdf)
        : around_(data, settings, {screen, nullptr, point.surface.object}), point_(point), bsdf_(bsdf),
          p_(screen.relative(point.surface.p)) {
        const Vec3 place = screen.project(p_);
        if (place.z > 0) {
            const auto [x, y] = screen.pixel_at(place);
            spread_ = 2 * screen.turn(x, y);
        }
        width_ = screen.pixel_size(max(place.z, screen.near()));
    }

    /// Of rough metal the lobe's mean, as the few rays find it, times all that the metal reflects: so that what they miss of
    /// the lobe, and what rays lose that come out beneath its horizon, is not lost.
    Rgb operator()(TapRange taps) const {
        if (bsdf_.smooth()) {
            const Sample ray = along({0.5f, 0.5f}, 1);
            return ray.seen * ray.weight;
        }
        const int share = TapRange().count / taps.count, count = kMirrorRays / share, first = taps.first * count / taps.count;
        Rgb sum, weights;
        for (int i = first; i < first + count; ++i) {
            const Sample ray = along(mirror_ray(i), kMirrorRays);
            sum += ray.seen * ray.weight, weights += ray.weight;
        }
        const Rgb albedo = bsdf_.albedo(std::abs(point_.wo.z));
        for (std::size_t c = 0; c < 3; ++c) sum[c] = weights[c] > 0 ? sum[c] / weights[c] * albedo[c] : 0.0f;
        return sum;
    }

private:
    struct Sample {
        Rgb seen, weight;
    };

    Sample along(Vec2 u, int rays) const {
        const auto sample = bsdf_.sample(point_.wo, 0, u, TransportMode::kRadiance);
        if (!sample) return {};
        const Vec3 way = normalize(point_.frame.to_world(sample->wi));
        if (!point_.receives(way)) return {};
        const bool smooth = bsdf_.smooth();
        // A cone about the ray, in which there is one ray: of the solid angle 1/(rays · pdf).
        const float wide = smooth ? 0.0f : 2 * std::sqrt(kInvPi / (static_cast<float>(rays) * max(sample->pdf, 1e-6f)));
        return {around_.seen({.p = p_, .n = point_.ng, .way = way, .width = width_, .turn = spread_, .spread = wide,
                              .alpha = min(alpha_as_wide(wide), 1.0f), .lamps = smooth, .point = &point_}), sample->weight};
    }

    Surroundings around_;
    const ShadingPoint& point_;
    const MetalBsdf& bsdf_;
    Vec3 p_;
    float width_ = 0, spread_ = 0; ///< of a pixel; radians between its mirrored ray and the next one's
};

LightParts lit(const PreparedData& data, const Settings& settings, const PartSet& asked, const ShadingPoint& point,
               const Bsdf& bsdf, Vec3 to_viewer, const Screen* screen, TapRange taps);

/// Layers side by side, each by as much as a viewer at this angle sees of it. All that they reflect of the environment
/// counts as reflection, as in the path tracer's parts.
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
    if (asked.emission) parts.emission = emitted(scene.materials[point.surface.material], scene.textures, point.surface, to_viewer);
    if (asked.direct) {
        const Visibility visibility{settings.shadows ? data.shadows.get() : nullptr, taps};
        const Direct direct = std::visit(DirectLight{scene.lights, point, visibility, settings.transformed_cosines}, bsdf);
        parts.direct = direct.arriving, parts.shadowed = direct.shadowed;
    }
    const bool diffuse = is_diffuse(bsdf);
    if (shows_environment(data, settings) && (diffuse ? asked.environment : asked.reflection))
        (diffuse ? parts.environment : parts.reflection) = std::visit(EnvironmentLight(data, settings, point, screen), bsdf);
    const auto* metal = std::get_if<MetalBsdf>(&bsdf);
    if (metal != nullptr && asked.reflection && settings.screen_reflections && screen != nullptr &&
        !screen->first_look().radiance.empty() && metal->alpha <= kRoughestMirror)
        parts.reflection = Mirrored(data, settings, *screen, point, *metal)(taps);
    if (is_glass(data, point.surface.object) && asked.reflection && settings.screen_refractions && screen != nullptr &&
        screen->behind() != nullptr)
        parts.reflection = std::visit(SeenThrough(data, settings, *screen, point), bsdf);
    return parts;
}

/// Glass that absorbs is tinted as by the mean way through a ball that fills its object's box: 4/3 of the radius, which
/// is 0.385 of the box's diagonal; half of it at each crossing.
Rgb tint_by_absorption(const PreparedData& data, const Dielectric& glass, std::uint32_t object) {
    const float way = 0.385f / 2 * length(data.objects[object].bounds.diagonal());
    return {std::exp(-way * glass.absorption.r), std::exp(-way * glass.absorption.g), std::exp(-way * glass.absorption.b)};
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

bool needs_occlusion(const PreparedData& data, const Settings& settings) {
    const bool shown = settings.parts.environment || needs_screen_radiance(data, settings) || needs_screen_behind(data, settings);
    return settings.shading == Shading::kLit && settings.output != Output::kNearness &&
           settings.ambient_occlusion != AmbientOcclusion::kNone && shown && shows_environment(data, settings);
}

bool needs_screen(const PreparedData& data, const Settings& settings) {
    return needs_occlusion(data, settings) ||
           (settings.output != Output::kNearness && (needs_screen_radiance(data, settings) || needs_screen_behind(data, settings)));
}

void add_occlusion(const PreparedData& data, const Settings& settings, Screen& screen) {
    if (needs_occlusion(data, settings))
        screen.set_occlusion(std::make_shared<const OcclusionImage>(
            screen, settings.ambient_occlusion, static_cast<float>(occlusion_radius(data, settings)), settings.threads));
}

bool needs_screen_radiance(const PreparedData& data, const Settings& settings) {
    return settings.shading == Shading::kLit && settings.screen_reflections && settings.parts.reflection &&
           any_used_material(data.scene, may_mirror);
}

bool needs_screen_behind(const PreparedData& data, const Settings& settings) {
    return settings.shading == Shading::kLit && settings.screen_refractions && settings.parts.reflection && !data.glass.empty();
}

double occlusion_radius(const PreparedData& data, const Settings& settings) {
    if (settings.occlusion_radius > 0) return settings.occlusion_radius;
    const Camera& camera = data.scene.camera;
    return min(static_cast<double>(length(data.scene.bounds.diagonal())), length(camera.look_at - camera.eye)) /
           (settings.ambient_occlusion == AmbientOcclusion::kSsao ? 8 : 2); // a point in the hemisphere finds less far off
}

std::optional<Rgb> constant_background(const PreparedData& data, const Settings& settings) {
    if (settings.shading != Shading::kLit || !settings.parts.emission || !shows_environment(data, settings))
        return Rgb();
    const auto* constant = std::get_if<ConstantEnvironment>(&data.scene.environment);
    return constant != nullptr ? std::optional(constant->radiance) : std::nullopt;
}

bool may_mirror(const Material& material) {
    const auto mirrors = [](const ScalarSlot& roughness) { return !roughness.constant() || sqr(roughness.value) <= kRoughestMirror; };
    if (const auto* metal = std::get_if<Metal>(&material)) return mirrors(metal->roughness);
    if (const auto* coated = std::get_if<Coated>(&material)) return mirrors(coated->roughness);
    const auto* layers = std::get_if<Principled>(&material);
    return layers != nullptr && (mirrors(layers->roughness) || mirrors(layers->clearcoat_roughness));
}

bool is_mirror(const Material& material) {
    const auto* layers = std::get_if<Principled>(&material);
    const bool metal = layers != nullptr ? layers->metallic.constant() && layers->metallic.value == 1
                                         : std::holds_alternative<Metal>(material);
    return metal && may_mirror(material);
}

LightParts shade_surface(const Prepared& prepared, const Settings& settings, const SurfacePoint& surface,
                         const Bsdf& bsdf, Vec3 to_viewer, const Screen* screen) {
    return lit(prepared.data(), settings, settings.parts, ShadingPoint(surface, to_viewer), bsdf, to_viewer, screen, TapRange{});
}

LightParts shade_hit(const Prepared& prepared, const Settings& settings, const Ray& ray, const Hit& hit,
                     const RayFootprint* footprint, const Screen* screen) {
    const PreparedData& data = prepared.data();
    if (!hit.valid())
        return {.emission = background(data, settings, ray), .direct = {}, .environment = {}, .reflection = {}, .shadowed = {}};
    const SurfacePoint surface = surface_point(data.scene, ray, hit, footprint);
    return shade_surface(prepared, settings, surface, bsdf_of(data, surface), -ray.direction, screen);
}

Shaded shade(const PreparedData& data, const Settings& settings, const HitTile& tile, int x, int y) {
    const Ray& ray = tile.ray(x, y);
    const Hit& hit = tile.hit(x, y);
    if (!hit.valid()) return {.radiance = background(data, settings, ray), .normal = {}, .albedo = {}};
    const Scene& scene = data.scene;
    const RayFootprint footprint = scene.needs.footprints ? tile.footprint(x, y, settings.samples_per_pixel) : RayFootprint{};
    const std::uint32_t material = material_index(scene, hit.object, hit.primitive);
    const SurfacePoint surface = surface_point(scene, ray, hit, &footprint, surface_detail(scene, material));
    const ShadingPoint point(surface, -ray.direction);
    const auto color = [&] { return base_color(scene.materials[surface.material], scene.textures, surface); };
    Shaded result{.radiance = {}, .normal = point.ns, .albedo = settings.aovs.albedo ? color() : Rgb()};
    const TapRange taps = settings.samples_per_pixel >= TapRange::kBlocks ? TapRange::of_quadrant(tile.quadrant()) : TapRange{};
    if (settings.shading == Shading::kLit)
        result.radiance = lit(data, settings, settings.parts, point, bsdf_of(data, surface), -ray.direction, tile.screen(), taps).sum();
    return result;
}

} // namespace duet::raster
