#include "common/material/rough_dielectric.h"

#include "common/material/fresnel.h"
#include "common/material/ggx.h"
#include "common/material/microfacet.h"
#include "common/material/rough_glass_energy.h"
#include "common/sampling/warp.h"

namespace duet {

namespace {

/// Seen holds both directions and the relative index in the frame where wo lies above the boundary. `relative` is the
/// index beyond the boundary over the index on wo's side.
struct Seen {
    Vec3 wo, wi;
    float relative;

    Seen(Vec3 wo_, Vec3 wi_, float eta) : wo(wo_), wi(wi_), relative(eta) {
        if (wo.z > 0) return;
        wo.z = -wo.z;
        wi.z = -wi.z;
        relative = 1 / eta;
    }
};

/// A Refraction is the microfacet that refracts wo into wi (Walter et al., eq. 16).
struct Refraction {
    Vec3 normal;
    float cos_o, cos_i; ///< wo·h, positive; wi·h, negative
    float sum;          ///< wo·h + relative·wi·h = ±|wo + relative·wi|, not 0
};
std::optional<Refraction> refraction(const Seen& s) {
    Vec3 h = s.wo + s.wi * s.relative;
    const float size = h.z < 0 ? -length(h) : length(h);
    if (size == 0) return std::nullopt;
    h = h / size;
    const Refraction r{h, dot(s.wo, h), dot(s.wi, h), size};
    if (!(r.cos_o > 0 && r.cos_i < 0)) return std::nullopt;
    return r;
}

/// Returns the Jacobian dω_h/dω_i of refraction, |cos_i| relative²/(sum)² (Walter et al., eq. 17).
float jacobian(const Refraction& r, float relative) { return sqr(relative / r.sum) * -r.cos_i; }

/// Further computes the multiple-scattering terms for wo.
struct Further {
    RoughGlassEnergy energy;
    RoughGlassEnergy::Lobe lobe; ///< reflection lobe on wo's side
    bool dense;                  ///< whether wo is on the side of the larger index
    float lost; ///< fraction of light from wo that the lobe returns; also the probability of sampling it

    Further(const Seen& s, float alpha)
        : energy(s.relative, alpha), lobe(energy.lobe(s.relative < 1)), dense(s.relative < 1),
          lost(energy.lost(lobe, s.wo.z)) {}

    float reflected(const Seen& s) const {
        return lost > 0 ? lost * energy.lost(lobe, s.wi.z) * kInvPi / lobe.mean_lost : 0;
    }
    float gain(const Seen& s) const { return energy.gain(dense ? -s.wi.z : s.wo.z); }
};

} // namespace

Rgb RoughDielectricBsdf::eval(Vec3 wo, Vec3 wi, TransportMode mode) const {
    if (wo.z == 0 || wi.z == 0) return Rgb();
    const Seen s(wo, wi, eta);
    const Further further(s, alpha);
    if (s.wi.z > 0) {
        const Microfacet h = microfacet(s.wo, s.wi);
        return Rgb(fresnel_dielectric(h.cosine, s.relative) * ggx_d(h.normal, alpha) *
                       ggx_visibility(s.wo, s.wi, alpha) +
                   further.reflected(s));
    }
    const auto r = refraction(s);
    if (!r) return Rgb();
    // This is Walter et al., eq. 21; ggx_visibility returns G₂/(4 cos cos).
    const float through = (1 - fresnel_dielectric(r->cos_o, s.relative)) * ggx_d(r->normal, alpha) *
                          ggx_visibility(s.wo, Vec3(s.wi.x, s.wi.y, -s.wi.z), alpha) * 4 * r->cos_o *
                          jacobian(*r, s.relative) * further.gain(s);
    return tint * (mode == TransportMode::kRadiance ? through / sqr(s.relative) : through);
}

std::optional<BsdfSample> RoughDielectricBsdf::sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const {
    if (wo.z == 0) return std::nullopt;
    const Seen s(wo, wo, eta);
    const float single = 1 - Further(s, alpha).lost;
    const bool several = lobe >= single;
    const Vec3 h = ggx_sample_visible_normal(s.wo, alpha, u);
    const float cos_o = dot(s.wo, h);
    if (!(several || cos_o > 0)) return std::nullopt;
    const bool through = !several && !(lobe < single * fresnel_dielectric(cos_o, s.relative));
    Vec3 wi = through   ? refract(s.wo, h, cos_o, s.relative)
              : several ? cosine_hemisphere(u)
                        : normalize(reflect(s.wo, h));
    if (!(through ? wi.z < 0 : wi.z > 0)) return std::nullopt; // the light would hit a second microfacet
    if (wo.z < 0) wi.z = -wi.z;
    BsdfSample result = sample_of(*this, wo, wi, mode);
    if (!(result.pdf > 0 && result.pdf < kInfinity)) return std::nullopt;
    result.transmitted = through;
    return result;
}

float RoughDielectricBsdf::pdf(Vec3 wo, Vec3 wi, TransportMode) const {
    if (wo.z == 0 || wi.z == 0) return 0;
    const Seen s(wo, wi, eta);
    const float several = Further(s, alpha).lost;
    if (s.wi.z > 0) {
        const Microfacet h = microfacet(s.wo, s.wi);
        return lerp(fresnel_dielectric(h.cosine, s.relative) * ggx_reflection_pdf(s.wo, h.normal, alpha),
                    cosine_hemisphere_pdf(s.wi.z), several);
    }
    const auto r = refraction(s);
    if (!r) return 0;
    // The density of visible normals is G₁ D cos_o / cos θₒ, which is the reflection's density times 4 cos_o.
    return (1 - several) * (1 - fresnel_dielectric(r->cos_o, s.relative)) * 4 * r->cos_o *
           ggx_reflection_pdf(s.wo, r->normal, alpha) * jacobian(*r, s.relative);
}

} // namespace duet
