#include "raster/output/alpha_depth.h"

#include "raster/output/display_tile.h"
#include "raster/visibility/hit_lists.h"

#include "common/sampling/hash.h"

namespace duet::raster {

float dither(int x, int y) {
    const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y), odd = column ^ row;
    const std::uint32_t rank = (odd & 1) << 3 | (row & 1) << 2 | (odd & 2) | (row & 2) >> 1;
    return unit_float(rank << 28 | high_bits(hash_combine(column, row)) >> 4);
}

namespace {

/// Returns a tile whose hits lie at the given reversed depths. Only their distances are set, because no object is
/// needed.
HitTile rays_to(const ImageFloat& reversed_depth, const Geometry& geometry, const PassView& view, SampleOffset offset,
                const PixelRect& rect) {
    DepthTile nothing;
    nothing.reset(rect, offset, view.viewport);
    nothing.clear_undrawn();
    HitTile tile(nothing, geometry, view);
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x) {
            if (!(reversed_depth(x, y) > 0)) continue;
            const double depth = view.pinhole.near / static_cast<double>(reversed_depth(x, y));
            tile.exchange(x, y, {.t = static_cast<float>(depth * tile.distance_per_depth(x, y))});
        }
    return tile;
}

} // namespace

void render_alpha_depth_tile(const RasterSceneData& data, const Geometry& geometry, const Geometry& layers,
                             const PassView& view, const PixelRect& rect, std::size_t index, ImageFloat& image) {
    render_depth_tile(geometry, view, rect, index, image);
    if (!overlaps_tile(layers, index)) return;
    const SampleOffset offset = view.samples.front();
    HitTile tile = rays_to(image, geometry, view, offset, rect);
    HitLists lists(layers, view, offset, index, tile);
    const auto by_threshold = [](int x, int y, float left) { return 1 - left > dither(x, y); };
    lists.for_each_blocking_hit(data.scene, by_threshold, [&](int x, int y, const Hit& hit) {
        tile.exchange(x, y, hit);
        image(x, y) = tile.reversed_depth(x, y);
    });
}

} // namespace duet::raster
