#include "raster/geometry/batch.h"

namespace duet::raster {

void Batch::clear() {
    triangles.clear();
    order.clear();
    triangle_segments.clear();
    patches.clear();
    patch_order.clear();
    patch_segments.clear();
    fragments.clear();
    fragment_segments.clear();
    culled = {};
}

std::size_t Batch::memory_bytes() const {
    const auto bytes = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
    return bytes(triangles) + bytes(order) + bytes(triangle_segments) + bytes(patches) + bytes(patch_order) +
           bytes(patch_segments) + bytes(fragments) + bytes(fragment_segments);
}

// This is a counting sort that touches only the counters of tiles with items, so its cost is linear in the items.
template <typename Item, typename TileOf, typename Place>
void TileSorter::distribute(std::span<const Item> items, const TileOf& tile_of, std::vector<Segment>& segments,
                            const Place& place) {
    for (const Item& item : items)
        if (counts_[tile_of(item)]++ == 0) segments.push_back({tile_of(item), 0, 0});
    std::uint32_t first = 0;
    for (Segment& segment : segments) {
        segment.first = first;
        segment.count = counts_[segment.tile];
        counts_[segment.tile] = first;
        first += segment.count;
    }
    for (const Item& item : items) place(counts_[tile_of(item)]++, item);
    for (const Segment& segment : segments) counts_[segment.tile] = 0;
}

void TileSorter::sort(const std::vector<Touch>& touches, std::vector<Segment>& segments,
                      std::vector<std::uint32_t>& order) {
    order.resize(touches.size());
    distribute(
        std::span<const Touch>(touches), [](const Touch& touch) { return touch.tile; }, segments,
        [&](std::uint32_t i, const Touch& touch) { order[i] = touch.item; });
}

void TileSorter::sort(Batch& batch, const std::vector<Touch>& triangles, const std::vector<Touch>& patches,
                      std::size_t tiles) {
    if (counts_.size() < tiles) counts_.resize(tiles, 0);
    sort(triangles, batch.triangle_segments, batch.order);
    sort(patches, batch.patch_segments, batch.patch_order);
    unsorted_.swap(batch.fragments);
    batch.fragments.resize(unsorted_.size());
    distribute(
        std::span<const Fragment>(unsorted_), [](const Fragment& f) -> std::uint32_t { return f.tile; },
        batch.fragment_segments, [&](std::uint32_t i, const Fragment& f) { batch.fragments[i] = f; });
    unsorted_.clear();
}

} // namespace duet::raster
