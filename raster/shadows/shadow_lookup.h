// Declares how the direct light's stage looks up shadows.
#pragma once

#include "raster/geometry/packet.h"

namespace duet::raster {

/// Looks up how much of a light the points of a batch of pixels see. Lights that lie together, such as the triangles of
/// a mesh that glows, are one source, of which a point sees one fraction.
class ShadowLookup {
public:
    static constexpr std::size_t kUnshadowed = static_cast<std::size_t>(-1);

    virtual ~ShadowLookup() = default;
    /// Returns the number of a light's source, or kUnshadowed. `light` is an index into Scene::lights.
    virtual std::size_t source(std::size_t light) const = 0;
    /// Returns whether visibility() is a noisy estimate, to be averaged over the blocks of 4 × 4 pixels whose estimates
    /// differ.
    virtual bool noisy(std::size_t source) const = 0;
    /// Returns the visible fraction, in [0, 1], of a source at points relative to the eye with unit normals on the
    /// viewer's side. The batch starts at column x of row y. The result is unspecified in lanes that `mask` leaves out.
    virtual Floats visibility(std::size_t source, const Vec3T<Floats>& p, const Vec3T<Floats>& n, int x, int y,
                              const xsimd::batch_bool<float>& mask) const = 0;
};

} // namespace duet::raster
