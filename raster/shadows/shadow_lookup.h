// Declares how the direct light's stage looks up shadows.
#pragma once

#include "raster/geometry/packet.h"

namespace duet::raster {

/// Looks up how much of a light the points of a batch of pixels see.
class ShadowLookup {
public:
    virtual ~ShadowLookup() = default;
    /// Returns whether the light, an index into Scene::lights, has shadows at all. Else visibility() is not called.
    virtual bool shadows(std::size_t light) const = 0;
    /// Returns whether visibility() is a noisy estimate, to be averaged over the blocks of 4 × 4 pixels whose estimates
    /// differ.
    virtual bool noisy(std::size_t light) const = 0;
    /// Returns the visible fraction, in [0, 1], of a light at points relative to the eye, whose unit normals are on the
    /// viewer's side. `light` is an index into Scene::lights. The batch starts at column x of row y. The result is
    /// unspecified in lanes that `mask` leaves out.
    virtual Floats visibility(std::size_t light, const Vec3T<Floats>& p, const Vec3T<Floats>& n, int x, int y,
                              const xsimd::batch_bool<float>& mask) const = 0;
};

} // namespace duet::raster
