#include "common/material/layered.h"

#include "common/material/fresnel.h"
#include "common/material/ggx.h"
#include "common/material/ggx_albedo.h"
#include "common/material/microfacet.h"
#include "common/sampling/warp.h"

namespace duet {

namespace {

constexpr float kCoat = LayeredBsdf::kCoatF0;

float gray_multiple_scattering(float f0, float mean_energy_loss) {
    return ggx_multiple_scattering(schlick_average(Rgb(f0)), mean_energy_loss).r;
}

/// Returns E(w), the albedo of a dielectric layer: single scattering plus the fraction of the lost light that multiple
/// scattering returns.
float layer_albedo(GgxAlbedo single, float f0, float multiple_scattering, float mean_energy_loss) {
    return min(single.albedo(f0) + multiple_scattering * (1 - single.energy) * kPi * mean_energy_loss, 1.0f);
}
/// Returns the cosine-weighted mean 2∫ E μ dμ of a dielectric layer's albedo E.
float mean_layer_albedo(const GgxAverageAlbedo& means, float f0, float multiple_scattering) {
    return means.albedo(f0) + multiple_scattering * kPi * sqr(means.energy_loss);
}

/// A LayerTransport describes how the layers scatter and transmit light from one direction.
struct LayerTransport {
    /// In the glossy layer, `energy_loss` is the fraction that single scattering misses, and `transmitted` = 1 − E is
    /// the fraction that passes the dielectric.
    float energy_loss, transmitted;
    /// In the coat, `coat_energy_loss` is the fraction that single scattering misses, and `transmitted_by_coat` is the
    /// fraction that passes.
    float coat_energy_loss, transmitted_by_coat;
    GgxAlbedo glossy;
};
LayerTransport layer_transport(const LayeredBsdf& b, const GgxAverageAlbedo& means, float cosine) {
    LayerTransport w{};
    w.glossy = ggx_albedo(b.glossy.alpha, cosine);
    w.energy_loss = 1 - w.glossy.energy;
    w.transmitted = 1 - layer_albedo(w.glossy, b.dielectric, b.dielectric_multiple, means.energy_loss);
    w.transmitted_by_coat = 1;
    if (b.coat > 0) {
        const GgxAlbedo coat = ggx_albedo(b.coat_alpha, cosine);
        w.coat_energy_loss = 1 - coat.energy;
        w.transmitted_by_coat =
            1 - b.coat * layer_albedo(coat, kCoat, b.coat_multiple, ggx_average_albedo(b.coat_alpha).energy_loss);
    }
    return w;
}

/// LobeProbabilities holds the selection probabilities of the sampled lobes. `diffuse` is a cosine lobe for the diffuse
/// surface and all multiple scattering; `glossy` and `coat` are single scattering by that layer.
struct LobeProbabilities {
    float diffuse, glossy, coat; ///< probabilities that add up to 1
};
LobeProbabilities lobe_probabilities(const LayeredBsdf& b, const GgxAverageAlbedo& means, const LayerTransport& w) {
    const float multiple_probability = average(b.glossy.multiple_scattering) * w.energy_loss * kPi * means.energy_loss;
    LobeProbabilities c{};
    c.diffuse = w.transmitted_by_coat * (average(b.diffuse) * w.transmitted + multiple_probability);
    c.glossy = w.transmitted_by_coat * average(w.glossy.albedo(b.glossy.f0));
    // Each existing lobe gets a minimum probability: a lobe of small albedo may be bright in one direction.
    c.glossy += 0.01f;
    c.coat = 1 - w.transmitted_by_coat + 0.01f * b.coat;
    const float sum = c.diffuse + c.glossy + c.coat;
    return {c.diffuse / sum, c.glossy / sum, c.coat / sum};
}

} // namespace

LayeredBsdf::LayeredBsdf(const Description& d) {
    glossy.alpha = max(sqr(d.roughness), kSmoothest);
    const float m = d.metallic, energy_loss = ggx_average_albedo(glossy.alpha).energy_loss;
    dielectric = d.dielectric;
    dielectric_multiple = gray_multiple_scattering(dielectric, energy_loss);
    diffuse = d.color * (1 - m);
    glossy.f0 = lerp(Rgb(dielectric), d.color, m);
    glossy.multiple_scattering =
        lerp(Rgb(dielectric_multiple), ggx_multiple_scattering(schlick_average(d.color), energy_loss), m);
    coat = d.coat;
    coat_alpha = max(sqr(d.coat_roughness), kSmoothest);
    coat_multiple = coat > 0 ? gray_multiple_scattering(kCoat, ggx_average_albedo(coat_alpha).energy_loss) : 0;
}

Rgb LayeredBsdf::eval(Vec3 wo, Vec3 wi, TransportMode) const {
    if (!same_hemisphere(wo, wi)) return Rgb();
    wo = to_upper_hemisphere(wo);
    wi = to_upper_hemisphere(wi);
    const GgxAverageAlbedo means = ggx_average_albedo(glossy.alpha);
    const LayerTransport o = layer_transport(*this, means, wo.z), i = layer_transport(*this, means, wi.z);
    const Microfacet h = microfacet(wo, wi);
    const float mean = mean_layer_albedo(means, dielectric, dielectric_multiple);
    Rgb f = diffuse * (o.transmitted * i.transmitted * kInvPi / max(1 - mean, 1e-4f)) +
            glossy.multiple_scattering * (o.energy_loss * i.energy_loss) +
            fresnel_schlick(glossy.f0, h.cosine) * ggx_reflection(wo, wi, h.normal, glossy.alpha);
    if (coat > 0)
        f = f * min(o.transmitted_by_coat, i.transmitted_by_coat) +
            (fresnel_schlick(Rgb(kCoat), h.cosine) * ggx_reflection(wo, wi, h.normal, coat_alpha) +
             Rgb(coat_multiple * (o.coat_energy_loss * i.coat_energy_loss))) *
                coat;
    return f;
}

std::optional<BsdfSample> LayeredBsdf::sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const {
    if (wo.z == 0) return std::nullopt;
    const Vec3 above = to_upper_hemisphere(wo);
    const GgxAverageAlbedo means = ggx_average_albedo(glossy.alpha);
    const LobeProbabilities c = lobe_probabilities(*this, means, layer_transport(*this, means, above.z));
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
    wo = to_upper_hemisphere(wo);
    wi = to_upper_hemisphere(wi);
    const GgxAverageAlbedo means = ggx_average_albedo(glossy.alpha);
    const LobeProbabilities c = lobe_probabilities(*this, means, layer_transport(*this, means, wo.z));
    const Vec3 h = microfacet(wo, wi).normal;
    float density = c.diffuse * cosine_hemisphere_pdf(wi.z) + c.glossy * ggx_reflection_pdf(wo, h, glossy.alpha);
    if (coat > 0) density += c.coat * ggx_reflection_pdf(wo, h, coat_alpha);
    return density;
}

LayeredBsdf::Albedos LayeredBsdf::albedos(float cosine) const {
    const GgxAverageAlbedo means = ggx_average_albedo(glossy.alpha);
    const LayerTransport w = layer_transport(*this, means, cosine);
    const Rgb all = w.glossy.albedo(glossy.f0) + glossy.multiple_scattering * (w.energy_loss * kPi * means.energy_loss);
    return {diffuse * (w.transmitted * w.transmitted_by_coat), all * w.transmitted_by_coat,
            Rgb(1 - w.transmitted_by_coat)};
}

float LayeredBsdf::passed(float cosine) const {
    const LayerTransport w = layer_transport(*this, ggx_average_albedo(glossy.alpha), cosine);
    return w.transmitted * w.transmitted_by_coat;
}

float LayeredBsdf::mean_passed() const {
    if (coat == 0)
        return max(1 - mean_layer_albedo(ggx_average_albedo(glossy.alpha), dielectric, dielectric_multiple), 1e-4f);
    constexpr int kSteps = 16; // equal steps of the squared cosine, as 2∫ f μ dμ = ∫ f d(μ²)
    float sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += passed(std::sqrt((static_cast<float>(i) + 0.5f) / kSteps));
    return max(sum / kSteps, 1e-4f);
}

} // namespace duet
