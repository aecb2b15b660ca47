// Implements stage 5, binning, which finds the tiles that each primitive may overlap.
#pragma once

#include "raster/geometry/batch.h"

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace duet::raster {

/// Stores a list of items per tile, all in one array.
template <typename Item> class ItemsByTile {
public:
    /// Replaces the lists. visit(put) must call put(tile, item) for all items. It is called twice, and must do the same
    /// both times; a list is in the order of these calls.
    template <typename Visit> void assign(std::size_t tiles, const Visit& visit) {
        first_.assign(tiles + 1, 0);
        visit([&](std::size_t tile, const Item&) { ++first_[tile + 1]; });
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        items_.resize(first_.back());
        next_.assign(first_.begin(), first_.end() - 1);
        visit([&](std::size_t tile, const Item& item) { items_[next_[tile]++] = item; });
    }

    std::span<const Item> tile(std::size_t index) const {
        return std::span(items_).subspan(first_[index], first_[index + 1] - first_[index]);
    }
    std::size_t memory_bytes() const { return items_.size() * sizeof(Item) + first_.size() * sizeof(std::size_t); }

private:
    std::vector<std::size_t> first_, next_;
    std::vector<Item> items_;
};

/// Refers to a segment of a batch.
struct BatchSegment {
    std::uint32_t batch = 0, first = 0, count = 0;
};

/// Stores the segments of all batches that belong to each tile, in the order of the batches. Their items are
/// therefore in submission order, although the batches were sorted in parallel.
struct TileLists : ItemsByTile<BatchSegment> {
    using Item = BatchSegment;
    /// `segments` selects the list of each batch.
    void gather(const std::vector<Batch>& batches, std::vector<Segment> Batch::*segments, std::size_t tiles) {
        assign(tiles, [&](const auto& put) {
            for (std::uint32_t i = 0; i < batches.size(); ++i)
                for (const auto& [tile, first, count] : batches[i].*segments) put(tile, {i, first, count});
        });
    }
};

} // namespace duet::raster
