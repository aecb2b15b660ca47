#include "common/material/material.h"

#include <utility>

#include <type_traits>

namespace duet {

Bsdf bsdf_at(const Material& material, const TextureSet& textures, const SurfacePoint& point) {
    return std::visit([&](const auto& m) -> Bsdf { return m.at(textures, point); }, material);
}

bool is_specular(const Bsdf& bsdf) {
    if (const auto* metal = std::get_if<MetalBsdf>(&bsdf)) return metal->smooth();
    return std::holds_alternative<DielectricBsdf>(bsdf);
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
    } const slot;
    return std::visit(slot, material);
}

RgbSlot& texture_slot(Material& material) { return const_cast<RgbSlot&>(texture_slot(std::as_const(material))); }

Rgb base_color(const Material& material, const TextureSet& textures, const SurfacePoint& point) {
    struct {
        const TextureSet& textures;
        const SurfacePoint& point;
        Rgb operator()(const Diffuse& m) const { return m.at(textures, point).albedo; }
        Rgb operator()(const Metal& m) const { return m.at(textures, point).reflectance; }
        Rgb operator()(const Dielectric& m) const { return m.at(textures, point).tint; }
        Rgb operator()(const Emissive& m) const { return m.at(textures, point).albedo; }
    } const color{textures, point};
    return std::visit(color, material);
}

} // namespace duet
