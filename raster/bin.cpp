#include "raster/bin.h"

#include <algorithm>
#include <numeric>

namespace duet::raster {
namespace {

template <typename Visit> void for_each_tile(const TileGrid& grid, const PixelRect& bounds, const Visit& visit) {
    const PixelRect r = intersect(bounds, {0, 0, grid.width, grid.height});
    if (r.empty()) return;
    const int last_row = (r.y1 - 1) / TileGrid::kTileSize, last_column = (r.x1 - 1) / TileGrid::kTileSize;
    for (int row = r.y0 / TileGrid::kTileSize; row <= last_row; ++row)
        for (int column = r.x0 / TileGrid::kTileSize; column <= last_column; ++column)
            visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns()) +
                  static_cast<std::size_t>(column));
}

/// The smallest rectangle around the pixels whose samples the triangle's bounding box holds.
PixelRect pixels_touched(const SetupTriangle& triangle, const std::vector<SampleOffset>& samples) {
    PixelRect all = pixels_within(triangle.corners, samples.front());
    for (const SampleOffset offset : samples) {
        const PixelRect r = pixels_within(triangle.corners, offset);
        all = {std::min(all.x0, r.x0), std::min(all.y0, r.y0), std::max(all.x1, r.x1), std::max(all.y1, r.y1)};
    }
    return all;
}

} // namespace

PixelRect TileGrid::tile(std::size_t index) const {
    const int column = static_cast<int>(index) % columns(), row = static_cast<int>(index) / columns();
    const PixelRect whole{column * kTileSize, row * kTileSize, (column + 1) * kTileSize, (row + 1) * kTileSize};
    return intersect(whole, {0, 0, width, height});
}

Bins::Bins(const TileGrid& grid, const std::vector<PixelRect>& bounds) : first_(grid.size() + 1, 0) {
    for (const PixelRect& r : bounds) for_each_tile(grid, r, [&](std::size_t tile) { ++first_[tile + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    items_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < bounds.size(); ++i)
        for_each_tile(grid, bounds[i], [&](std::size_t tile) { items_[next[tile]++] = static_cast<std::uint32_t>(i); });
}

Bins bin(const TileGrid& grid, const std::vector<SetupTriangle>& triangles, const std::vector<SampleOffset>& samples) {
    // A few samples' own extent bounds the rest: the outermost offsets in x and y.
    const auto [left, right] =
        std::minmax_element(samples.begin(), samples.end(), [](SampleOffset a, SampleOffset b) { return a.x < b.x; });
    const auto [top, bottom] =
        std::minmax_element(samples.begin(), samples.end(), [](SampleOffset a, SampleOffset b) { return a.y < b.y; });
    const std::vector<SampleOffset> outermost = {{left->x, top->y}, {right->x, bottom->y}};
    std::vector<PixelRect> bounds(triangles.size());
    std::transform(triangles.begin(), triangles.end(), bounds.begin(),
                   [&](const SetupTriangle& triangle) { return pixels_touched(triangle, outermost); });
    return Bins(grid, bounds);
}

Bins bin(const TileGrid& grid, const std::vector<DrawSphere>& spheres) {
    std::vector<PixelRect> bounds(spheres.size());
    std::transform(spheres.begin(), spheres.end(), bounds.begin(),
                   [](const DrawSphere& sphere) { return sphere.bounds; });
    return Bins(grid, bounds);
}

} // namespace duet::raster
