#include "common/material/diffuse.h"

#include "common/material/reflectance.h"
#include "common/sampling/warp.h"

namespace duet {

Rgb DiffuseBsdf::eval(Vec3 wo, Vec3 wi, TransportMode) const {
    return same_hemisphere(wo, wi) ? albedo * kInvPi : Rgb();
}

std::optional<BsdfSample> DiffuseBsdf::sample(Vec3 wo, float, Vec2 u, TransportMode) const {
    if (wo.z == 0) return std::nullopt;
    Vec3 wi = cosine_hemisphere(u);
    const float density = cosine_hemisphere_pdf(wi.z);
    if (wo.z < 0) wi.z = -wi.z;
    return BsdfSample{wi, albedo, density}; // (albedo / π)·cos / (cos / π)
}

float DiffuseBsdf::pdf(Vec3 wo, Vec3 wi, TransportMode) const {
    return same_hemisphere(wo, wi) ? cosine_hemisphere_pdf(abs_cos_theta(wi)) : 0.0f;
}

DiffuseBsdf Diffuse::at(const TextureSet& textures, const SurfacePoint& point) const {
    return {evaluate_reflectance(textures, albedo, point)};
}

} // namespace duet
