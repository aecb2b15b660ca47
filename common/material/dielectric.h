// Glass, water: a smooth boundary between two dielectrics, which reflects and refracts.
#pragma once

#include "common/material/bsdf.h"
#include "common/material/rough_dielectric.h"
#include "common/material/thin_dielectric.h"
#include "common/texture/texture.h"

#include <cmath>

namespace duet {

/// Specular reflection and refraction by Fresnel's equations and Snell's law. +z is the outside.
struct DielectricBsdf {
    float eta; ///< index of refraction inside over outside
    Rgb tint;  ///< transmitted light is multiplied by it at each crossing

    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// Chooses reflection (lobe < F) or refraction; at total reflection there is only the one.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;
};

/// Whether a boundary of this relative index bends light so little that its microfacets do not matter: they would be
/// found from the difference of two directions that hardly differ.
inline bool refracts_alike(float eta) { return std::abs(eta - 1) <= 1e-3f; }

struct Dielectric {
    float ior = 1.5f; ///< inside over outside, in [1, 4]
    RgbSlot tint{Rgb(1.0f)};
    ScalarSlot roughness{0};     ///< perceptual; GGX alpha = roughness²; below kSmoothAlpha smooth
    bool thin = false;           ///< a sheet of its own: ThinDielectricBsdf, always smooth
    Rgb absorption{0.0f};        ///< inside, of the part of the light that is left: a metre (Beer and Lambert)
    int priority = 0;            ///< where insides overlap the one of the highest fills the place; 0: only by itself

    static constexpr float kSmoothAlpha = 1e-4f;

    bool smooth() const { return roughness.constant() && sqr(roughness.value) < kSmoothAlpha; }
    bool has_inside() const { return !thin && (!is_black(absorption) || priority > 0); }
    DielectricBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
    ThinDielectricBsdf thin_at(const TextureSet& textures, const SurfacePoint& point) const;
    RoughDielectricBsdf rough_at(const TextureSet& textures, const SurfacePoint& point) const;
};

} // namespace duet
