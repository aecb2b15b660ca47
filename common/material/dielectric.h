// This file defines the dielectric material (glass, water) and its smooth BSDF.
#pragma once

#include "common/material/bsdf.h"
#include "common/material/rough_dielectric.h"
#include "common/material/thin_dielectric.h"
#include "common/texture/texture.h"

#include <cmath>

namespace duet {

/// Reflects and refracts specularly by Fresnel's equations and Snell's law. +z points to the outside.
struct DielectricBsdf {
    float eta; ///< index of refraction inside over outside
    Rgb tint;  ///< factor of transmitted light at each crossing

    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// Chooses reflection (lobe < F) or refraction. At total reflection it always reflects. The sample is empty where
    /// wo.z is 0.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;
};

/// Returns whether a boundary of this relative index bends light so little that its microfacets do not matter. They
/// would be computed from the difference of two nearly equal directions, so such boundaries are treated as smooth.
inline bool refracts_alike(float eta) { return std::abs(eta - 1) <= 1e-3f; }

struct Dielectric {
    float ior = 1.5f; ///< index of refraction inside over outside, in [1, 4]
    RgbSlot tint{Rgb(1.0f)};
    ScalarSlot roughness{0};     ///< perceptual; GGX alpha = roughness²; smooth where alpha is below kSmoothAlpha
    bool thin = false;           ///< a thin sheet, ThinDielectricBsdf, which is always smooth
    Rgb absorption{0.0f};        ///< absorption coefficient of the interior, 1/m (Beer-Lambert law)
    /// Where dielectrics overlap, the one of the highest priority determines the medium. With priority 0 the
    /// dielectric ignores overlaps and always refracts as if it were surrounded by the outside.
    int priority = 0;

    static constexpr float kSmoothAlpha = 1e-4f;

    bool smooth() const { return roughness.constant() && sqr(roughness.value) < kSmoothAlpha; }
    bool has_inside() const { return !thin && (!is_black(absorption) || priority > 0); }
    DielectricBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
    ThinDielectricBsdf thin_at(const TextureSet& textures, const SurfacePoint& point) const;
    RoughDielectricBsdf rough_at(const TextureSet& textures, const SurfacePoint& point) const;
};

} // namespace duet
