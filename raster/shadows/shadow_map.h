// This header declares shadow maps (Williams 1978, "Casting Curved Shadows on Curved Surfaces").
#pragma once

#include "common/image/image.h"
#include "raster/raster_scene.h"

namespace duet::raster {

/// Stores the depths that a light sees through one camera. Each is sampled at its texel's center, as exactly as in any
/// rendered image.
class ShadowMap {
public:
    /// Renders the depths of all objects but `excluded`, or of all if it is kNoObject, into side × side texels.
    ShadowMap(const RasterSceneData& data, const Camera& camera, int side, int threads, std::uint32_t excluded);

    static constexpr double kMargin = 2.5; ///< texels that a lookup needs around its position

    const Pinhole& view() const { return view_; }
    bool orthographic() const { return orthographic_; }
    int side() const { return reversed_depth_.width(); }
    /// Returns the reversed depths, near / depth, at the texels' centers; 0 where nothing is visible.
    const ImageFloat& reversed_depth() const { return reversed_depth_; }
    double near() const { return view_.near; }
    /// Returns whether alpha-blended casters are dithered over 4 × 4 texels (raster/visibility/depth_image.h).
    bool dithered() const { return dithered_; }

private:
    Pinhole view_;
    bool orthographic_, dithered_;
    /// Stores near / depth; 0 where nothing is visible. For a plane this is linear in texel coordinates in a
    /// perspective view; in an orthographic view the depth itself is.
    ImageFloat reversed_depth_;
};

} // namespace duet::raster
