#include "common/material/thin_dielectric.h"

#include "common/material/fresnel.h"

namespace duet {

ThinDielectricBsdf::Fractions ThinDielectricBsdf::fractions(float cosine) const {
    const float f = fresnel_dielectric(cosine, eta), cos_t = safe_sqrt(cos2_refracted(cosine, eta));
    const float through = 1 - f;
    Fractions result;
    for (std::size_t c = 0; c < 3; ++c) {
        const float t = tint[c] < 1 ? std::pow(tint[c], 1 / max(cos_t, 1e-4f)) : 1.0f;
        // The denominator is (1 − F t)(1 + F t), with 1 − F t written as (1 − F) + F (1 − t), which does not
        // cancel at grazing angles.
        const float rest = (through + f * (1 - t)) * (1 + f * t);
        result.transmitted[c] = rest > 0 ? through * through * t / rest : 0;
        result.reflected[c] = rest > 0 ? f + through * through * f * t * t / rest : f;
    }
    return result;
}

std::optional<BsdfSample> ThinDielectricBsdf::sample(Vec3 wo, float lobe, Vec2, TransportMode) const {
    if (wo.z == 0) return std::nullopt;
    const Fractions p = fractions(abs_cos_theta(wo));
    const float r = average(p.reflected), t = average(p.transmitted);
    if (!(r + t > 0)) return std::nullopt; // a black tint, and the index of the surroundings
    const float reflected = r / (r + t);
    if (lobe < reflected) return BsdfSample{{-wo.x, -wo.y, wo.z}, p.reflected / reflected, reflected, true};
    const float through = t / (r + t); // 1 − reflected would cancel at grazing angles
    return BsdfSample{{-wo.x, -wo.y, -wo.z}, p.transmitted / through, through, true, true};
}

} // namespace duet
