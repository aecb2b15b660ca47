// Implements stage 5, binning, which finds the tiles that each primitive may overlap.
#pragma once

#include "raster/geometry/batch.h"
#include "raster/geometry/sphere.h"
#include "raster/geometry/tiles.h"

#include <cstdint>
#include <span>
#include <vector>

namespace duet::raster {

/// Stores a list of indices per tile, all in one array.
class Bins {
public:
    Bins() = default;
    /// Inserts item i into each tile that bounds[i] overlaps. The lists are in ascending order.
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

/// Bins the spheres by their bounds.
Bins bin(const TileGrid& grid, const std::vector<DrawSphere>& spheres);

/// Stores the segments of all batches that belong to each tile, in the order of the batches. Their items are
/// therefore in submission order, although the batches were sorted in parallel.
class TileLists {
public:
    struct Item {
        std::uint32_t batch = 0, first = 0, count = 0;
    };
    /// `segments` selects the list of each batch.
    void gather(const std::vector<Batch>& batches, std::vector<Segment> Batch::*segments, std::size_t tiles);

    std::span<const Item> tile(std::size_t index) const {
        return std::span(items_).subspan(first_[index], first_[index + 1] - first_[index]);
    }
    std::size_t memory_bytes() const { return items_.size() * sizeof(Item) + first_.size() * sizeof(std::size_t); }

private:
    std::vector<std::size_t> first_, next_;
    std::vector<Item> items_;
};

} // namespace duet::raster
