#include "raster/visibility/rasterize_tile.h"

namespace duet::raster {
namespace {

void draw(const DrawSphere& sphere, const PassView& view, DepthTile& tile) {
    constexpr int kLanes = static_cast<int>(Doubles::size);
    const PixelRect r = intersect(tile.rect(), sphere.bounds);
    alignas(64) std::array<double, Doubles::size> reversed_depth;
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; x += kLanes) {
            const Vec2d first = tile.offset().position(x, y);
            const CameraRays rays(view.pinhole, Doubles(first.x) + kLanesAsDoubles, Doubles(first.y));
            const Doubles t = sphere.intersect(rays);
            (rays.t_min / t).store_aligned(reversed_depth.data()); // 0 on a miss
            for (int i = 0; i < std::min(kLanes, r.x1 - x); ++i)
                if (const double n = reversed_depth[static_cast<std::size_t>(i)]; n > 0)
                    tile.draw(x + i, y, sphere.id, to_stored_depth(n));
        }
}

/// Draws a tile's items of all batches in order, and prefetches the next ones.
template <typename Item, typename Draw>
void draw_all(const Geometry& geometry, std::span<const TileLists::Item> lists, std::vector<Item> Batch::*items,
              std::vector<std::uint32_t> Batch::*order, const Draw& draw_one) {
    constexpr std::uint32_t kAhead = 8; // items between a prefetch and its use
    const auto item = [&](const TileLists::Item& list, std::uint32_t k) -> const Item& {
        const Batch& batch = geometry.batches[list.batch];
        return (batch.*items)[(batch.*order)[list.first + k]];
    };
    for (std::size_t i = 0; i < lists.size(); ++i) {
        if (i == 0)
            for (std::uint32_t k = 0; k < std::min(kAhead, lists[i].count); ++k) prefetch(&item(lists[i], k));
        if (i + 1 < lists.size())
            for (std::uint32_t k = 0; k < std::min(kAhead, lists[i + 1].count); ++k) prefetch(&item(lists[i + 1], k));
        for (std::uint32_t k = 0; k < lists[i].count; ++k) {
            if (k + kAhead < lists[i].count) prefetch(&item(lists[i], k + kAhead));
            draw_one(item(lists[i], k));
        }
    }
}

} // namespace

void rasterize_drawn_blocks(const Geometry& geometry, const PassView& view, SampleOffset offset, const PixelRect& rect,
                            std::size_t index, DepthTile& tile) {
    tile.reset(rect, offset, view.viewport);
    draw_all(geometry, geometry.triangle_lists.tile(index), &Batch::triangles, &Batch::order,
             [&](const DrawTriangle& triangle) { tile.draw(triangle, geometry.triangles); });
    draw_all(geometry, geometry.mask_lists.tile(index), &Batch::coverage_masks, &Batch::mask_order,
             [&](const CoverageMask& mask) { tile.draw(mask); });
    const auto fragments = [&](const TileLists::Item& item) {
        return std::span(geometry.batches[item.batch].fragments).subspan(item.first, item.count);
    };
    const std::span<const TileLists::Item> lists = geometry.fragment_lists.tile(index);
    for (std::size_t i = 0; i < lists.size(); ++i) {
        if (i + 1 < lists.size()) prefetch(fragments(lists[i + 1]).data());
        tile.draw(fragments(lists[i]));
    }
    for (const std::uint32_t i : geometry.sphere_bins.tile(index)) draw(geometry.spheres[i], view, tile);
}

void rasterize_tile(const Geometry& geometry, const PassView& view, SampleOffset offset, const PixelRect& rect,
                    std::size_t index, DepthTile& tile) {
    rasterize_drawn_blocks(geometry, view, offset, rect, index, tile);
    tile.clear_undrawn();
}

} // namespace duet::raster
