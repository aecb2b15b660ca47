#include "common/material/rough_dielectric.h"

#include "common/material/fresnel.h"
#include "common/material/ggx.h"
#include "common/material/microfacet.h"
#include "common/material/rough_glass_energy.h"
#include "common/sampling/warp.h"

namespace duet {

namespace {

/// OrientedDirections holds both directions and the relative index in the frame where wo lies above the boundary.
/// `relative` is the index beyond the boundary over the index on wo's side.
struct OrientedDirections {
    Vec3 wo, wi;
    float relative;

    OrientedDirections(Vec3 wo_, Vec3 wi_, float eta) : wo(wo_), wi(wi_), relative(eta) {
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
std::optional<Refraction> refraction(const OrientedDirections& s) {
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

/// MultipleScattering computes the multiple-scattering terms for wo.
struct MultipleScattering {
    RoughGlassEnergy energy;
    RoughGlassEnergy::Lobe lobe; ///< reflection lobe on wo's side
    bool dense;                  ///< whether wo is on the side of the larger index
    float energy_loss; ///< fraction of light from wo that the lobe returns; also the probability of sampling it

    MultipleScattering(const OrientedDirections& s, float alpha)
        : energy(s.relative, alpha), lobe(energy.lobe(s.relative < 1)), dense(s.relative < 1),
          energy_loss(energy.energy_loss(lobe, s.wo.z)) {}

    float reflected(const OrientedDirections& s) const {
        return energy_loss > 0 ? energy_loss * energy.energy_loss(lobe, s.wi.z) * kInvPi / lobe.mean_energy_loss : 0;
    }
    float gain(const OrientedDirections& s) const { return energy.gain(dense ? -s.wi.z : s.wo.z); }
};

} // namespace

Rgb RoughDielectricBsdf::eval(Vec3 wo, Vec3 wi, TransportMode mode) const {
    if (wo.z == 0 || wi.z == 0) return Rgb();
    const OrientedDirections s(wo, wi, eta);
    const MultipleScattering multiple(s, alpha);
    if (s.wi.z > 0) {
        const Microfacet h = microfacet(s.wo, s.wi);
        return Rgb(fresnel_dielectric(h.cosine, s.relative) * ggx_d(h.normal, alpha) *
                       ggx_visibility(s.wo, s.wi, alpha) +
                   multiple.reflected(s));
    }
    const auto r = refraction(s);
    if (!r) return Rgb();
    // This is Walter et al., eq. 21; ggx_visibility returns G₂/(4 cos cos).
    const float through = (1 - fresnel_dielectric(r->cos_o, s.relative)) * ggx_d(r->normal, alpha) *
                          ggx_visibility(s.wo, Vec3(s.wi.x, s.wi.y, -s.wi.z), alpha) * 4 * r->cos_o *
                          jacobian(*r, s.relative) * multiple.gain(s);
    return tint * (mode == TransportMode::kRadiance ? through / sqr(s.relative) : through);
}

std::optional<BsdfSample> RoughDielectricBsdf::sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const {
    if (wo.z == 0) return std::nullopt;
    const OrientedDirections s(wo, wo, eta);
    const float single = 1 - MultipleScattering(s, alpha).energy_loss;
    const bool multiple_lobe = lobe >= single;
    const Vec3 h = ggx_sample_visible_normal(s.wo, alpha, u);
    const float cos_o = dot(s.wo, h);
    if (!(multiple_lobe || cos_o > 0)) return std::nullopt;
    const bool through = !multiple_lobe && !(lobe < single * fresnel_dielectric(cos_o, s.relative));
    Vec3 wi = through         ? refract(s.wo, h, cos_o, s.relative)
              : multiple_lobe ? cosine_hemisphere(u)
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
    const OrientedDirections s(wo, wi, eta);
    const float multiple_lobe = MultipleScattering(s, alpha).energy_loss;
    if (s.wi.z > 0) {
        const Microfacet h = microfacet(s.wo, s.wi);
        return lerp(fresnel_dielectric(h.cosine, s.relative) * ggx_reflection_pdf(s.wo, h.normal, alpha),
                    cosine_hemisphere_pdf(s.wi.z), multiple_lobe);
    }
    const auto r = refraction(s);
    if (!r) return 0;
    // The density of visible normals is G₁ D cos_o / cos θₒ, which is the reflection's density times 4 cos_o.
    return (1 - multiple_lobe) * (1 - fresnel_dielectric(r->cos_o, s.relative)) * 4 * r->cos_o *
           ggx_reflection_pdf(s.wo, r->normal, alpha) * jacobian(*r, s.relative);
}

} // namespace duet
