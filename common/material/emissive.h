// A surface that emits light, over a diffuse reflection (black by default).
#pragma once

#include "common/material/diffuse.h"

namespace duet {

struct Emissive {
    Rgb radiance{1.0f};        ///< W/(m² sr), equal in all directions of the front side; zero on the back
    bool two_sided = false;    ///< emits on the back, too
    RgbSlot albedo{Rgb(0.0f)}; ///< diffuse reflectance of both sides

    DiffuseBsdf at(const TextureSet& textures, const SurfacePoint& point) const;
    /// Radiance towards w (any length), ng the geometric normal of the front.
    Rgb emitted(Vec3 ng, Vec3 w) const { return two_sided || dot(ng, w) > 0 ? radiance : Rgb(); }
};

} // namespace duet
