// This file defines the BSDF of rough glass: a rough boundary between two dielectrics.
#pragma once

#include "common/image/rgb.h"
#include "common/material/bsdf.h"

namespace duet {

/// Reflects and refracts at GGX microfacets, each a smooth boundary (Walter et al. 2007, "Microfacet Models for
/// Refraction through Rough Surfaces"), sampled by visible normals (Heitz 2018). +z points to the outside.
/// RoughGlassEnergy compensates the energy of multiple scattering.
struct RoughDielectricBsdf {
    float eta;   ///< index of refraction inside over outside, not 1
    Rgb tint;    ///< factor of transmitted light at each crossing
    float alpha; ///< GGX width: roughness², at least Dielectric::kSmoothAlpha

    /// Returns the BSDF without the cosine, for reflection and for refraction.
    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// Draws wi: `lobe` in [0, 1) chooses among reflection and refraction at a visible microfacet, and multiple
    /// scattering.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    /// Returns the density, by solid angle, with which sample draws wi.
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;
};

} // namespace duet
