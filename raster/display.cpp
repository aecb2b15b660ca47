#include "raster/display.h"

#include "raster/shade.h"

#include "common/image/srgb.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <cstring>

namespace duet::raster {
namespace {

Rgba8 encoded(const SrgbEncoder& encode, Rgb c) { return {encode(c.r), encode(c.g), encode(c.b), 255}; }

bool is_empty(const Geometry& geometry, std::size_t index) {
    return geometry.outlines.tile(index).empty() && geometry.fragments.tile(index).empty() &&
           (geometry.spheres.empty() || geometry.sphere_bins.tile(index).empty());
}

template <typename Pixel> void fill(const PixelRect& rect, const Pixel& pixel, Image<Pixel>& picture) {
    for (int y = rect.y0; y < rect.y1; ++y) std::fill_n(&picture(rect.x0, y), rect.width(), pixel);
}

/// A row of a tile is written whole, from the rows of eight of its blocks: lines of the cache are filled at once.
void copy_nearness(const DepthTile& tile, ImageFloat& picture) {
    const PixelRect& rect = tile.rect();
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; x += DepthTile::kBlock)
            std::memcpy(&picture(x, y), tile.nearness() + tile.place(x, y),
                        sizeof(float) * static_cast<std::size_t>(std::min(DepthTile::kBlock, rect.x1 - x)));
}

} // namespace

void display_tile(const PreparedData& data, const Settings& settings, const Geometry& geometry, const PassView& view,
                  const PixelRect& rect, std::size_t index, Image<Rgba8>& picture) {
    DepthTile depths;
    cover(geometry, view, view.samples.front(), rect, index, depths);
    const HitTile tile(depths, geometry, view);
    const SrgbEncoder& encoder = srgb_encoder();
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x)
            picture(x, y) = encoded(encoder, shade(data, settings, tile, x, y).radiance);
}

void keep_nearness(const Geometry& geometry, const PassView& view, const PixelRect& rect, std::size_t index,
                   ImageFloat& picture) {
    if (is_empty(geometry, index)) {
        fill(rect, 0.0f, picture);
        return;
    }
    DepthTile depths;
    cover(geometry, view, view.samples.front(), rect, index, depths);
    copy_nearness(depths, picture);
}

void encode(const ImageRgb& radiance, int threads, Image<Rgba8>& picture) {
    picture = Image<Rgba8>(radiance.width(), radiance.height());
    const SrgbEncoder& encoder = srgb_encoder();
    parallel_for(static_cast<std::size_t>(radiance.height()), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < radiance.width(); ++x) picture(x, y) = encoded(encoder, radiance(x, y));
    });
}

} // namespace duet::raster
