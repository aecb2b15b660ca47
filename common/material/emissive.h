// A surface that emits light, over a diffuse reflection (black by default).
#pragma once

#include "common/material/diffuse.h"

namespace duet {

struct Emissive {
    Rgb radiance{1.0f};        ///< W/(m² sr), equal in all directions of the front side; zero on the back
    bool two_sided = false;    ///< emits on the back, too
    RgbSlot albedo{Rgb(0.0f)}; ///< diffuse reflectance of both sides
    std::int32_t radiance_texture = -1; ///< index into TextureSet::textures: multiplies the radiance; −1: none

    DiffuseBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
    /// Radiance of the point towards w (any length).
    Rgb emitted(const TextureSet& textures, const SurfacePoint& point, Vec3 w) const {
        if (!two_sided && !(dot(point.ng, w) > 0)) return Rgb();
        return evaluate(textures, RgbSlot{radiance, radiance_texture}, point);
    }
};

} // namespace duet
