#include "common/material/metal.h"

#include "common/material/fresnel.h"
#include "common/material/ggx.h"
#include "common/material/reflectance.h"

namespace duet {

namespace {

/// Both sides of the surface are alike: the formulas see them from above.
Vec3 upwards(Vec3 w) { return {w.x, w.y, abs(w.z)}; }

/// The microfacet normal that reflects wo into wi. Both lie strictly above the surface, so the sum has z > 0.
Vec3 half_vector(Vec3 wo, Vec3 wi) { return normalize(wo + wi); }

} // namespace

Rgb MetalBsdf::eval(Vec3 wo, Vec3 wi, TransportMode) const {
    if (smooth() || !same_hemisphere(wo, wi)) return Rgb();
    wo = upwards(wo);
    wi = upwards(wi);
    const Vec3 h = half_vector(wo, wi);
    // F D G₂ / (4 cos θₒ cos θᵢ) (Walter et al. 2007, eq. 20)
    return fresnel_schlick(reflectance, dot(wo, h)) * (ggx_d(h, alpha) * ggx_visibility(wo, wi, alpha));
}

std::optional<BsdfSample> MetalBsdf::sample(Vec3 wo, float, Vec2 u, TransportMode) const {
    if (wo.z == 0) return std::nullopt;
    if (smooth()) return BsdfSample{{-wo.x, -wo.y, wo.z}, fresnel_schlick(reflectance, abs_cos_theta(wo)), 1, true};

    const Vec3 above = upwards(wo);
    const Vec3 wi = normalize(reflect(above, ggx_sample_visible_normal(above, alpha, u)));
    // A visible normal may reflect below the surface: there the light would hit a second microfacet. That light is left
    // out, as in all single-scattering models, and the density integrates to less than 1 by as much.
    if (!(wi.z > 0)) return std::nullopt;
    // The normal is taken from the rounded wi again, so that density and weight are those of the very direction
    // returned.
    const Vec3 h = half_vector(above, wi);
    const Rgb weight = fresnel_schlick(reflectance, dot(above, h)) * ggx_g2_over_g1(above, wi, alpha);
    return BsdfSample{{wi.x, wi.y, wo.z < 0 ? -wi.z : wi.z}, weight, ggx_reflection_pdf(above, h, alpha)};
}

float MetalBsdf::pdf(Vec3 wo, Vec3 wi, TransportMode) const {
    if (smooth() || !same_hemisphere(wo, wi)) return 0;
    wo = upwards(wo);
    return ggx_reflection_pdf(wo, half_vector(wo, upwards(wi)), alpha);
}

MetalBsdf Metal::at(const TextureSet& textures, const SurfacePoint& point) const {
    return {evaluate_reflectance(textures, reflectance, point), roughness * roughness};
}

} // namespace duet
