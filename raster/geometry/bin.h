// Stage 5: which tiles of the picture a primitive may touch.
#pragma once

#include "raster/geometry/batch.h"
#include "raster/geometry/sphere.h"
#include "raster/geometry/tiles.h"

#include <cstdint>
#include <span>
#include <vector>

namespace duet::raster {

/// For each tile a list of indices, all in one array.
class Bins {
public:
    Bins() = default;
    /// Puts item i into each tile that bounds[i] touches. Lists are in ascending order.
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

Bins bin(const TileGrid& grid, const std::vector<DrawSphere>& spheres);

/// For each tile the segments of the batches that belong to it, in the order of the batches: so what they refer to is in
/// the order of submission, though batches were sorted side by side.
class TileLists {
public:
    struct Item {
        std::uint32_t batch = 0, first = 0, count = 0;
    };
    /// `segments`: which of a batch's lists.
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
