#include "common/material/metal.h"

#include "common/material/fresnel.h"
#include "common/material/ggx.h"
#include "common/material/reflectance.h"

namespace duet {

namespace {

/// Both sides of the surface are alike: the formulas see them from above.
Vec3 upwards(Vec3 w) { return {w.x, w.y, abs(w.z)}; }

/// The microfacet that reflects wo into wi. Both lie strictly above the surface, so their sum has z > 0.
struct Microfacet {
    Vec3 normal;
    float
        cosine; ///< wo·h = wi·h = |wo + wi|/2: the dot products differ where rounding left wo and wi of unequal length
};
Microfacet microfacet(Vec3 wo, Vec3 wi) {
    const Vec3 sum = wo + wi;
    const float size = length(sum);
    return {sum / size, 0.5f * size};
}

} // namespace

Rgb MetalBsdf::eval(Vec3 wo, Vec3 wi, TransportMode) const {
    if (smooth() || !same_hemisphere(wo, wi)) return Rgb();
    wo = upwards(wo);
    wi = upwards(wi);
    const Microfacet h = microfacet(wo, wi);
    // F D G₂ / (4 cos θₒ cos θᵢ) (Walter et al. 2007, eq. 20)
    return fresnel_schlick(reflectance, h.cosine) * (ggx_d(h.normal, alpha) * ggx_visibility(wo, wi, alpha));
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
    const Microfacet h = microfacet(above, wi);
    const Rgb weight = fresnel_schlick(reflectance, h.cosine) * ggx_g2_over_g1(above, wi, alpha);
    return BsdfSample{{wi.x, wi.y, wo.z < 0 ? -wi.z : wi.z}, weight, ggx_reflection_pdf(above, h.normal, alpha)};
}

float MetalBsdf::pdf(Vec3 wo, Vec3 wi, TransportMode) const {
    if (smooth() || !same_hemisphere(wo, wi)) return 0;
    wo = upwards(wo);
    return ggx_reflection_pdf(wo, microfacet(wo, upwards(wi)).normal, alpha);
}

MetalBsdf Metal::at(const TextureSet& textures, const SurfacePoint& point) const {
    return {evaluate_reflectance(textures, reflectance, point),
            sqr(clamp(evaluate(textures, roughness, point), 0.0f, 1.0f))};
}

} // namespace duet
