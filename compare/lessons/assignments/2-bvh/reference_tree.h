// The examiner's own tree, by the surface area heuristic, and what a tree costs.
#pragma once

#include "compare/lessons/assignments/2-bvh/lab.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

namespace duet::grading {

using lab::Box;
using lab::Node;
using lab::Tree;
using lab::Triangle;

inline Box join(const Box& a, const Box& b) { return {min(a.low, b.low), max(a.high, b.high)}; }
inline Box box(const Triangle& t) { return {min(min(t.a, t.b), t.c), max(max(t.a, t.b), t.c)}; }
inline double area(const Box& b) {
    const Vec3d s = Vec3d(b.high) - Vec3d(b.low);
    return 2 * (s.x * s.y + s.y * s.z + s.z * s.x);
}

/// What the heuristic expects a ray that meets the root's box to cost, in tests of triangles.
inline double cost(const Tree& tree) {
    double sum = 0;
    for (const Node& node : tree.nodes) sum += area(node.box) * (node.count > 0 ? node.count : 1);
    return sum / area(tree.nodes[0].box);
}

/// The examiner's own tree: bins of equal width along each axis, the cheapest border between two of them.
/// (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies", §3)
class ReferenceTree {
public:
    ReferenceTree(const std::vector<Triangle>& triangles, bool median) : median_(median) {
        for (const Triangle& t : triangles) boxes_.push_back(box(t));
        tree.order.resize(triangles.size());
        std::iota(tree.order.begin(), tree.order.end(), 0);
        build(0, static_cast<int>(triangles.size()));
    }
    Tree tree;

private:
    const Box& at(int i) const { return boxes_[static_cast<std::size_t>(tree.order[static_cast<std::size_t>(i)])]; }
    static float center(const Box& b, std::size_t axis) { return b.low[axis] + b.high[axis]; }

    int build(int first, int count) {
        const auto index = tree.nodes.size();
        tree.nodes.emplace_back();
        Box all = at(first), centers{all.low + all.high, all.low + all.high};
        for (int i = first + 1; i < first + count; ++i) {
            all = join(all, at(i));
            centers = join(centers, {at(i).low + at(i).high, at(i).low + at(i).high});
        }
        tree.nodes[index].box = all;
        const int middle = count < 2 ? first
                           : median_ ? split_at_median(first, count, centers)
                                     : split(first, count, all, centers);
        if (middle == first) {
            tree.nodes[index].first = first, tree.nodes[index].count = count;
        } else {
            const int left = build(first, middle - first), right = build(middle, first + count - middle);
            tree.nodes[index].left = left, tree.nodes[index].right = right;
        }
        return static_cast<int>(index);
    }
    int split_at_median(int first, int count, const Box& centers) {
        if (count <= 2) return first;
        const std::size_t axis = longest(centers);
        const auto begin = tree.order.begin() + first;
        std::nth_element(begin, begin + count / 2, begin + count, [&](int a, int b) {
            return center(boxes_[static_cast<std::size_t>(a)], axis) <
                   center(boxes_[static_cast<std::size_t>(b)], axis);
        });
        return first + count / 2;
    }
    static std::size_t longest(const Box& b) {
        const Vec3 s = b.high - b.low;
        return s.x >= s.y && s.x >= s.z ? 0 : s.y >= s.z ? 1 : 2;
    }
    int split(int first, int count, const Box& all, const Box& centers) {
        double best = count * area(all);
        std::size_t best_axis = 0;
        float border = 0;
        bool found = false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float low = centers.low[axis], width = centers.high[axis] - low;
            if (!(width > 0)) continue;
            for (int b = 1; b < kBins; ++b) {
                const float at_border = low + width * static_cast<float>(b) / kBins;
                bins_.at(static_cast<std::size_t>(b - 1)) = at_border;
            }
            std::array<Box, kBins> bin_box;
            std::array<int, kBins> bin_count{};
            for (int i = first; i < first + count; ++i) {
                const auto bin = static_cast<std::size_t>(
                    std::upper_bound(bins_.begin(), bins_.end(), center(at(i), axis)) - bins_.begin());
                bin_box[bin] = bin_count[bin]++ ? join(bin_box[bin], at(i)) : at(i);
            }
            for (std::size_t b = 1; b < kBins; ++b) {
                double sides = area(all);
                for (const auto& [from, to] : {std::pair<std::size_t, std::size_t>{0, b}, {b, kBins}}) {
                    int n = 0;
                    Box side;
                    for (std::size_t i = from; i < to; ++i)
                        if (bin_count[i]) side = n ? join(side, bin_box[i]) : bin_box[i], n += bin_count[i];
                    sides = n ? sides + n * area(side) : kInfinity;
                }
                if (sides < best) best = sides, best_axis = axis, border = bins_[b - 1], found = true;
            }
        }
        if (!found) return first;
        const auto begin = tree.order.begin() + first;
        return static_cast<int>(
            std::partition(begin, begin + count,
                           [&](int id) { return center(boxes_[static_cast<std::size_t>(id)], best_axis) < border; }) -
            tree.order.begin());
    }

    static constexpr int kBins = 16;
    bool median_;
    std::vector<Box> boxes_;
    std::array<float, kBins - 1> bins_{};
};

} // namespace duet::grading
