#include "raster/light/environment_light.h"

#include "raster/screen/occlusion_image.h"

#include <cmath>

namespace duet::raster {

bool shows_environment(const PreparedData& data, const Settings& settings) {
    return settings.environment && (data.scene.needs.environment || !settings.skips.environment);
}

std::optional<Rgb> constant_background(const PreparedData& data, const Settings& settings) {
    if (settings.shading != Shading::kLit || !settings.parts.emission || !shows_environment(data, settings))
        return Rgb();
    const auto* constant = std::get_if<ConstantEnvironment>(&data.scene.environment);
    return constant != nullptr ? std::optional(constant->radiance) : std::nullopt;
}

namespace {

/// Returns the fraction of the environment that is unoccluded for a diffuse surface in a pixel.
SkySeen sky_seen(const Settings& settings, const Screen* screen, const ShadingPoint& point) {
    if (screen == nullptr || screen->occlusion() == nullptr || settings.ambient_occlusion == AmbientOcclusion::kNone)
        return {};
    const Vec3 p = screen->relative(point.surface.p), place = screen->project(p);
    if (!(place.z > 0)) return {};
    const auto [x, y] = screen->pixel_at(place);
    return screen->occlusion()->at(x, y, p, point.ns);
}

} // namespace

template <typename BsdfType> Rgb EnvironmentLight::look_up(const BsdfType& bsdf, bool transmitted, float alpha) const {
    // TransportMode::kImportance omits the factor η² of radiance inside the medium, which cancels on leaving it.
    const float lobe = transmitted ? kOneMinusEpsilon : 0.0f;
    const auto sample = bsdf.sample(point_.wo, lobe, {0.5f, 0.5f}, TransportMode::kImportance);
    if (!sample || sample->transmitted != transmitted) return {};
    const Vec3 wi = point_.frame.to_world(sample->wi);
    if (point_.receives(wi) == transmitted) return {}; // the geometric and the shading normal disagree
    const Rgb crossings = transmitted ? sample->weight * sample->weight : sample->weight;
    const Vec3 way = normalize(wi);
    const Rgb light = alpha > 0 ? prefiltered_->at(data_.scene.environment, way, alpha)
                                : radiance(data_.scene.environment, way);
    return light * crossings * sample->pdf;
}

Rgb EnvironmentLight::received() const {
    return data_.irradiance.at(data_.scene.environment, point_.ns, sky_seen(settings_, screen_, point_));
}

Vec3 EnvironmentLight::mirrored() const { return point_.frame.to_world({-point_.wo.x, -point_.wo.y, point_.wo.z}); }

Rgb EnvironmentLight::operator()(const DiffuseBsdf& bsdf) const {
    if (is_black(bsdf.albedo)) return {};
    return bsdf.albedo * kInvPi * received();
}

Rgb EnvironmentLight::operator()(const MetalBsdf& bsdf) const {
    if (bsdf.smooth() || prefiltered_ == nullptr) return look_up(MetalBsdf{bsdf.reflectance, 0}, false);
    const Vec3 axis = Prefiltered::axis(point_.ns, mirrored(), bsdf.alpha);
    return prefiltered_->at(data_.scene.environment, axis, bsdf.alpha) * bsdf.albedo(std::abs(point_.wo.z));
}

Rgb EnvironmentLight::operator()(const RoughDiffuseBsdf& bsdf) const {
    return bsdf.reflected(std::abs(point_.wo.z)) * kInvPi * received();
}

Rgb EnvironmentLight::operator()(const DielectricBsdf& bsdf) const {
    Rgb sum;
    for (const bool transmitted : {false, true}) sum += look_up(bsdf, transmitted);
    return sum;
}

Rgb EnvironmentLight::operator()(const RoughDielectricBsdf& bsdf) const {
    const DielectricBsdf smooth{bsdf.eta, bsdf.tint};
    if (prefiltered_ == nullptr) return (*this)(smooth);
    Rgb sum;
    for (const bool transmitted : {false, true}) sum += look_up(smooth, transmitted, bsdf.alpha);
    return sum;
}

Rgb EnvironmentLight::operator()(const ThinDielectricBsdf& bsdf) const {
    const ThinDielectricBsdf::Parts parts = bsdf.parts(std::abs(point_.wo.z));
    Rgb sum = radiance(data_.scene.environment, normalize(point_.frame.to_world(-point_.wo))) * parts.transmitted;
    if (point_.receives(mirrored())) sum += radiance(data_.scene.environment, normalize(mirrored())) * parts.reflected;
    return sum;
}

} // namespace duet::raster
