// SpatialBinning finds the best plane in space to divide a set of items. Items that the plane cuts have a part on
// each side.
#pragma once

#include "raytrace/acceleration/bvh_binning.h"
#include "raytrace/acceleration/bvh_spatial.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

namespace duet::raytrace {

// A node's box is divided into bins of equal width on each axis. An item counts in the bin where it begins and in
// the bin where it ends, and its parts extend the boxes of the bins that they lie in.
class SpatialBinning {
public:
    struct Bin {
        Bounds bounds;
        std::size_t begin = 0, end = 0;

        void extend(const Bin& other) {
            bounds.extend(other.bounds);
            begin += other.begin;
            end += other.end;
        }
    };
    struct Split {
        std::size_t axis = 0;
        float plane = 0, cost = 0;
        Bounds left, right; // bounds of the two sides
        std::size_t left_count = 0, right_count = 0;
    };

    SpatialBinning(const Bounds& bounds, std::size_t bins, const PolygonOf& polygon_of)
        : box_(bounds.box()), count_(bins), polygon_of_(polygon_of) {
        width_ = box_.high / static_cast<float>(bins) - box_.low / static_cast<float>(bins);
        for (std::size_t axis = 0; axis < 3; ++axis) per_width_[axis] = width_[axis] > 0 ? 1 / width_[axis] : 0;
    }

    void fill(std::span<const BuildItem> items, int threads) {
        const std::size_t chunks = (items.size() + kChunk - 1) / kChunk;
        std::vector<Bins> others(chunks - 1);
        parallel_for(chunks, threads, [&](std::size_t i) {
            Bins& bins = i == 0 ? bins_ : others[i - 1];
            for (auto& axis : bins) std::fill_n(axis.begin(), count_, Bin());
            BinBounds parts;
            for (const BuildItem& item : items.subspan(i * kChunk, std::min(kChunk, items.size() - i * kChunk)))
                add(bins, item, parts);
        });
        for (const Bins& other : others)
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (std::size_t k = 0; k < count_; ++k) bins_[axis][k].extend(other[axis][k]);
    }

    // Returns the cheapest plane that adds at most `extra_items` items and leaves fewer than all items on each side, or
    // nothing if there is no such plane.
    std::optional<Split> best(const RelativeArea& area, const LeafCost& leaf_cost, std::size_t count,
                              std::size_t extra_items) const {
        std::optional<Split> best;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!usable(axis)) continue;
            std::array<Bin, kMaxBins> right; // right[i] is bin i and all after it
            right[count_ - 1] = bins_[axis][count_ - 1];
            for (std::size_t i = count_ - 1; i-- > 1;) {
                right[i] = right[i + 1];
                right[i].extend(bins_[axis][i]);
            }
            Bin left;
            for (std::size_t i = 1; i < count_; ++i) {
                left.extend(bins_[axis][i - 1]);
                const std::size_t l = left.begin, r = right[i].end;
                if (l == 0 || r == 0 || l >= count || r >= count || l + r > count + extra_items) continue;
                const float cost =
                    kTraversalCost + area(left.bounds) * leaf_cost(l) + area(right[i].bounds) * leaf_cost(r);
                if (!best || cost < best->cost)
                    best = Split{axis, plane(axis, i), cost, left.bounds, right[i].bounds, l, r};
            }
        }
        return best;
    }

private:
    using Bins = std::array<std::array<Bin, kMaxBins>, 3>;
    using BinBounds = std::array<Bounds, kMaxBins>; // bounds of an item's parts, by bin

    bool usable(std::size_t axis) const {
        return plane(axis, 1) > box_.low[axis] && plane(axis, count_ - 1) < box_.high[axis];
    }
    float plane(std::size_t axis, std::size_t bin) const {
        return box_.low[axis] + width_[axis] * static_cast<float>(bin);
    }
    std::size_t bin(std::size_t axis, float position) const {
        const float at = (position - box_.low[axis]) * per_width_[axis];
        return static_cast<std::size_t>(clamp(at, 0.0f, static_cast<float>(count_ - 1)));
    }

    void add(Bins& bins, const BuildItem& item, BinBounds& parts) const {
        const Bounds box{low_corner(item), high_corner(item)};
        std::optional<ConvexPolygon> polygon; // computed only if the item spans several bins of an axis
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!usable(axis)) continue;
            const std::size_t first = bin(axis, item.box.low[axis]);
            std::size_t last = bin(axis, item.box.high[axis]);
            if (first != last && !polygon) polygon = polygon_of_(item);
            if (first != last && polygon->count == 0) last = first;
            ++bins[axis][first].begin;
            ++bins[axis][last].end;
            if (first == last)
                bins[axis][first].bounds.extend(box);
            else
                add_parts(bins[axis], box, *polygon, axis, first, last, parts);
        }
    }

    // Extends each bin by the part of a polygon between its planes. The parts are approximate, because they serve
    // only to choose a plane.
    void add_parts(std::array<Bin, kMaxBins>& bins, const Bounds& box, const ConvexPolygon& polygon, std::size_t axis,
                   std::size_t first, std::size_t last, BinBounds& parts) const {
        std::fill(parts.begin() + static_cast<std::ptrdiff_t>(first),
                  parts.begin() + static_cast<std::ptrdiff_t>(last) + 1, Bounds());
        const auto to_float4 = [](Vec3 p) {
            alignas(16) const std::array<float, 4> values{p.x, p.y, p.z, 0};
            return Float4::load_aligned(values.data());
        };
        for (std::size_t i = 0; i < polygon.count; ++i) {
            Vec3 p = polygon.corners[i], q = polygon.corners[(i + 1) % polygon.count];
            const Float4 corner = to_float4(p);
            const std::size_t its_bin = bin(axis, p[axis]);
            if (first <= its_bin && its_bin <= last) parts[its_bin].extend(corner, corner);
            if (q[axis] < p[axis]) std::swap(p, q);
            const Float4 from = to_float4(p), direction = to_float4(q) - from;
            const float length = q[axis] - p[axis];
            const std::size_t end = std::min(bin(axis, q[axis]), last);
            for (std::size_t k = std::max(bin(axis, p[axis]), first); k < end; ++k) {
                const Float4 cut = from + direction * Float4(min((plane(axis, k + 1) - p[axis]) / length, 1.0f));
                parts[k].extend(cut, cut);
                parts[k + 1].extend(cut, cut);
            }
        }
        for (std::size_t k = first; k <= last; ++k) {
            const Bounds part{xsimd::max(parts[k].low, box.low), xsimd::min(parts[k].high, box.high)};
            if ((lane_bits(part.low <= part.high) & 7) == 7) bins[k].bounds.extend(part);
        }
    }

    Box3 box_;
    Vec3 width_, per_width_;
    std::size_t count_;
    const PolygonOf& polygon_of_;
    Bins bins_;
};

} // namespace duet::raytrace
