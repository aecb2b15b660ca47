#include "common/material/dielectric.h"

#include "common/material/fresnel.h"
#include "common/material/microfacet.h"
#include "common/material/reflectance.h"

namespace duet {

Rgb DielectricBsdf::eval(Vec3, Vec3, TransportMode) const { return Rgb(); }
float DielectricBsdf::pdf(Vec3, Vec3, TransportMode) const { return 0; }

std::optional<BsdfSample> DielectricBsdf::sample(Vec3 wo, float lobe, Vec2, TransportMode mode) const {
    if (wo.z == 0) return std::nullopt;
    const float cos_o = abs_cos_theta(wo);
    const float relative = wo.z > 0 ? eta : 1 / eta; // index beyond the boundary over the index on wo's side
    const float reflected = fresnel_dielectric(cos_o, relative);
    if (lobe < reflected) return BsdfSample{{-wo.x, -wo.y, wo.z}, Rgb(1.0f), reflected, true};

    const float cos_t = safe_sqrt(cos2_refracted(cos_o, relative)); // not total reflection, for which `reflected` is 1
    if (cos_t == 0) return std::nullopt;
    // L / n² is constant along a refracted ray: radiance that enters the thinner medium spreads over a larger solid
    // angle.
    const float spread = mode == TransportMode::kRadiance ? 1 / (relative * relative) : 1.0f;
    return BsdfSample{refract(wo, cos_t, relative), tint * spread, 1 - reflected, true, true};
}

DielectricBsdf Dielectric::at(const TextureSet& textures, const SurfacePoint& point) const {
    return {ior, evaluate_reflectance(textures, tint, point)};
}

ThinDielectricBsdf Dielectric::thin_at(const TextureSet& textures, const SurfacePoint& point) const {
    return {ior, evaluate_reflectance(textures, tint, point)};
}

RoughDielectricBsdf Dielectric::rough_at(const TextureSet& textures, const SurfacePoint& point) const {
    return {ior, evaluate_reflectance(textures, tint, point), sqr(evaluate_unit(textures, roughness, point))};
}

} // namespace duet
