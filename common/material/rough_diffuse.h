// Clay, plaster, the moon: diffuse reflection by facets that shade each other.
#pragma once

#include "common/image/rgb.h"
#include "common/material/bsdf.h"

namespace duet {

/// Energy-preserving Oren-Nayar (Portsmouth, Kutz and Hill 2024, «EON: A practical energy-preserving rough diffuse BRDF»),
/// on both sides of the surface: Fujii's form of Oren and Nayar's single reflection, and a reciprocal lobe for the light
/// of further ones, so that white reflects all, whatever the roughness. At roughness 0 it is Lambert's.
struct RoughDiffuseBsdf {
    Rgb albedo;      ///< of each facet, in [0, 1]
    float roughness; ///< in [0, 1]; Oren and Nayar's standard deviation of slopes is about roughness·π/2 radians at most

    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// Cosine-distributed or, the rougher and the more grazing the more often, uniform over wo's side.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// The part of light from everywhere that is sent to a viewer at this angle, exactly: in [0, 1].
    Rgb reflected(float cosine) const;
};

} // namespace duet
