#include "common/material/layered.h"

#include "common/material/fresnel.h"
#include "common/material/ggx.h"
#include "common/material/ggx_albedo.h"
#include "common/material/microfacet.h"
#include "common/sampling/warp.h"

namespace duet {

namespace {

constexpr float kCoat = LayeredBsdf::kCoatNormal;

float grey_multiple(float normal, float mean_lost) { return ggx_multiple(schlick_average(Rgb(normal)), mean_lost).r; }

/// Returns E(w), the albedo of a dielectric layer: single scattering plus the part of the lost light that multiple
/// scattering returns.
float layer_albedo(GgxAlbedo single, float normal, float multiple, float mean_lost) {
    return min(single.of(normal) + multiple * (1 - single.energy) * kPi * mean_lost, 1.0f);
}
/// Returns the cosine-weighted mean 2∫ E μ dμ of a dielectric layer's albedo E.
float mean_layer_albedo(const GgxMeans& means, float normal, float multiple) {
    return means.of(normal) + multiple * kPi * sqr(means.lost);
}

/// A Way describes how the layers scatter and transmit light from one direction.
struct Way {
    /// In the glossy layer, `lost` is the fraction that single scattering misses, and `under` = 1 − E is the
    /// fraction that passes the dielectric.
    float lost, under;
    /// In the coat, `coat_lost` is the fraction that single scattering misses, and `under_coat` is the fraction that
    /// passes.
    float coat_lost, under_coat;
    GgxAlbedo glossy;
};
Way way(const LayeredBsdf& b, const GgxMeans& means, float cosine) {
    Way w{};
    w.glossy = ggx_albedo(b.glossy.alpha, cosine);
    w.lost = 1 - w.glossy.energy;
    w.under = 1 - layer_albedo(w.glossy, b.dielectric, b.dielectric_multiple, means.lost);
    w.under_coat = 1;
    if (b.coat > 0) {
        const GgxAlbedo coat = ggx_albedo(b.coat_alpha, cosine);
        w.coat_lost = 1 - coat.energy;
        w.under_coat = 1 - b.coat * layer_albedo(coat, kCoat, b.coat_multiple, ggx_means(b.coat_alpha).lost);
    }
    return w;
}

/// A Choice holds the selection probabilities of the sampled lobes. `diffuse` is a cosine lobe for the diffuse
/// surface and all multiple scattering; `glossy` and `coat` are single scattering by that layer.
struct Choice {
    float diffuse, glossy, coat; ///< probabilities that add up to 1
};
Choice choice(const LayeredBsdf& b, const GgxMeans& means, const Way& w) {
    const float further = average(b.glossy.multiple) * w.lost * kPi * means.lost;
    Choice c{};
    c.diffuse = w.under_coat * (average(b.diffuse) * w.under + further);
    c.glossy = w.under_coat * average(w.glossy.of(b.glossy.normal));
    // Each existing lobe gets a minimum probability: a lobe of small albedo may be bright in one direction.
    c.glossy += 0.01f;
    c.coat = 1 - w.under_coat + 0.01f * b.coat;
    const float sum = c.diffuse + c.glossy + c.coat;
    return {c.diffuse / sum, c.glossy / sum, c.coat / sum};
}

} // namespace

LayeredBsdf::LayeredBsdf(const Description& d) {
    glossy.alpha = max(sqr(d.roughness), kSmoothest);
    const float m = d.metallic, lost = ggx_means(glossy.alpha).lost;
    dielectric = d.dielectric;
    dielectric_multiple = grey_multiple(dielectric, lost);
    diffuse = d.color * (1 - m);
    glossy.normal = lerp(Rgb(dielectric), d.color, m);
    glossy.multiple = lerp(Rgb(dielectric_multiple), ggx_multiple(schlick_average(d.color), lost), m);
    coat = d.coat;
    coat_alpha = max(sqr(d.coat_roughness), kSmoothest);
    coat_multiple = coat > 0 ? grey_multiple(kCoat, ggx_means(coat_alpha).lost) : 0;
}

Rgb LayeredBsdf::eval(Vec3 wo, Vec3 wi, TransportMode) const {
    if (!same_hemisphere(wo, wi)) return Rgb();
    wo = upwards(wo);
    wi = upwards(wi);
    const GgxMeans means = ggx_means(glossy.alpha);
    const Way o = way(*this, means, wo.z), i = way(*this, means, wi.z);
    const Microfacet h = microfacet(wo, wi);
    const float mean = mean_layer_albedo(means, dielectric, dielectric_multiple);
    Rgb f = diffuse * (o.under * i.under * kInvPi / max(1 - mean, 1e-4f)) + glossy.multiple * (o.lost * i.lost) +
            fresnel_schlick(glossy.normal, h.cosine) * ggx_reflection(wo, wi, h.normal, glossy.alpha);
    if (coat > 0)
        f = f * min(o.under_coat, i.under_coat) +
            (fresnel_schlick(Rgb(kCoat), h.cosine) * ggx_reflection(wo, wi, h.normal, coat_alpha) +
             Rgb(coat_multiple * (o.coat_lost * i.coat_lost))) * coat;
    return f;
}

std::optional<BsdfSample> LayeredBsdf::sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const {
    if (wo.z == 0) return std::nullopt;
    const Vec3 above = upwards(wo);
    const GgxMeans means = ggx_means(glossy.alpha);
    const Choice c = choice(*this, means, way(*this, means, above.z));
    Vec3 wi;
    if (lobe < c.diffuse)
        wi = cosine_hemisphere(u);
    else
        wi = reflect(above, ggx_sample_visible_normal(
                                above, lobe < c.diffuse + c.glossy || coat == 0 ? glossy.alpha : coat_alpha, u));
    wi = normalize(wi);
    if (!(wi.z > 0)) return std::nullopt;
    if (wo.z < 0) wi.z = -wi.z;
    return sample_of(*this, wo, wi, mode);
}

float LayeredBsdf::pdf(Vec3 wo, Vec3 wi, TransportMode) const {
    if (!same_hemisphere(wo, wi)) return 0;
    wo = upwards(wo);
    wi = upwards(wi);
    const GgxMeans means = ggx_means(glossy.alpha);
    const Choice c = choice(*this, means, way(*this, means, wo.z));
    const Vec3 h = microfacet(wo, wi).normal;
    float density = c.diffuse * cosine_hemisphere_pdf(wi.z) + c.glossy * ggx_reflection_pdf(wo, h, glossy.alpha);
    if (coat > 0) density += c.coat * ggx_reflection_pdf(wo, h, coat_alpha);
    return density;
}

LayeredBsdf::Albedos LayeredBsdf::albedos(float cosine) const {
    const GgxMeans means = ggx_means(glossy.alpha);
    const Way w = way(*this, means, cosine);
    const Rgb all = w.glossy.of(glossy.normal) + glossy.multiple * (w.lost * kPi * means.lost);
    return {diffuse * (w.under * w.under_coat), all * w.under_coat, Rgb(1 - w.under_coat)};
}

} // namespace duet
