#include "common/material/material.h"

#include "common/material/reflectance.h"

#include <utility>

namespace duet {

Bsdf bsdf_at(const Material& material, const TextureSet& textures, const SurfacePoint& point) {
    struct {
        const TextureSet& textures;
        const SurfacePoint& point;
        Bsdf operator()(const Diffuse& m) const {
            if (m.rough()) return m.rough_at(textures, point);
            return m.at(textures, point);
        }
        Bsdf operator()(const Dielectric& m) const {
            if (m.thin) return m.thin_at(textures, point);
            if (m.smooth() || is_index_matched(m.ior)) return m.at(textures, point);
            const RoughDielectricBsdf rough = m.rough_at(textures, point);
            if (rough.alpha < Dielectric::kSmoothAlpha) return DielectricBsdf{rough.eta, rough.tint};
            return rough;
        }
        Bsdf operator()(const Metal& m) const { return m.at(textures, point); }
        Bsdf operator()(const Emissive& m) const { return m.at(textures, point); }
        Bsdf operator()(const Principled& m) const { return m.at(textures, point); }
        Bsdf operator()(const Coated& m) const { return m.at(textures, point); }
    } const make{textures, point};
    return std::visit(make, material);
}

const Rgb* mean_free_path(const Material& material) {
    if (const auto* coated = std::get_if<Coated>(&material)) return &coated->mean_free_path;
    if (const auto* principled = std::get_if<Principled>(&material)) return &principled->mean_free_path;
    return nullptr;
}

Rgb* mean_free_path(Material& material) { return const_cast<Rgb*>(mean_free_path(std::as_const(material))); }

bool has_subsurface(const Material& material) {
    const Rgb* path = mean_free_path(material);
    return path != nullptr && !is_black(*path);
}

SubsurfaceBsdf subsurface_at(const Material& material, const TextureSet& textures, const SurfacePoint& point) {
    if (const auto* principled = std::get_if<Principled>(&material)) return principled->subsurface_at(textures, point);
    return std::get<Coated>(material).subsurface_at(textures, point);
}

SubsurfaceExitBsdf subsurface_exit_at(const Material& material, const TextureSet& textures, const SurfacePoint& point) {
    const LayeredBsdf surface = std::get<LayeredBsdf>(bsdf_at(material, textures, point));
    return {surface, surface.mean_passed()};
}

float internal_reflectance(const Material& material) {
    const auto* coated = std::get_if<Coated>(&material);
    return coated != nullptr ? coated->internal_reflectance() : 0;
}

bool is_specular(const Bsdf& bsdf) {
    if (const auto* metal = std::get_if<MetalBsdf>(&bsdf)) return metal->smooth();
    return std::holds_alternative<DielectricBsdf>(bsdf) || std::holds_alternative<ThinDielectricBsdf>(bsdf);
}

float refraction_index(const Bsdf& bsdf) {
    if (const auto* glass = std::get_if<DielectricBsdf>(&bsdf)) return glass->eta;
    if (const auto* frosted = std::get_if<RoughDielectricBsdf>(&bsdf)) return frosted->eta;
    return 1;
}

Rgb emitted(const Material& material, const TextureSet& textures, const SurfacePoint& point, Vec3 w) {
    const auto* emissive = std::get_if<Emissive>(&material);
    return emissive != nullptr ? emissive->emitted(textures, point, w) : Rgb();
}

const Emissive* emitter(const Material& material) {
    const auto* emissive = std::get_if<Emissive>(&material);
    return emissive != nullptr && !is_black(emissive->radiance) ? emissive : nullptr;
}

const RgbSlot& texture_slot(const Material& material) {
    struct {
        const RgbSlot& operator()(const Diffuse& m) const { return m.albedo; }
        const RgbSlot& operator()(const Metal& m) const { return m.reflectance; }
        const RgbSlot& operator()(const Dielectric& m) const { return m.tint; }
        const RgbSlot& operator()(const Emissive& m) const { return m.albedo; }
        const RgbSlot& operator()(const Principled& m) const { return m.base_color; }
        const RgbSlot& operator()(const Coated& m) const { return m.albedo; }
    } const slot;
    return std::visit(slot, material);
}

RgbSlot& texture_slot(Material& material) { return const_cast<RgbSlot&>(texture_slot(std::as_const(material))); }

Rgb base_color(const Material& material, const TextureSet& textures, const SurfacePoint& point) {
    const auto* metal = std::get_if<Metal>(&material);
    if (metal != nullptr && metal->conductor.valid()) return metal->conductor.f0;
    return evaluate_reflectance(textures, texture_slot(material), point);
}

} // namespace duet
