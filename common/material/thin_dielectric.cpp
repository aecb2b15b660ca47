#include "common/material/thin_dielectric.h"

#include "common/material/fresnel.h"

namespace duet {

ThinDielectricBsdf::Fractions ThinDielectricBsdf::fractions(float cosine) const {
    const float f = fresnel_dielectric(cosine, eta), cos_t = safe_sqrt(cos2_refracted(cosine, eta));
    Fractions result;
    for (std::size_t c = 0; c < 3; ++c) {
        const float t = tint[c] < 1 ? std::pow(tint[c], 1 / max(cos_t, 1e-4f)) : 1.0f;
        const SheetFractions<float> of_channel = sheet_fractions(f, t);
        result.transmitted[c] = of_channel.transmitted;
        result.reflected[c] = of_channel.reflected;
    }
    return result;
}

std::optional<BsdfSample> ThinDielectricBsdf::sample(Vec3 wo, float lobe, Vec2, TransportMode) const {
    if (wo.z == 0) return std::nullopt;
    const Fractions p = fractions(abs_cos_theta(wo));
    const float r = average(p.reflected), t = average(p.transmitted);
    if (!(r + t > 0)) return std::nullopt; // the tint is black, and the index is that of the surroundings
    const float reflected = r / (r + t);
    if (lobe < reflected) return BsdfSample{{-wo.x, -wo.y, wo.z}, p.reflected / reflected, reflected, true};
    const float through = t / (r + t); // 1 − reflected would cancel at grazing angles
    return BsdfSample{{-wo.x, -wo.y, -wo.z}, p.transmitted / through, through, true, true};
}

} // namespace duet
