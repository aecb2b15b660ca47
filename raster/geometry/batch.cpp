#include "raster/geometry/batch.h"

namespace duet::raster {

void Batch::clear() {
    triangles.clear();
    order.clear();
    triangle_segments.clear();
    coverage_masks.clear();
    mask_order.clear();
    mask_segments.clear();
    fragments.clear();
    fragment_segments.clear();
    culled = {};
}

std::size_t Batch::memory_bytes() const {
    const auto bytes = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
    return bytes(triangles) + bytes(order) + bytes(triangle_segments) + bytes(coverage_masks) + bytes(mask_order) +
           bytes(mask_segments) + bytes(fragments) + bytes(fragment_segments);
}

// Implements a counting sort that visits only the counters of tiles with items, so its cost is linear in the items.
template <typename Item, typename TileOf, typename Put>
void TileSorter::distribute(std::span<const Item> items, const TileOf& tile_of, std::vector<Segment>& segments,
                            const Put& put) {
    for (const Item& item : items)
        if (counts_[tile_of(item)]++ == 0) segments.push_back({tile_of(item), 0, 0});
    std::uint32_t first = 0;
    for (Segment& segment : segments) {
        segment.first = first;
        segment.count = counts_[segment.tile];
        counts_[segment.tile] = first;
        first += segment.count;
    }
    for (const Item& item : items) put(counts_[tile_of(item)]++, item);
    for (const Segment& segment : segments) counts_[segment.tile] = 0;
}

void TileSorter::sort(const std::vector<TileOverlap>& overlaps, std::vector<Segment>& segments,
                      std::vector<std::uint32_t>& order) {
    order.resize(overlaps.size());
    distribute(
        std::span<const TileOverlap>(overlaps), [](const TileOverlap& overlap) { return overlap.tile; }, segments,
        [&](std::uint32_t i, const TileOverlap& overlap) { order[i] = overlap.item; });
}

void TileSorter::sort(Batch& batch, const std::vector<TileOverlap>& triangles,
                      const std::vector<TileOverlap>& coverage_masks, std::size_t tiles) {
    if (counts_.size() < tiles) counts_.resize(tiles, 0);
    sort(triangles, batch.triangle_segments, batch.order);
    sort(coverage_masks, batch.mask_segments, batch.mask_order);
    unsorted_.swap(batch.fragments);
    batch.fragments.resize(unsorted_.size());
    distribute(
        std::span<const Fragment>(unsorted_), [](const Fragment& f) -> std::uint32_t { return f.tile; },
        batch.fragment_segments, [&](std::uint32_t i, const Fragment& f) { batch.fragments[i] = f; });
    unsorted_.clear();
}

} // namespace duet::raster
