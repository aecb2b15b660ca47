// Stage 5: which tiles of the picture a primitive may touch.
#pragma once

#include "raster/assemble.h"
#include "raster/sphere.h"

#include <cstdint>
#include <span>
#include <vector>

namespace duet::raster {

/// The picture cut into squares, row by row; those at the right and lower edges may be smaller.
struct TileGrid {
    static constexpr int kTileSize = 32;
    int width = 0, height = 0;

    int columns() const { return (width + kTileSize - 1) / kTileSize; }
    int rows() const { return (height + kTileSize - 1) / kTileSize; }
    std::size_t size() const { return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()); }
    PixelRect tile(std::size_t index) const;
};

/// For each tile a list of indices, all in one array.
class Bins {
public:
    /// Puts item i into each tile that bounds[i], cut to the picture, touches. Lists are in ascending order.
    Bins(const TileGrid& grid, const std::vector<PixelRect>& bounds);

    std::span<const std::uint32_t> tile(std::size_t index) const {
        return std::span(items_).subspan(first_[index], first_[index + 1] - first_[index]);
    }
    std::size_t memory_bytes() const {
        return items_.size() * sizeof(std::uint32_t) + first_.size() * sizeof(std::size_t);
    }

private:
    std::vector<std::size_t> first_;
    std::vector<std::uint32_t> items_;
};

Bins bin(const TileGrid& grid, const std::vector<SetupTriangle>& triangles, const std::vector<SampleOffset>& samples);
Bins bin(const TileGrid& grid, const std::vector<DrawSphere>& spheres);

} // namespace duet::raster
