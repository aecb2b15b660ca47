// This file defines rough diffuse reflection (clay, plaster, the moon), which models facets that shadow each other.
#pragma once

#include "common/image/rgb.h"
#include "common/material/bsdf.h"

namespace duet {

/// RoughDiffuseBsdf is energy-preserving Oren-Nayar reflection on both sides of the surface (Portsmouth, Kutz and
/// Hill 2024, "EON: A practical energy-preserving rough diffuse BRDF"). Single scattering is Fujii's form of Oren and
/// Nayar's model. A reciprocal lobe adds the multiply scattered light, so that a white surface of any roughness
/// reflects all light. At roughness 0 it is Lambert's reflection.
struct RoughDiffuseBsdf {
    Rgb albedo;      ///< albedo of each facet, in [0, 1]
    float roughness; ///< in [0, 1]; Oren and Nayar's deviation of slopes is at most about roughness·π/2 radians

    /// Returns the BSDF without the cosine; black where wo and wi are on different sides.
    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// Draws wi cosine-distributed or uniform over wo's side. The uniform fraction grows with roughness and toward
    /// grazing wo.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    /// Returns the density, by solid angle, with which sample draws wi.
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// Returns the exact directional albedo, in [0, 1]: the fraction of uniform incident light that is reflected to a
    /// viewer at this angle.
    Rgb directional_albedo(float cosine) const;
};

} // namespace duet
