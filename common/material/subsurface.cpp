#include "common/material/subsurface.h"

#include "common/sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

// The coefficients are per meter. The index of refraction is 1.3 or 1.5 (Jensen, Marschner, Levoy and Hanrahan 2001, "A
// Practical Model for Subsurface Light Transport", figure 5).
constexpr MeasuredSolid kMeasuredSolids[] = {
    {"apple", {2290, 2390, 1970}, {3.0f, 3.4f, 46}, 1.3f},
    {"chicken", {150, 210, 380}, {15, 77, 190}, 1.3f},
    {"cream", {7380, 5470, 3150}, {0.2f, 2.8f, 16.3f}, 1.3f},
    {"ketchup", {180, 70, 30}, {61, 970, 1450}, 1.3f},
    {"marble", {2190, 2620, 3000}, {2.1f, 4.1f, 7.1f}, 1.5f},
    {"potato", {680, 700, 550}, {2.4f, 9, 120}, 1.3f},
    {"skimmed-milk", {700, 1220, 1900}, {1.4f, 2.5f, 14.2f}, 1.3f},
    {"skin", {740, 880, 1010}, {32, 170, 480}, 1.3f},
    {"skin-pale", {1090, 1590, 1790}, {13, 70, 145}, 1.3f},
    {"whole-milk", {2550, 3210, 3770}, {1.1f, 2.4f, 14}, 1.3f},
};

} // namespace

float thick_layer_albedo(float single_scattering_albedo) {
    const float s = std::sqrt(1 - single_scattering_albedo);
    return (1 - s) * (1 - kHulstA * s) / (1 + kHulstB * s);
}

SolidInterior solid_interior(Rgb albedo, Rgb mean_free_path) {
    const auto absorbed = [](float a) { return min(sqr(similarity_parameter(clamp(a, 0.0f, 1.0f))), 1.0f); };
    const Rgb fraction(absorbed(albedo.r), absorbed(albedo.g), absorbed(albedo.b));
    return {(Rgb(1.0f) - fraction) / mean_free_path, fraction / mean_free_path};
}

Rgb MeasuredSolid::albedo() const {
    const Rgb fraction = scattering / (scattering + absorption);
    return {thick_layer_albedo(fraction.r), thick_layer_albedo(fraction.g), thick_layer_albedo(fraction.b)};
}

std::span<const MeasuredSolid> measured_solids() { return kMeasuredSolids; }

const MeasuredSolid* find_measured_solid(std::string_view name) {
    const auto* found = std::ranges::find(kMeasuredSolids, name, &MeasuredSolid::name);
    return found == std::end(kMeasuredSolids) ? nullptr : found;
}

float SubsurfaceBsdf::entering_probability(float cosine) const {
    const LayeredBsdf::Albedos reflected = surface.albedos(cosine);
    const float enters = entering * surface.passed(cosine);
    const float sum = enters + average(reflected.diffuse + reflected.glossy + reflected.coat);
    return sum > 0 ? enters / sum : 0;
}

std::optional<BsdfSample> SubsurfaceBsdf::sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const {
    const float enters = entering_probability(wo.z), reflects = 1 - enters;
    if (lobe < enters) {
        const Vec3 wi = cosine_hemisphere(u);
        return BsdfSample{{wi.x, wi.y, -wi.z},
                          Rgb(entering * surface.passed(wo.z) / enters),
                          enters * cosine_hemisphere_pdf(wi.z),
                          false,
                          true};
    }
    std::optional<BsdfSample> s = surface.sample(wo, (lobe - enters) / reflects, u, mode);
    if (!s) return s;
    s->weight = s->weight / reflects;
    s->pdf *= reflects;
    return s;
}

float SubsurfaceBsdf::pdf(Vec3 wo, Vec3 wi, TransportMode mode) const {
    return (1 - entering_probability(wo.z)) * surface.pdf(wo, wi, mode);
}

Rgb SubsurfaceExitBsdf::eval(Vec3, Vec3 wi, TransportMode) const {
    return wi.z > 0 ? Rgb(surface.passed(wi.z) * kInvPi / mean_passed) : Rgb();
}

std::optional<BsdfSample> SubsurfaceExitBsdf::sample(Vec3 wo, float, Vec2 u, TransportMode mode) const {
    return sample_of(*this, wo, normalize(cosine_hemisphere(u)), mode);
}

float SubsurfaceExitBsdf::pdf(Vec3, Vec3 wi, TransportMode) const { return cosine_hemisphere_pdf(wi.z); }

} // namespace duet
