// Ground-truth ambient occlusion (GTAO): how much of the environment the surfaces in the image hide from each pixel
// (Jimenez et al. 2016, "Practical Realtime Strategies for Accurate Indirect Occlusion", §4). Horizons are searched
// at half resolution, averaged over 4 × 4 neighbors on the same surface, and upsampled along depths and normals.
#pragma once

#include "raster/gbuffer/gbuffer.h"

namespace duet::raster {

/// Describes which part of the cosine-weighted hemisphere over a point is open to the environment.
template <typename T> struct SkyVisibility {
    T visible = T(1); ///< open fraction, in [0, 1]
    /// ∫ w cos dw / π over the hidden directions: their mean direction, weighted by how much of the light they block.
    /// It is 2/3 of the normal if everything is hidden.
    Vec3T<T> hidden{T(0), T(0), T(0)};
};

/// Holds the occlusion of a G-buffer, at half resolution. Its memory is reused from frame to frame.
class GtaoImage {
public:
    /// Searches occluders up to `radius` meters away. The G-buffer must outlive this object's use.
    void compute(const GBuffer& gbuffer, float radius, int threads);

    /// Returns the visibility of a batch of the G-buffer's pixels.
    SkyVisibility<Floats> at(int x, int y) const;

    static constexpr int kSteps = 10; ///< depths read on each side of a pixel

private:
    struct Planes {
        PlaneFloat visible;
        Planes3 hidden;
    };
    void search_row(int y, float radius);
    void filter_row(int y);
    void reset(int width, int height);

    const GBuffer* gbuffer_ = nullptr;
    PlaneFloat depth_;      ///< reversed depth of every second pixel of every second row
    Planes3 normal_;        ///< likewise
    Planes found_, smooth_; ///< before and after averaging
};

} // namespace duet::raster
