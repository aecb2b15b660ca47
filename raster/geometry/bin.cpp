#include "raster/geometry/bin.h"

#include <algorithm>
#include <numeric>

namespace duet::raster {

Bins::Bins(const TileGrid& grid, const std::vector<PixelRect>& bounds) : first_(grid.size() + 1, 0) {
    for (const PixelRect& r : bounds) grid.for_each(r, [&](std::size_t tile) { ++first_[tile + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    items_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < bounds.size(); ++i)
        grid.for_each(bounds[i], [&](std::size_t tile) { items_[next[tile]++] = static_cast<std::uint32_t>(i); });
}

Bins bin(const TileGrid& grid, const std::vector<DrawSphere>& spheres) {
    std::vector<PixelRect> bounds(spheres.size());
    std::transform(spheres.begin(), spheres.end(), bounds.begin(),
                   [](const DrawSphere& sphere) { return sphere.bounds; });
    return Bins(grid, bounds);
}

void TileLists::gather(const std::vector<Batch>& batches, std::vector<Segment> Batch::*segments, std::size_t tiles) {
    first_.assign(tiles + 1, 0);
    for (const Batch& batch : batches)
        for (const Segment& segment : batch.*segments) ++first_[segment.tile + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    items_.resize(first_.back());
    next_.assign(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < batches.size(); ++i)
        for (const Segment& segment : batches[i].*segments)
            items_[next_[segment.tile]++] = {i, segment.first, segment.count};
}

} // namespace duet::raster
