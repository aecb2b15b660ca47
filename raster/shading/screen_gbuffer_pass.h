// This header declares the G-buffer pass and the color prepass, with a sample at each pixel's center, for
// screen-space effects.
#pragma once

#include "raster/gbuffer/screen_gbuffer.h"
#include "raster/geometry/geometry.h"
#include "raster/geometry/tiles.h"
#include "raster/visibility/hit_tile.h"

#include <memory>

namespace duet {
struct Control;
}

namespace duet::raster {

/// Accumulates the color prepass, without screen-space reflections, at the center of each pixel.
class ColorPrepassImage {
public:
    ColorPrepassImage(int width, int height)
        : radiance_(width, height), keys_(width, height, 0), objects_(width, height, kNoObject),
          light_mask_(width, height, 0) {}
    /// Starts from a copy of another prepass.
    explicit ColorPrepassImage(const ScreenGBuffer::ColorPrepass& prepass);

    /// `key` is the hit's key, or 0 if the pixel must be shaded again.
    void set(const RasterSceneData& data, int x, int y, const Hit& hit, Rgb radiance, std::uint32_t key);
    ScreenGBuffer::ColorPrepass finish() &&;

    /// Returns the key of a hit. It is 0 for materials whose shading samples the image, and for the background.
    static std::uint32_t key(const Scene& scene, const Hit& hit);

private:
    ImageRgb radiance_;
    Image<std::uint32_t> keys_, objects_;
    Image<std::uint8_t> light_mask_;
};

/// Returns the prepass radiance of a pixel if all of the pixel is shaded at its center and the center's key matches.
/// It equals shading the pixel again. Otherwise returns null.
const Rgb* prepass_radiance(const RasterSceneData& data, const RasterSettings& settings, const HitTile& tile, int x,
                            int y);

/// Renders the G-buffer at the pixels' centers, independent of the pass's sample positions, if an effect needs it;
/// else returns null. The result is incomplete if `control` stops it.
std::unique_ptr<ScreenGBuffer> render_screen_gbuffer(const RasterSceneData& data, const RasterSettings& settings,
                                                     const TileGrid& grid, const PassView& pass,
                                                     const Control& control);

} // namespace duet::raster
