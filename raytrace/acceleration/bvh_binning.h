// The builders of binary trees share the functions of this header. They sort sets of items into bins and evaluate the
// planes between bins.
#pragma once

#include "common/system/parallel.h"
#include "raytrace/acceleration/bvh_items.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <span>

namespace duet::raytrace {

inline constexpr std::size_t kMaxBins = 32;
// This is the SAH cost of one traversal step, relative to the test of one leaf block.
inline constexpr float kTraversalCost = 1;
// From this depth on, sets are halved by count, so that no input makes the tree deeper by more than log2(2³²)
// levels.
inline constexpr int kSahDepth = Bvh::kMaxDepth - 40;
// This is the chunk size, in items, of parallel binning and partitioning. Sets of at most two chunks are processed
// by one thread.
inline constexpr std::size_t kChunk = std::size_t{1} << 15;

using Items = std::span<BuildItem>;
using Float4 = Bounds::Float4;

/// Returns the lower corner of an item's box. The fourth lane holds the value that follows in memory and is not used.
inline Float4 low_corner(const BuildItem& item) {
    return Float4::load_unaligned(reinterpret_cast<const float*>(&item));
}
/// Returns the upper corner of an item's box, as low_corner does.
inline Float4 high_corner(const BuildItem& item) {
    return Float4::load_unaligned(reinterpret_cast<const float*>(&item) + 3);
}
static_assert(offsetof(BuildItem, box) == 0 && sizeof(Box3) == 6 * sizeof(float) &&
              sizeof(BuildItem) >= 7 * sizeof(float));
/// Returns twice the center of the box, which saves a multiplication.
inline Float4 doubled_center(const BuildItem& item) { return low_corner(item) + high_corner(item); }

/// Summarizes a set of items: their bounds and their kinds of primitives.
struct Extent {
    Bounds bounds, centers; ///< of the boxes, and of their doubled centers
    unsigned kinds = 0;     ///< bit mask of the kinds that occur

    void extend(const BuildItem& item) {
        bounds.extend(low_corner(item), high_corner(item));
        const Float4 center = doubled_center(item);
        centers.extend(center, center);
        kinds |= 1u << static_cast<unsigned>(item.kind);
    }
    void extend(const Extent& other) {
        bounds.extend(other.bounds);
        centers.extend(other.centers);
        kinds |= other.kinds;
    }
    bool same_center() const { return (lane_bits(centers.low == centers.high) & 7u) == 7u; }
    bool same_kind() const { return (kinds & (kinds - 1)) == 0; }
};

/// Returns the extent of a list of items.
inline Extent extent_of(std::span<const BuildItem> items) {
    Extent extent;
    for (const BuildItem& item : items) extent.extend(item);
    return extent;
}

/// Returns the SAH cost of testing a number of primitives: 1 per block, or 1 per instance, since each instance is a
/// hierarchy of its own. (Blocks of quads take longer than blocks of spheres, but a separate cost changed none of the
/// trees that were tried.)
class LeafCost {
public:
    explicit LeafCost(unsigned kinds)
        : shift_(kinds == 1u << static_cast<unsigned>(PrimitiveKind::kInstance) ? 0 : std::countr_zero(kBlockSize)) {}
    float operator()(std::size_t count) const {
        return static_cast<float>((count + (std::size_t{1} << shift_) - 1) >> shift_);
    }

private:
    int shift_;
};

/// Maps box centers to bins of equal width on each axis. All items are in one bin on an axis along which the centers
/// have no extent.
class Binning {
public:
    Binning(const Extent& extent, std::size_t count) : low_(extent.centers.low) {
        // Small sets get few bins, because evaluating more of them would cost more than it gains.
        bins = std::min(kMaxBins, 4 + count / 16);
        const Float4 width = extent.centers.high - extent.centers.low;
        const Float4 scale = Float4(static_cast<float>(bins)) / width;
        const auto usable = (width > Float4(0.0f)) & (width < Float4(kInfinity)) & (scale < Float4(kInfinity));
        scale_ = xsimd::select(usable, scale, Float4(0.0f));
        usable_ = lane_bits(usable);
    }
    bool usable(std::size_t axis) const { return (usable_ >> axis & 1) != 0; }
    std::array<std::int32_t, 4> bin(const BuildItem& item) const {
        const Float4 position = (doubled_center(item) - low_) * scale_;
        using Int4 = xsimd::batch<std::int32_t, Float4::arch_type>;
        const Int4 last(static_cast<std::int32_t>(bins) - 1);
        // NaN becomes a negative integer, and thus index 0.
        const auto index = xsimd::max(xsimd::min(xsimd::to_int(position), last), Int4(0));
        alignas(16) std::array<std::int32_t, 4> result;
        index.store_aligned(result.data());
        return result;
    }

    std::size_t bins;

private:
    Float4 low_, scale_;
    unsigned usable_;
};

/// Summarizes the items of one bin.
struct Bin {
    Bounds bounds;
    std::size_t count = 0;

    void extend(const Bin& other) {
        bounds.extend(other.bounds);
        count += other.count;
    }
};
using Bins = std::array<std::array<Bin, kMaxBins>, 3>;

inline void fill(Bins& bins, std::span<const BuildItem> items, const Binning& binning) {
    for (auto& axis : bins) std::fill_n(axis.begin(), binning.bins, Bin());
    for (const BuildItem& item : items) {
        const auto index = binning.bin(item);
        const Float4 low = low_corner(item), high = high_corner(item);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Bin& bin = bins[axis][static_cast<std::size_t>(index[axis])];
            bin.bounds.extend(low, high);
            ++bin.count;
        }
    }
}

/// Fills the bins in parallel chunks. The result equals that of the serial `fill`.
inline void fill(Bins& bins, std::span<const BuildItem> items, const Binning& binning, int threads) {
    if (items.size() <= 2 * kChunk) return fill(bins, items, binning);
    std::vector<Bins> chunk_bins((items.size() + kChunk - 1) / kChunk);
    parallel_for(chunk_bins.size(), threads, [&](std::size_t i) {
        fill(chunk_bins[i], items.subspan(i * kChunk, std::min(kChunk, items.size() - i * kChunk)), binning);
    });
    bins = chunk_bins[0];
    for (std::size_t i = 1; i < chunk_bins.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t k = 0; k < binning.bins; ++k) bins[axis][k].extend(chunk_bins[i][axis][k]);
}

/// Describes a plane between bins that divides a set.
struct Split {
    std::size_t axis = 0;
    std::int32_t bin = 0; // items in bins up to `bin` go left
    float cost = 0;
};

/// Returns the cheapest plane between bins, or nothing if all centers coincide.
inline std::optional<Split> best_split(const Bins& bins, const Binning& binning, const RelativeArea& area,
                                       const LeafCost& leaf_cost, std::size_t count) {
    std::optional<Split> best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!binning.usable(axis)) continue;
        std::array<float, kMaxBins> right_cost;
        Bin right;
        for (std::size_t i = binning.bins; i-- > 1;) {
            right.extend(bins[axis][i]);
            right_cost[i] = right.count > 0 ? area(right.bounds) * leaf_cost(right.count) : 0;
        }
        Bin left;
        for (std::size_t i = 0; i + 1 < binning.bins; ++i) {
            left.extend(bins[axis][i]);
            if (left.count == 0 || left.count == count) continue;
            const float cost = area(left.bounds) * leaf_cost(left.count) + right_cost[i + 1];
            if (!best || cost < best->cost) best = Split{axis, static_cast<std::int32_t>(i), cost};
        }
    }
    if (best) best->cost += kTraversalCost;
    return best;
}

/// Returns the largest leaf size for a kind. Instances get a leaf each, because each is a hierarchy of its own, and a
/// box test is cheap in comparison.
inline std::size_t largest_leaf(PrimitiveKind kind) { return kind == PrimitiveKind::kInstance ? 1 : Bvh::kMaxLeaf; }

/// Describes a partitioned set of items, in which those of the left half come first.
struct Partition {
    std::size_t left_count = 0;
    Extent left, right;
};

/// Moves the items for which goes_left(item) is true before all others.
template <typename GoesLeft> Partition partition_items(Items items, const GoesLeft& goes_left) {
    Partition partition;
    std::size_t begin = 0, end = items.size();
    for (;;) {
        for (; begin < end && goes_left(items[begin]); ++begin) partition.left.extend(items[begin]);
        for (; begin < end && !goes_left(items[end - 1]); --end) partition.right.extend(items[end - 1]);
        if (begin == end) break;
        std::swap(items[begin], items[end - 1]);
    }
    partition.left_count = begin;
    return partition;
}

/// Splits a set that no plane divides, because all centers coincide or the node is too deep. It is split by kind if
/// only its mixed kinds keep it from being a leaf, else by count.
inline Partition partition_without_plane(Items items, const Extent& extent) {
    if (items.size() <= Bvh::kMaxLeaf && !extent.same_kind())
        return partition_items(items, [kind = items[0].kind](const BuildItem& item) { return item.kind == kind; });
    const std::size_t half = items.size() / 2;
    return Partition{half, extent_of(items.first(half)), extent_of(items.subspan(half))};
}

} // namespace duet::raytrace
