#include "common/material/rough_diffuse.h"

#include "common/material/microfacet.h"
#include "common/sampling/warp.h"

namespace duet {

namespace {

/// Returns the directional albedo of single scattering for facets of albedo 1 (Portsmouth et al. 2024, eq. 14 to 17).
/// mean_single_albedo below is its hemispherical mean.
float single_albedo(float cosine, float roughness) {
    const float a = 1 / (1 + (0.5f - 2 * kInvPi / 3) * roughness);
    const float sine = safe_sqrt((1 - cosine) * (1 + cosine));
    // The term (2/3)(tan·(1 − sin³) − sin) is rewritten as a product without the tangent:
    // (1 − sin³)/cos = cos (1 + sin + sin²)/(1 + sin).
    const float bend = sine * (cosine * (1 + sine + sine * sine) / (1 + sine) - 1);
    const float g = sine * (std::acos(min(cosine, 1.0f)) - sine * cosine) + 2.0f / 3 * bend;
    return a * (1 + roughness * kInvPi * g);
}
float mean_single_albedo(float roughness) {
    return (1 + (2.0f / 3 - 28 * kInvPi / 15) * roughness) / (1 + (0.5f - 2 * kInvPi / 3) * roughness);
}

/// Returns the fraction, per channel, of multiply scattered light that survives absorption (Portsmouth et al. 2024,
/// eq. 24).
Rgb surviving(Rgb albedo, float mean) {
    const auto channel = [mean](float x) { return x * x * mean / (1 - x * (1 - mean)); };
    return {channel(albedo.r), channel(albedo.g), channel(albedo.b)};
}

/// Returns the probability of drawing from the uniform distribution, which bounds the weight of retroreflection at
/// grazing angles.
float uniform_probability(float cosine, float roughness) { return roughness * (0.1f + 0.3f * (1 - cosine)); }

} // namespace

Rgb RoughDiffuseBsdf::eval(Vec3 wo, Vec3 wi, TransportMode) const {
    if (!same_hemisphere(wo, wi)) return Rgb();
    wo = to_upper_hemisphere(wo);
    wi = to_upper_hemisphere(wi);
    const float s = wo.x * wi.x + wo.y * wi.y, a = 1 / (1 + (0.5f - 2 * kInvPi / 3) * roughness);
    const float s_over_t = s > 0 ? s / max(wo.z, wi.z) : s;
    const float mean = mean_single_albedo(roughness), mean_energy_loss = 1 - mean;
    const float energy_loss =
        max(1 - single_albedo(wo.z, roughness), 0.0f) * max(1 - single_albedo(wi.z, roughness), 0.0f);
    const Rgb single = albedo * max(a * (1 + roughness * s_over_t), 0.0f);
    if (!(mean_energy_loss > 0)) return single * kInvPi;
    return (single + surviving(albedo, mean) * (energy_loss / mean_energy_loss)) * kInvPi;
}

std::optional<BsdfSample> RoughDiffuseBsdf::sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const {
    if (wo.z == 0) return std::nullopt;
    const bool uniform = lobe < uniform_probability(abs_cos_theta(wo), roughness);
    Vec3 wi = uniform ? to_upper_hemisphere(uniform_sphere(u)) : cosine_hemisphere(u);
    if (!(wi.z > 0)) return std::nullopt;
    if (wo.z < 0) wi.z = -wi.z;
    return sample_of(*this, wo, wi, mode);
}

float RoughDiffuseBsdf::pdf(Vec3 wo, Vec3 wi, TransportMode) const {
    if (!same_hemisphere(wo, wi)) return 0;
    return lerp(cosine_hemisphere_pdf(abs_cos_theta(wi)), 0.5f * kInvPi,
                uniform_probability(abs_cos_theta(wo), roughness));
}

Rgb RoughDiffuseBsdf::directional_albedo(float cosine) const {
    const float single = single_albedo(cosine, roughness);
    return albedo * single + surviving(albedo, mean_single_albedo(roughness)) * (1 - single);
}

} // namespace duet
