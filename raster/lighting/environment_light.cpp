#include "raster/lighting/environment_light.h"

#include "raster/screen_space/occlusion_image.h"

#include <cmath>

namespace duet::raster {

bool shows_environment(const RasterSceneData& data, const RasterSettings& settings) {
    return settings.environment && (data.scene.needs.environment || !settings.skips.environment);
}

std::optional<Rgb> constant_background(const RasterSceneData& data, const RasterSettings& settings) {
    if (settings.shading != Shading::kLit || !settings.components.emission || !shows_environment(data, settings))
        return Rgb();
    const auto* constant = std::get_if<ConstantEnvironment>(&data.scene.environment);
    return constant != nullptr ? std::optional(constant->radiance) : std::nullopt;
}

namespace {

/// Returns the fraction of the environment that is unoccluded for a diffuse surface in a pixel.
SkyVisibility sky_visibility(const RasterSettings& settings, const ScreenGBuffer* gbuffer, const ShadingPoint& point) {
    if (gbuffer == nullptr || gbuffer->occlusion() == nullptr || settings.ambient_occlusion == AmbientOcclusion::kNone)
        return {};
    const Vec3 p = gbuffer->to_eye_relative(point.surface.p), map_position = gbuffer->project(p);
    if (!(map_position.z > 0)) return {};
    const auto [x, y] = gbuffer->pixel_at(map_position);
    return gbuffer->occlusion()->at(x, y, p, point.ns);
}

} // namespace

template <typename BsdfType>
Rgb EnvironmentLight::sample_environment(const BsdfType& bsdf, bool transmitted, float alpha) const {
    // TransportMode::kImportance omits the factor η² of radiance inside the medium, which cancels on leaving it.
    const float lobe = transmitted ? kOneMinusEpsilon : 0.0f;
    const auto sample = bsdf.sample(point_.wo, lobe, {0.5f, 0.5f}, TransportMode::kImportance);
    if (!sample || sample->transmitted != transmitted) return {};
    const Vec3 wi = point_.frame.to_world(sample->wi);
    if (point_.receives(wi) == transmitted) return {}; // the geometric and the shading normal disagree
    const Rgb crossings = transmitted ? sample->weight * sample->weight : sample->weight;
    const Vec3 direction = normalize(wi);
    const Rgb light = alpha > 0 ? prefiltered_->at(data_.scene.environment, direction, alpha)
                                : radiance(data_.scene.environment, direction);
    return light * crossings * sample->pdf;
}

Rgb EnvironmentLight::incident_irradiance() const {
    return data_.irradiance.at(data_.scene.environment, point_.ns, sky_visibility(settings_, gbuffer_, point_));
}

Vec3 EnvironmentLight::mirror_direction() const {
    return point_.frame.to_world({-point_.wo.x, -point_.wo.y, point_.wo.z});
}

Rgb EnvironmentLight::operator()(const DiffuseBsdf& bsdf) const {
    if (is_black(bsdf.albedo)) return {};
    return bsdf.albedo * kInvPi * incident_irradiance();
}

Rgb EnvironmentLight::operator()(const MetalBsdf& bsdf) const {
    if (bsdf.smooth() || prefiltered_ == nullptr) return sample_environment(MetalBsdf{bsdf.reflectance, 0}, false);
    const Vec3 axis = Prefiltered::axis(point_.ns, mirror_direction(), bsdf.alpha);
    return prefiltered_->at(data_.scene.environment, axis, bsdf.alpha) * bsdf.directional_albedo(std::abs(point_.wo.z));
}

Rgb EnvironmentLight::operator()(const RoughDiffuseBsdf& bsdf) const {
    return bsdf.directional_albedo(std::abs(point_.wo.z)) * kInvPi * incident_irradiance();
}

Rgb EnvironmentLight::operator()(const DielectricBsdf& bsdf) const {
    Rgb sum;
    for (const bool transmitted : {false, true}) sum += sample_environment(bsdf, transmitted);
    return sum;
}

Rgb EnvironmentLight::operator()(const RoughDielectricBsdf& bsdf) const {
    const DielectricBsdf smooth{bsdf.eta, bsdf.tint};
    if (prefiltered_ == nullptr) return (*this)(smooth);
    Rgb sum;
    for (const bool transmitted : {false, true}) sum += sample_environment(smooth, transmitted, bsdf.alpha);
    return sum;
}

Rgb EnvironmentLight::operator()(const ThinDielectricBsdf& bsdf) const {
    const ThinDielectricBsdf::Fractions fractions = bsdf.fractions(std::abs(point_.wo.z));
    Rgb sum = radiance(data_.scene.environment, normalize(point_.frame.to_world(-point_.wo))) * fractions.transmitted;
    if (point_.receives(mirror_direction()))
        sum += radiance(data_.scene.environment, normalize(mirror_direction())) * fractions.reflected;
    return sum;
}

} // namespace duet::raster
