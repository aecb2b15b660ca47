// The closed set of materials. A material is a description with texture slots; at a point it becomes a Bsdf.
#pragma once

#include "common/material/dielectric.h"
#include "common/material/diffuse.h"
#include "common/material/emissive.h"
#include "common/material/metal.h"
#include "common/material/principled.h"

#include <concepts>
#include <type_traits>
#include <variant>

namespace duet {

using Material = std::variant<Diffuse, Metal, Dielectric, Emissive, Principled, Coated>;
// Those of a kind stand together: to ask for a kind is one comparison.
using Bsdf = std::variant<DiffuseBsdf, RoughDiffuseBsdf, MetalBsdf, LayeredBsdf, RoughDielectricBsdf, DielectricBsdf,
                          ThinDielectricBsdf>;

Bsdf bsdf_at(const Material& material, const TextureSet& textures, const SurfacePoint& point);

inline Rgb eval(const Bsdf& bsdf, Vec3 wo, Vec3 wi, TransportMode mode = TransportMode::kRadiance) {
    return std::visit([&](const auto& b) { return b.eval(wo, wi, mode); }, bsdf);
}
inline std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3 wo, float lobe, Vec2 u,
                                        TransportMode mode = TransportMode::kRadiance) {
    return std::visit([&](const auto& b) { return b.sample(wo, lobe, u, mode); }, bsdf);
}
inline float pdf(const Bsdf& bsdf, Vec3 wo, Vec3 wi, TransportMode mode = TransportMode::kRadiance) {
    return std::visit([&](const auto& b) { return b.pdf(wo, wi, mode); }, bsdf);
}
/// Whether the Bsdf has only delta lobes, which light sampling cannot find.
bool is_specular(const Bsdf& bsdf);
/// Whether it is matt: diffuse, smooth or rough, and nothing else.
inline bool is_diffuse(const Bsdf& bsdf) {
    return std::holds_alternative<DiffuseBsdf>(bsdf) || std::holds_alternative<RoughDiffuseBsdf>(bsdf);
}
/// Whether light goes through it.
inline bool is_transmissive(const Bsdf& bsdf) {
    return std::holds_alternative<DielectricBsdf>(bsdf) || std::holds_alternative<RoughDielectricBsdf>(bsdf) ||
           std::holds_alternative<ThinDielectricBsdf>(bsdf);
}
/// The index inside over outside of a surface that has an inside to refract into; 1: it has none.
float refraction_index(const Bsdf& bsdf);
/// Radiance that the material emits at a point towards w; black but for Emissive.
Rgb emitted(const Material& material, const TextureSet& textures, const SurfacePoint& point, Vec3 w);
/// The material as an emitter: null where it emits nothing, black emission included.
const Emissive* emitter(const Material& material);
/// The slot of a material's colour.
const RgbSlot& texture_slot(const Material& material);
RgbSlot& texture_slot(Material& material);
/// Calls visit(texture) for each of the material's references to a texture: an index, or −1.
template <typename AnyMaterial, typename Visit>
    requires std::same_as<std::remove_const_t<AnyMaterial>, Material>
void for_each_texture(AnyMaterial& material, const Visit& visit) {
    visit(texture_slot(material).texture);
    if (auto* diffuse = std::get_if<Diffuse>(&material)) visit(diffuse->roughness.texture);
    if (auto* metal = std::get_if<Metal>(&material)) visit(metal->roughness.texture);
    if (auto* glass = std::get_if<Dielectric>(&material)) visit(glass->roughness.texture);
    if (auto* emissive = std::get_if<Emissive>(&material)) visit(emissive->radiance_texture);
    if (auto* coated = std::get_if<Coated>(&material)) visit(coated->roughness.texture);
    if (auto* principled = std::get_if<Principled>(&material))
        for (auto* slot : {&principled->metallic, &principled->roughness, &principled->clearcoat, &principled->clearcoat_roughness})
            visit(slot->texture);
}
/// The colour one would paint it with: albedo, reflectance or tint at the point. For the albedo AOV.
Rgb base_color(const Material& material, const TextureSet& textures, const SurfacePoint& point);

} // namespace duet
