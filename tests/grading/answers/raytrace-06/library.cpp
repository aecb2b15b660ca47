// The library's reflect (common/vec/vec.h), refract (common/material/microfacet.h) and Fresnel terms
// (common/material/fresnel.h).
#include "common/material/fresnel.h"
#include "common/material/microfacet.h"
#include "raytrace/lessons/06-metal-and-glass/lab.h"

namespace duet::lab {

Vec3 mirror(Vec3 d, Vec3 n) { return reflect(-d, n); }

std::optional<Vec3> refract(Vec3 d, Vec3 n, float ratio) {
    const Vec3 wo = -normalize(d);
    const float relative = 1 / ratio, cos_o = dot(wo, n);
    if (cos2_refracted(cos_o, relative) <= 0) return std::nullopt;
    return duet::refract(wo, n, cos_o, relative);
}

float schlick(float cosine, float ior) { return fresnel_schlick(Rgb(fresnel_dielectric(1.0f, ior)), cosine).r; }

std::optional<Vec3> scatter_metal(Vec3 d, Vec3 n, float fuzz, Vec3 u) {
    const Vec3 direction = normalize(reflect(-d, n)) + u * fuzz;
    return dot(direction, n) > 0 ? std::optional(direction) : std::nullopt;
}

Vec3 scatter_glass(Vec3 d, Vec3 n, bool front, float ior, float choice) {
    const float ratio = front ? 1 / ior : ior;
    const auto bent = lab::refract(d, n, ratio);
    const float cosine = -dot(bent && ratio > 1 ? *bent : normalize(d), n);
    return bent && choice >= schlick(cosine, ior) ? *bent : reflect(-d, n);
}

} // namespace duet::lab
