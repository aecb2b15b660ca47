// Declares the interface by which direct lighting finds how much of a light is visible.
#pragma once

#include "raster/geometry/packet.h"

namespace duet::raster {

/// Returns the visible fraction of a light at the points of a batch of pixels. Lights that lie together, such as the
/// triangles of a mesh that glows, form one source with one visible fraction.
class LightVisibility {
public:
    static constexpr std::size_t kUnshadowed = static_cast<std::size_t>(-1);

    virtual ~LightVisibility() = default;
    /// Returns the index of a light's source, or kUnshadowed. `light` is an argument of RasterSceneData::light().
    virtual std::size_t source(std::size_t light) const = 0;
    /// Returns whether visibility() is a noisy estimate. If so, it must be averaged over blocks of 4 × 4 pixels, whose
    /// estimates differ.
    virtual bool noisy(std::size_t source) const = 0;
    /// Returns the visible fraction, in [0, 1], of a source at points relative to the eye with unit normals on the
    /// viewer's side. The batch starts at column x of row y. The result is unspecified in lanes that `mask` leaves out.
    virtual Floats visibility(std::size_t source, const Vec3T<Floats>& p, const Vec3T<Floats>& n, int x, int y,
                              const xsimd::batch_bool<float>& mask) const = 0;
};

} // namespace duet::raster
