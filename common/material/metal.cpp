#include "common/material/metal.h"

#include "common/material/fresnel.h"
#include "common/material/ggx.h"
#include "common/material/ggx_albedo.h"
#include "common/material/microfacet.h"
#include "common/material/reflectance.h"
#include "common/sampling/warp.h"

namespace duet {

MetalBsdf::MetalBsdf(Rgb reflectance_, float alpha_) : reflectance(reflectance_), alpha(alpha_) {
    if (!smooth()) multiple = ggx_multiple(schlick_average(reflectance), ggx_means(alpha).lost);
}

MetalBsdf::MetalBsdf(const Conductor& conductor, float alpha_)
    : reflectance(conductor.normal), alpha(alpha_), n(conductor.n), k(conductor.k) {
    if (!smooth()) multiple = ggx_multiple(conductor.average, ggx_means(alpha).lost);
}

Rgb MetalBsdf::fresnel(float cosine) const {
    if (n.r == 0) return fresnel_schlick(reflectance, cosine);
    return {fresnel_conductor(cosine, n.r, k.r), fresnel_conductor(cosine, n.g, k.g),
            fresnel_conductor(cosine, n.b, k.b)};
}

Rgb MetalBsdf::albedo(float cosine) const {
    if (smooth()) return fresnel(cosine);
    const GgxAlbedo single = ggx_albedo(alpha, cosine);
    return single.of(reflectance) + multiple * ((1 - single.energy) * kPi * ggx_means(alpha).lost);
}

Rgb MetalBsdf::eval(Vec3 wo, Vec3 wi, TransportMode) const {
    if (smooth() || !same_hemisphere(wo, wi)) return Rgb();
    wo = upwards(wo);
    wi = upwards(wi);
    const Microfacet h = microfacet(wo, wi);
    return fresnel(h.cosine) * ggx_reflection(wo, wi, h.normal, alpha) +
           multiple * (ggx_lost(alpha, wo.z) * ggx_lost(alpha, wi.z));
}

std::optional<BsdfSample> MetalBsdf::sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const {
    if (wo.z == 0) return std::nullopt;
    if (smooth()) return BsdfSample{{-wo.x, -wo.y, wo.z}, fresnel(abs_cos_theta(wo)), 1, true};

    const Vec3 above = upwards(wo);
    const bool several = !is_black(multiple) && lobe >= 1 - ggx_lost(alpha, above.z);
    Vec3 wi = several ? cosine_hemisphere(u) : normalize(reflect(above, ggx_sample_visible_normal(above, alpha, u)));
    // A visible normal may reflect wo below the surface, where the light would hit a second microfacet. Such samples
    // are dropped, so the density integrates to slightly less than 1.
    if (!(wi.z > 0)) return std::nullopt;
    if (wo.z < 0) wi.z = -wi.z;
    return sample_of(*this, wo, wi, mode);
}

float MetalBsdf::pdf(Vec3 wo, Vec3 wi, TransportMode) const {
    if (smooth() || !same_hemisphere(wo, wi)) return 0;
    wo = upwards(wo);
    wi = upwards(wi);
    const float several = is_black(multiple) ? 0 : ggx_lost(alpha, wo.z);
    return ggx_reflections_pdf(wo, wi, microfacet(wo, wi).normal, alpha, several);
}

MetalBsdf Metal::at(const TextureSet& textures, const SurfacePoint& point) const {
    const float alpha = sqr(evaluate_unit(textures, roughness, point));
    return conductor.exists() ? MetalBsdf(conductor, alpha)
                              : MetalBsdf(evaluate_reflectance(textures, reflectance, point), alpha);
}

} // namespace duet
