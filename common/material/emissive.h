// This file defines the emissive material: a surface that emits light and reflects diffusely (with a black albedo by
// default).
#pragma once

#include "common/material/diffuse.h"

namespace duet {

/// Describes a surface that emits light, and may also reflect some diffusely.
struct Emissive {
    Rgb radiance{1.0f};        ///< W/(m² sr), equal in all directions of the front side; zero on the back
    bool two_sided = false;    ///< whether the back emits too
    RgbSlot albedo{Rgb(0.0f)}; ///< diffuse reflectance of both sides
    /// This is the index into TextureSet::textures of a texture that multiplies the radiance, or −1 for none.
    std::int32_t radiance_texture = -1;

    /// Returns the BSDF of the light that the surface reflects at a point.
    DiffuseBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
    /// Returns the radiance that the point emits toward w (of any length), in W/(m² sr).
    Rgb emitted(const TextureSet& textures, const SurfacePoint& point, Vec3 w) const {
        if (!two_sided && !(dot(point.ng, w) > 0)) return Rgb();
        return evaluate(textures, RgbSlot{radiance, radiance_texture}, point);
    }
};

} // namespace duet
