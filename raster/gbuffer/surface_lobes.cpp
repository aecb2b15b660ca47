#include "raster/gbuffer/surface_lobes.h"

namespace duet::raster {
namespace {

Rgb outer_reflectance(float eta) { return Rgb(sqr((eta - 1) / (eta + 1))); }

struct LobesOf {
    float cosine;

    SurfaceLobes operator()(const DiffuseBsdf& b) const { return {.diffuse = b.albedo}; }
    /// The directional albedo is exact under uniform light, and a good approximation under an area light.
    SurfaceLobes operator()(const RoughDiffuseBsdf& b) const { return {.diffuse = b.directional_albedo(cosine)}; }
    SurfaceLobes operator()(const MetalBsdf& b) const { return {.specular = b.reflectance, .alpha = b.alpha}; }
    SurfaceLobes operator()(const LayeredBsdf& b) const {
        return {.diffuse = b.albedos(cosine).diffuse,
                .specular = b.glossy.f0,
                .alpha = b.glossy.alpha,
                .coat = b.coat,
                .coat_alpha = b.coat_alpha};
    }
    SurfaceLobes operator()(const RoughDielectricBsdf& b) const {
        return {.specular = outer_reflectance(b.eta), .alpha = b.alpha, .tint = b.tint};
    }
    SurfaceLobes operator()(const DielectricBsdf& b) const {
        return {.specular = outer_reflectance(b.eta), .alpha = 0, .tint = b.tint};
    }
    SurfaceLobes operator()(const ThinDielectricBsdf& b) const { return {.alpha = 0, .tint = b.tint}; }
    /// bsdf_at() returns neither of these subsurface BSDFs, but std::visit needs their overloads.
    SurfaceLobes operator()(const SubsurfaceBsdf& b) const { return (*this)(b.surface); }
    SurfaceLobes operator()(const SubsurfaceExitBsdf& b) const { return (*this)(b.surface); }
};

bool varies(const Principled& p) {
    return !p.metallic.constant() || !p.roughness.constant() || !p.clearcoat.constant() ||
           !p.clearcoat_roughness.constant();
}

/// Returns the material with white in place of its color, which may be an image.
struct Whitened {
    static constexpr RgbSlot kWhite{};

    Material operator()(Diffuse m) const { return m.albedo = kWhite, m; }
    Material operator()(Metal m) const { return m.reflectance = kWhite, m; }
    Material operator()(Dielectric m) const { return m.tint = kWhite, m; }
    Material operator()(Emissive m) const { return m.albedo = kWhite, m; }
    Material operator()(Principled m) const { return m.base_color = kWhite, m; }
    Material operator()(Coated m) const { return m.albedo = kWhite, m; }
};

} // namespace

void LobesOfColor::tabulate(const LayeredBsdf& layers) {
    alpha = layers.glossy.alpha, coat = layers.coat, coat_alpha = layers.coat_alpha;
    layered_ = true;
    for (int i = 0; i <= kSteps; ++i)
        passed_[static_cast<std::size_t>(i)] =
            layers.albedos(max(static_cast<float>(i) / kSteps, 1e-4f)).diffuse.r;
    passed_.back() = passed_[kSteps];
}

std::optional<LobesOfColor> LobesOfColor::of(const Material& material) {
    const Material white = std::visit(Whitened{}, material);
    const TextureSet no_textures;
    LobesOfColor result;
    if (const auto* diffuse = std::get_if<Diffuse>(&white)) {
        if (diffuse->rough()) return std::nullopt;
        result.passed_.fill(1);
    } else if (std::holds_alternative<Emissive>(white)) {
        result.passed_.fill(1);
    } else if (const auto* metal = std::get_if<Metal>(&white)) {
        if (!metal->roughness.constant()) return std::nullopt;
        result.metallic_ = 1;
        result.alpha = metal->at(no_textures, SurfacePoint{}).alpha;
    } else if (const auto* principled = std::get_if<Principled>(&white)) {
        if (varies(*principled)) return std::nullopt;
        const LayeredBsdf layers = principled->at(no_textures, SurfacePoint{});
        result.tabulate(layers);
        result.metallic_ = clamp(principled->metallic.value, 0.0f, 1.0f);
        result.dielectric_ = layers.dielectric * (1 - result.metallic_);
    } else if (const auto* coated = std::get_if<Coated>(&white)) {
        if (!coated->roughness.constant()) return std::nullopt;
        const LayeredBsdf layers = coated->at(no_textures, SurfacePoint{});
        result.tabulate(layers);
        result.dielectric_ = layers.dielectric;
        result.back_ = coated->internal_reflectance();
    } else if (const auto* glass = std::get_if<Dielectric>(&white)) {
        if (!glass->roughness.constant()) return std::nullopt;
        const SurfaceLobes lobes = surface_lobes(bsdf_at(white, no_textures, SurfacePoint{}), 1);
        result.dielectric_ = lobes.specular.r;
        result.alpha = lobes.alpha;
    }
    return result;
}

SurfaceLobes surface_lobes(const Bsdf& bsdf, float cosine) { return std::visit(LobesOf{cosine}, bsdf); }

} // namespace duet::raster
