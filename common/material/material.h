// This file defines the closed set of materials. A material is a description with texture slots. bsdf_at evaluates it
// at a surface point, which gives a Bsdf.
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
// Alternatives of one kind are adjacent, so that a test for the kind compiles to one comparison of the variant's
// index.
using Bsdf = std::variant<DiffuseBsdf, RoughDiffuseBsdf, MetalBsdf, LayeredBsdf, RoughDielectricBsdf, DielectricBsdf,
                          ThinDielectricBsdf, SubsurfaceBsdf, SubsurfaceExitBsdf>;

/// Returns the BSDF of a material at a point, with its textures evaluated there. Subsurface scattering is replaced by
/// diffuse reflection, which scatters as much light.
Bsdf bsdf_at(const Material& material, const TextureSet& textures, const SurfacePoint& point);

/// Returns the mean free path of the light inside of the material, in meters, or null if this kind of material cannot
/// have subsurface scattering. It is black if the material has none.
const Rgb* mean_free_path(const Material& material);
Rgb* mean_free_path(Material& material);
/// Returns whether light is scattered below the material's surface.
bool has_subsurface(const Material& material);
/// Returns the BSDF of the surface of a solid, seen from outside. The material must have subsurface scattering.
SubsurfaceBsdf subsurface_at(const Material& material, const TextureSet& textures, const SurfacePoint& point);
/// Returns the BSDF of a point at which light leaves a solid. The material must have subsurface scattering.
SubsurfaceExitBsdf subsurface_exit_at(const Material& material, const TextureSet& textures, const SurfacePoint& point);
/// Returns the fraction of diffuse light from inside that the surface of a solid reflects back.
float internal_reflectance(const Material& material);

/// Returns the BSDF without the cosine; 0 for specular lobes.
inline Rgb eval(const Bsdf& bsdf, Vec3 wo, Vec3 wi, TransportMode mode = TransportMode::kRadiance) {
    return std::visit([&](const auto& b) { return b.eval(wo, wi, mode); }, bsdf);
}
/// Draws a direction wi; nothing where the surface absorbs the light. lobe and u are in [0, 1).
inline std::optional<BsdfSample> sample(const Bsdf& bsdf, Vec3 wo, float lobe, Vec2 u,
                                        TransportMode mode = TransportMode::kRadiance) {
    return std::visit([&](const auto& b) { return b.sample(wo, lobe, u, mode); }, bsdf);
}
/// Returns the density, by solid angle, with which sample draws wi; 0 for specular lobes.
inline float pdf(const Bsdf& bsdf, Vec3 wo, Vec3 wi, TransportMode mode = TransportMode::kRadiance) {
    return std::visit([&](const auto& b) { return b.pdf(wo, wi, mode); }, bsdf);
}

// These functions evaluate, sample and query a BSDF of a known type, as in a batch of surfaces.
template <typename BsdfType>
concept KnownBsdf = requires { BsdfType::kTransmissive; };
template <KnownBsdf BsdfType, typename Vec> auto eval(const BsdfType& bsdf, const Vec& wo, const Vec& wi) {
    return bsdf.eval(wo, wi, TransportMode::kRadiance);
}
template <KnownBsdf BsdfType, typename Vec> auto pdf(const BsdfType& bsdf, const Vec& wo, const Vec& wi) {
    return bsdf.pdf(wo, wi, TransportMode::kRadiance);
}
template <KnownBsdf BsdfType, typename T>
auto sample(const BsdfType& bsdf, const Vec3T<T>& wo, T lobe, const Vec2T<T>& u, TransportMode mode) {
    return bsdf.sample(wo, lobe, u, mode);
}
template <KnownBsdf BsdfType> constexpr bool is_transmissive(const BsdfType&) { return BsdfType::kTransmissive; }
template <KnownBsdf BsdfType> auto refraction_index(const BsdfType& bsdf) {
    if constexpr (BsdfType::kTransmissive)
        return bsdf.eta;
    else
        return 1.0f;
}

/// Returns whether the Bsdf has only delta lobes, which light sampling cannot find.
bool is_specular(const Bsdf& bsdf);
/// Returns whether the Bsdf is purely diffuse, smooth or rough.
inline bool is_diffuse(const Bsdf& bsdf) {
    return std::holds_alternative<DiffuseBsdf>(bsdf) || std::holds_alternative<RoughDiffuseBsdf>(bsdf);
}
/// Returns whether the Bsdf transmits light.
inline bool is_transmissive(const Bsdf& bsdf) {
    return std::holds_alternative<DielectricBsdf>(bsdf) || std::holds_alternative<RoughDielectricBsdf>(bsdf) ||
           std::holds_alternative<ThinDielectricBsdf>(bsdf);
}
/// Returns the index of refraction inside over outside where the surface refracts into an interior, and 1 elsewhere.
float refraction_index(const Bsdf& bsdf);
/// Returns the radiance that the material emits at a point toward w, in W/(m² sr). Only Emissive is not black.
Rgb emitted(const Material& material, const TextureSet& textures, const SurfacePoint& point, Vec3 w);
/// Returns the material as an emitter, or null where it is not Emissive or its radiance is black.
const Emissive* emitter(const Material& material);
/// Returns the texture slot of the material's main color.
const RgbSlot& texture_slot(const Material& material);
RgbSlot& texture_slot(Material& material);
/// Calls visit(texture) for each of the material's references to a texture, an index or −1.
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
        for (auto* slot :
             {&principled->metallic, &principled->roughness, &principled->clearcoat, &principled->clearcoat_roughness,
              &principled->subsurface})
            visit(slot->texture);
}
/// Returns the material's base color at the point for the albedo AOV: its albedo, reflectance or tint.
Rgb base_color(const Material& material, const TextureSet& textures, const SurfacePoint& point);

} // namespace duet
