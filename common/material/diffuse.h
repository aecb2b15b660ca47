// Lambert's diffuse reflection, on both sides of the surface.
#pragma once

#include "common/material/bsdf.h"
#include "common/texture/texture.h"

namespace duet {

/// Reflects `albedo` of the light, equally to all directions of the side it came from.
struct DiffuseBsdf {
    Rgb albedo;

    /// albedo / π, where wo and wi are on one side.
    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// Cosine-distributed on wo's side; never empty for wo.z ≠ 0.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;
};

struct Diffuse {
    RgbSlot albedo{Rgb(0.8f)}; ///< each channel in [0, 1]

    DiffuseBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
};

} // namespace duet
