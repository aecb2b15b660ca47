#include "raster/visibility/depth_image.h"

#include "raster/visibility/hit_lists.h"
#include "raster/visibility/image_blocks.h"
#include "raster/visibility/packet_primitives.h"
#include "raster/visibility/rasterize_tile.h"

#include "common/system/parallel.h"

namespace duet::raster {
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

void copy_depth(const DepthTile& tile, ImageFloat& image) {
    static constexpr std::array<float, kBlock> kNothing{};
    const PixelRect& rect = tile.rect();
    for (int y = rect.y0; y < rect.y1; y += kBlock) {
        const std::size_t first = tile.sample_index(rect.x0, y) / kBlockSamples;
        const auto row_of = [&](std::size_t column, std::size_t row) {
            return tile.drawn(first + column) ? tile.reversed_depth() + (first + column) * kBlockSamples + row * kBlock
                                              : kNothing.data();
        };
        copy_blocks(rect, y, row_of, image);
    }
    finish_streams();
}

/// Stores the first alpha-masked or alpha-blended surface of each pixel that stops its light.
void add_layers(const RasterSceneData& data, const Geometry& geometry, const Geometry& layers, const PassView& view,
                const PixelRect& rect, std::size_t index, ImageFloat& image) {
    const SampleOffset offset = view.samples.front();
    HitTile tile = rays_to(image, geometry, view, offset, rect);
    HitLists lists(layers, view, offset, index, tile);
    lists.for_each_blocking_hit(data.scene, blocks_in_dither, [&](int x, int y, const Hit& hit) {
        tile.exchange(x, y, hit);
        image(x, y) = tile.reversed_depth(x, y);
    });
}

} // namespace

void render_depth_tile(const RasterSceneData& data, const Geometry& geometry, const Geometry* layers,
                       const PassView& view, const PixelRect& rect, std::size_t index, ImageFloat& image) {
    if (geometry.overlaps_tile(index)) {
        DepthTile depths;
        rasterize_drawn_blocks(geometry, view, view.samples.front(), rect, index, depths);
        copy_depth(depths, image);
    } else {
        fill(rect, 0.0f, image);
    }
    if (layers != nullptr && layers->overlaps_tile(index))
        add_layers(data, geometry, *layers, view, rect, index, image);
}

ImageFloat render_depth(const RasterSceneData& data, const View& view, int threads, std::uint32_t excluded) {
    RasterSettings settings;
    settings.threads = threads;
    const PassView pass = center_view(view);
    const auto includes = [&](std::uint32_t object) { return object != excluded; };
    const TileGrid grid{{0, 0, view.width, view.height}};
    const auto geometry = data.geometries->take(), layers = data.geometries->take();
    process_geometry(data, grid, pass, settings, *geometry, includes);
    if (data.has_layers()) process_layers(data, grid, pass, settings, *layers, includes);
    ImageFloat image(view.width, view.height);
    parallel_for(grid.size(), threads, [&](std::size_t i) {
        render_depth_tile(data, *geometry, data.has_layers() ? &*layers : nullptr, pass, grid.tile(i), i, image);
    });
    return image;
}

} // namespace duet::raster
