#include "raster/shade.h"

#include "raster/direct.h"
#include "raster/split.h"

namespace duet::raster {
namespace {

bool shows_environment(const PreparedData& data, const Settings& settings) {
    return settings.environment && (data.scene.needs.environment || !settings.skips.environment);
}

/// Light from the environment, which nothing is taken to occlude.
class EnvironmentLight {
public:
    EnvironmentLight(const PreparedData& data, const ShadingPoint& point) : data_(data), point_(point) {}

    Rgb operator()(const DiffuseBsdf& bsdf) const {
        return bsdf.albedo * kInvPi * data_.irradiance.at(data_.scene.environment, point_.ns);
    }
    /// What a smooth metal reflects, also for a rough one.
    Rgb operator()(const MetalBsdf& bsdf) const { return look_up(MetalBsdf{bsdf.reflectance, 0}, false); }
    /// The mirror image, and what is seen through this side of the glass alone: refracted once, tinted as by two
    /// crossings; weighed by Fresnel's equations.
    Rgb operator()(const DielectricBsdf& bsdf) const {
        Rgb sum;
        for (const bool transmitted : {false, true}) sum += look_up(bsdf, transmitted);
        return sum;
    }

private:
    template <typename BsdfType> Rgb look_up(const BsdfType& bsdf, bool transmitted) const {
        // Importance leaves out the factor η² of radiance inside the medium, which the way out takes back.
        const float lobe = transmitted ? kOneMinusEpsilon : 0.0f;
        const auto sample = bsdf.sample(point_.wo, lobe, {0.5f, 0.5f}, TransportMode::kImportance);
        if (!sample || sample->transmitted != transmitted) return {};
        const Vec3 wi = point_.frame.to_world(sample->wi);
        if (point_.receives(wi) == transmitted) return {}; // the two normals disagree
        const Rgb crossings = transmitted ? sample->weight * sample->weight : sample->weight;
        return radiance(data_.scene.environment, normalize(wi)) * crossings * sample->pdf;
    }

    const PreparedData& data_;
    const ShadingPoint& point_;
};

struct DirectLight {
    std::span<const Light> lights;
    const ShadingPoint& point;

    Rgb operator()(const DiffuseBsdf& bsdf) const { return direct_light(lights, bsdf, point); }
    Rgb operator()(const MetalBsdf& bsdf) const { return direct_light(lights, bsdf, point); }
    Rgb operator()(const DielectricBsdf&) const { return {}; }
};

LightParts lit(const PreparedData& data, const Settings& settings, const ShadingPoint& point, const Bsdf& bsdf,
               Vec3 to_viewer) {
    const Scene& scene = data.scene;
    const PartSet& asked = settings.parts;
    LightParts parts;
    if (asked.emission) parts.emission = emitted(scene.materials[point.surface.material], scene.textures, point.surface, to_viewer);
    if (asked.direct) parts.direct = std::visit(DirectLight{scene.lights, point}, bsdf);
    const bool diffuse = std::holds_alternative<DiffuseBsdf>(bsdf);
    if (shows_environment(data, settings) && (diffuse ? asked.environment : asked.reflection))
        (diffuse ? parts.environment : parts.reflection) = std::visit(EnvironmentLight(data, point), bsdf);
    return parts;
}

Bsdf bsdf_of(const PreparedData& data, const SurfacePoint& surface) {
    return bsdf_at(data.scene.materials[surface.material], data.scene.textures, surface);
}

Rgb background(const PreparedData& data, const Settings& settings, const Ray& ray) {
    if (const std::optional<Rgb> everywhere = constant_background(data, settings)) return *everywhere;
    return radiance(data.scene.environment, ray.direction);
}

} // namespace

std::optional<Rgb> constant_background(const PreparedData& data, const Settings& settings) {
    if (settings.shading != Shading::kLit || !settings.parts.emission || !shows_environment(data, settings))
        return Rgb();
    const auto* constant = std::get_if<ConstantEnvironment>(&data.scene.environment);
    return constant != nullptr ? std::optional(constant->radiance) : std::nullopt;
}

LightParts shade_surface(const Prepared& prepared, const Settings& settings, const SurfacePoint& surface,
                         const Bsdf& bsdf, Vec3 to_viewer) {
    return lit(prepared.data(), settings, ShadingPoint(surface, to_viewer), bsdf, to_viewer);
}

LightParts shade_hit(const Prepared& prepared, const Settings& settings, const Ray& ray, const Hit& hit,
                     const RayFootprint* footprint) {
    const PreparedData& data = prepared.data();
    if (!hit.valid())
        return {.emission = background(data, settings, ray), .direct = {}, .environment = {}, .reflection = {}};
    const SurfacePoint surface = surface_point(data.scene, ray, hit, footprint);
    return shade_surface(prepared, settings, surface, bsdf_of(data, surface), -ray.direction);
}

Shaded shade(const PreparedData& data, const Settings& settings, const HitTile& tile, int x, int y) {
    const Ray& ray = tile.ray(x, y);
    const Hit& hit = tile.hit(x, y);
    if (!hit.valid()) return {.radiance = background(data, settings, ray), .normal = {}, .albedo = {}};
    const Scene& scene = data.scene;
    const RayFootprint footprint = scene.needs.footprints ? tile.footprint(x, y, settings.samples_per_pixel) : RayFootprint{};
    const SurfacePoint surface = surface_point(scene, ray, hit, &footprint);
    const ShadingPoint point(surface, -ray.direction);
    const auto color = [&] { return base_color(scene.materials[surface.material], scene.textures, surface); };
    Shaded result{.radiance = {}, .normal = point.ns, .albedo = settings.aovs.albedo ? color() : Rgb()};
    if (settings.shading == Shading::kLit)
        result.radiance = lit(data, settings, point, bsdf_of(data, surface), -ray.direction).sum();
    return result;
}

} // namespace duet::raster
