#include "raster/gbuffer/surface_lobes.h"

namespace duet::raster {
namespace {

Rgb outer_reflectance(float eta) { return Rgb(sqr((eta - 1) / (eta + 1))); }

struct LobesOf {
    float cosine;

    SurfaceLobes operator()(const DiffuseBsdf& b) const { return {.diffuse = b.albedo, .specular = {}}; }
    /// The directional albedo is exact under uniform light, and close under light from an area.
    SurfaceLobes operator()(const RoughDiffuseBsdf& b) const {
        return {.diffuse = b.directional_albedo(cosine), .specular = {}};
    }
    SurfaceLobes operator()(const MetalBsdf& b) const {
        return {.diffuse = {}, .specular = b.reflectance, .alpha = b.alpha};
    }
    SurfaceLobes operator()(const LayeredBsdf& b) const {
        return {.diffuse = b.albedos(cosine).diffuse,
                .specular = b.glossy.f0,
                .alpha = b.glossy.alpha,
                .coat = b.coat,
                .coat_alpha = b.coat_alpha};
    }
    SurfaceLobes operator()(const RoughDielectricBsdf& b) const {
        return {.diffuse = {}, .specular = outer_reflectance(b.eta), .alpha = b.alpha};
    }
    SurfaceLobes operator()(const DielectricBsdf& b) const {
        return {.diffuse = {}, .specular = outer_reflectance(b.eta), .alpha = 0};
    }
    SurfaceLobes operator()(const ThinDielectricBsdf&) const { return {.diffuse = {}, .specular = {}, .alpha = 0}; }
};

bool varies(const Principled& p) {
    return !p.metallic.constant() || !p.roughness.constant() || !p.clearcoat.constant() ||
           !p.clearcoat_roughness.constant();
}

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
    const TextureSet no_textures;
    LobesOfColor result;
    if (const auto* diffuse = std::get_if<Diffuse>(&material)) {
        if (diffuse->rough()) return std::nullopt;
        result.passed_.fill(1);
    } else if (std::holds_alternative<Emissive>(material)) {
        result.passed_.fill(1);
    } else if (const auto* metal = std::get_if<Metal>(&material)) {
        if (!metal->roughness.constant()) return std::nullopt;
        Metal white = *metal;
        white.reflectance = RgbSlot{Rgb(1.0f)};
        result.metallic_ = 1;
        result.alpha = white.at(no_textures, SurfacePoint{}).alpha;
    } else if (const auto* principled = std::get_if<Principled>(&material)) {
        if (varies(*principled)) return std::nullopt;
        Principled white = *principled;
        white.base_color = RgbSlot{Rgb(1.0f)};
        const LayeredBsdf layers = white.at(no_textures, SurfacePoint{});
        result.tabulate(layers);
        result.metallic_ = clamp(principled->metallic.value, 0.0f, 1.0f);
        result.dielectric_ = layers.dielectric * (1 - result.metallic_);
    } else if (const auto* coated = std::get_if<Coated>(&material)) {
        if (!coated->roughness.constant()) return std::nullopt;
        Coated white = *coated;
        white.albedo = RgbSlot{Rgb(1.0f)};
        const LayeredBsdf layers = white.at(no_textures, SurfacePoint{});
        result.tabulate(layers);
        result.dielectric_ = layers.dielectric;
        result.back_ = coated->internal_reflectance();
    } else if (const auto* glass = std::get_if<Dielectric>(&material)) {
        if (!glass->roughness.constant()) return std::nullopt;
        Dielectric clear = *glass;
        clear.tint = RgbSlot{Rgb(1.0f)};
        const SurfaceLobes lobes = surface_lobes(bsdf_at(clear, no_textures, SurfacePoint{}), 1);
        result.dielectric_ = lobes.specular.r;
        result.alpha = lobes.alpha;
    }
    return result;
}

SurfaceLobes surface_lobes(const Bsdf& bsdf, float cosine) { return std::visit(LobesOf{cosine}, bsdf); }

} // namespace duet::raster
