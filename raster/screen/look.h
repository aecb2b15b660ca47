// A look at the whole picture ahead of its shading, a sample at each pixel's centre, for effects that look around in it.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/geometry/tiles.h"
#include "raster/screen/screen.h"
#include "raster/visibility/cover.h"

#include <memory>

namespace duet {
struct Control;
}

namespace duet::raster {

/// What a first look at the picture, without reflections in itself, makes of the centre of each pixel.
class FirstLookPicture {
public:
    FirstLookPicture(int width, int height)
        : radiance_(width, height), keys_(width, height, 0), objects_(width, height, kNoObject), lamps_(width, height, 0) {}
    /// Begins as another.
    explicit FirstLookPicture(const Screen::FirstLook& look);

    /// `key`: of the hit, or 0 where it is to be shaded again.
    void set(const PreparedData& data, int x, int y, const Hit& hit, Rgb radiance, std::uint32_t key);
    Screen::FirstLook finish() &&;

    /// Of what a pixel sees: 0 of what looks around in the picture, and of nothing.
    static std::uint32_t key(const Scene& scene, const Hit& hit);

private:
    ImageRgb radiance_;
    Image<std::uint32_t> keys_, objects_;
    Image<std::uint8_t> lamps_;
};

/// What the first look made of a pixel, where all of the pixel is shaded at its centre and sees what that does: the same
/// as shading it again. Null where it would be another.
const Rgb* seen_before(const PreparedData& data, const Settings& settings, const HitTile& tile, int x, int y);

/// What the pass sees at the pixels' centres, wherever its samples are, if an effect needs it; else null. Stopped by
/// `control` it is unfinished.
std::unique_ptr<Screen> look_at_screen(const PreparedData& data, const Settings& settings, const TileGrid& grid, const PassView& pass,
                                       const Control& control);

} // namespace duet::raster
