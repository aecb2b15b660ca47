// Frosted glass: a rough boundary between two dielectrics.
#pragma once

#include "common/image/rgb.h"
#include "common/material/bsdf.h"

namespace duet {

/// Reflection and refraction by GGX microfacets (Walter et al. 2007, «Microfacet Models for Refraction through Rough
/// Surfaces»), each a smooth boundary; visible normals sampled (Heitz 2018). +z is the outside. What meets further microfacets
/// is not lost: RoughGlassEnergy.
struct RoughDielectricBsdf {
    float eta;   ///< index of refraction inside over outside, not 1
    Rgb tint;    ///< transmitted light is multiplied by it at each crossing
    float alpha; ///< GGX width: roughness², at least Dielectric::kSmoothAlpha

    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// Chooses reflection or refraction at a visible microfacet, or several reflections.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;
};

} // namespace duet
