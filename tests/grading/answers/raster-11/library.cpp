// The library's edges (raster/geometry/setup.h), and its tiles (raster/visibility/depth_tile.h).
#include "raster/geometry/setup.h"
#include "raster/lessons/11-tiles-and-simd/lab.h"
#include "raster/visibility/depth_tile.h"

#include <memory>

namespace duet::lab {

Edge make_edge(GridPoint from, GridPoint to) {
    const raster::EdgeFunction edge({from.x, from.y}, {to.x, to.y});
    return {static_cast<int>(edge.a), static_cast<int>(edge.b), static_cast<int>(edge.at(128, 128) >> 8)};
}

std::vector<int> values_along_row(Edge edge, int x, int y, int count) {
    std::vector<int> values;
    for (int i = 0; i < count; ++i) values.push_back(edge.a * (x + i) + edge.b * y + edge.c);
    return values;
}

Tile test_tile(const Edges& edges, int x, int y, int size) {
    bool inside = true;
    for (const auto& [a, b, c] : edges) {
        const int value = a * x + b * y + c, right = (size - 1) * a, down = (size - 1) * b;
        if (value + std::max(right, 0) + std::max(down, 0) < 0) return Tile::kOutside;
        inside = inside && value + std::min(right, 0) + std::min(down, 0) >= 0;
    }
    return inside ? Tile::kInside : Tile::kPartial;
}

int mask_of_eight(const Edges& edges, int x, int y) {
    int mask = 0;
    for (int i = 0; i < 8; ++i) {
        int signs = 0;
        for (const auto& [a, b, c] : edges) signs |= a * (x + i) + b * y + c;
        mask |= (signs >= 0) << i;
    }
    return mask;
}

namespace {

/// This is the triangle itself, in front of an orthographic camera at the depth 1.
struct SourceTriangle : raster::UnclippedTriangles {
    raster::UnclippedTriangle triangle;
    raster::UnclippedTriangle unclipped(std::uint32_t) const override { return triangle; }
};

} // namespace

Image<int> cover(const std::array<GridPoint, 3>& corners, int width, int height) {
    const raster::Viewport viewport{width, height, 1e-6, true};
    const auto vertex = [](GridPoint p) { return raster::PixelVertex{p.x / 256.0, p.y / 256.0, 1, 1}; };
    SourceTriangle source;
    source.triangle = {vertex(corners[0]), vertex(corners[1]), vertex(corners[2])};
    const std::array<raster::FixedPoint, 3> grid{
        {{corners[0].x, corners[0].y}, {corners[1].x, corners[1].y}, {corners[2].x, corners[2].y}}};
    const raster::DrawTriangle triangle = raster::set_up(source.triangle, grid, 0, false, viewport);
    Image<int> image(width, height, 0);
    const auto tile = std::make_unique<raster::DepthTile>();
    const raster::TileGrid tiles{{0, 0, width, height}};
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const raster::PixelRect rect = tiles.tile(i);
        tile->reset(rect, {}, viewport);
        tile->draw(triangle, source);
        for (int y = rect.y0; y < rect.y1; ++y)
            for (int x = rect.x0; x < rect.x1; ++x) image(x, y) = tile->id(x, y) == 0;
    }
    return image;
}

} // namespace duet::lab
