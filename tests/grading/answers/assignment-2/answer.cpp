// A hierarchy by the binned surface area heuristic (Wald 2007).
#include "compare/lessons/assignments/2-bvh/lab.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace duet::lab {

namespace {

constexpr int kBins = 16;

Box empty_box() { return {Vec3(kInfinity, kInfinity, kInfinity), Vec3(-kInfinity, -kInfinity, -kInfinity)}; }
Box join(const Box& a, const Box& b) { return {min(a.low, b.low), max(a.high, b.high)}; }

struct Builder {
    std::vector<Box> boxes;
    std::vector<Vec3> centers;
    Tree tree;

    int build(int first, int count) {
        const int index = static_cast<int>(tree.nodes.size());
        tree.nodes.emplace_back();
        Box box = empty_box(), center_box = empty_box();
        for (int i = first; i < first + count; ++i) {
            const auto id = static_cast<std::size_t>(tree.order[static_cast<std::size_t>(i)]);
            box = join(box, boxes[id]);
            center_box = join(center_box, {centers[id], centers[id]});
        }
        tree.nodes[static_cast<std::size_t>(index)].box = box;
        const int middle = count > 1 ? split(first, count, box, center_box) : first;
        if (middle == first) {
            tree.nodes[static_cast<std::size_t>(index)].first = first;
            tree.nodes[static_cast<std::size_t>(index)].count = count;
            return index;
        }
        const int left = build(first, middle - first);
        const int right = build(middle, first + count - middle);
        tree.nodes[static_cast<std::size_t>(index)].left = left;
        tree.nodes[static_cast<std::size_t>(index)].right = right;
        return index;
    }

    /// Sorts the range into two halves and returns where the second begins; `first` where a leaf is cheaper.
    int split(int first, int count, const Box& box, const Box& center_box) {
        float best = static_cast<float>(count) * surface_area(box);
        std::size_t best_axis = 3;
        int best_bin = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!(center_box.high[axis] > center_box.low[axis])) continue;
            std::array<Box, kBins> bins;
            std::array<int, kBins> counts{};
            bins.fill(empty_box());
            for (int i = first; i < first + count; ++i) {
                const auto id = static_cast<std::size_t>(tree.order[static_cast<std::size_t>(i)]);
                const auto bin = static_cast<std::size_t>(bin_of(centers[id][axis], center_box, axis));
                bins[bin] = join(bins[bin], boxes[id]);
                ++counts[bin];
            }
            std::array<float, kBins> right_cost{};
            Box right = empty_box();
            int right_count = 0;
            for (std::size_t b = kBins - 1; b > 0; --b) {
                right = join(right, bins[b]);
                right_count += counts[b];
                right_cost[b] = right_count ? static_cast<float>(right_count) * surface_area(right) : 0;
            }
            Box left = empty_box();
            int left_count = 0;
            for (std::size_t b = 0; b + 1 < kBins; ++b) {
                left = join(left, bins[b]);
                left_count += counts[b];
                if (left_count == 0 || left_count == count) continue;
                const float cost =
                    surface_area(box) + static_cast<float>(left_count) * surface_area(left) + right_cost[b + 1];
                if (cost < best) best = cost, best_axis = axis, best_bin = static_cast<int>(b);
            }
        }
        if (best_axis == 3) return first;
        const auto begin = tree.order.begin() + first;
        const auto middle = std::partition(begin, begin + count, [&](int id) {
            return bin_of(centers[static_cast<std::size_t>(id)][best_axis], center_box, best_axis) <= best_bin;
        });
        return static_cast<int>(middle - tree.order.begin());
    }

    static int bin_of(float center, const Box& box, std::size_t axis) {
        const float fraction = (center - box.low[axis]) / (box.high[axis] - box.low[axis]);
        return std::min(static_cast<int>(fraction * kBins), kBins - 1);
    }
};

} // namespace

Box box_of(const Triangle& triangle) {
    return {min(min(triangle.a, triangle.b), triangle.c), max(max(triangle.a, triangle.b), triangle.c)};
}

float surface_area(const Box& box) {
    const Vec3 size = box.high - box.low;
    return 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

bool hit_box(const Box& box, const Ray& ray) {
    float enter = ray.t_min, leave = ray.t_max;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0) {
            if (ray.origin[axis] < box.low[axis] || ray.origin[axis] > box.high[axis]) return false;
            continue;
        }
        const float near = (box.low[axis] - ray.origin[axis]) / ray.direction[axis];
        const float far = (box.high[axis] - ray.origin[axis]) / ray.direction[axis];
        enter = std::max(enter, std::min(near, far));
        leave = std::min(leave, std::max(near, far) * 1.0000004f);
    }
    return enter <= leave;
}

Tree build(const std::vector<Triangle>& triangles) {
    Builder builder;
    for (const Triangle& triangle : triangles) {
        builder.boxes.push_back(box_of(triangle));
        builder.centers.push_back((builder.boxes.back().low + builder.boxes.back().high) * 0.5f);
    }
    builder.tree.order.resize(triangles.size());
    std::iota(builder.tree.order.begin(), builder.tree.order.end(), 0);
    if (!triangles.empty()) builder.build(0, static_cast<int>(triangles.size()));
    return builder.tree;
}

std::vector<TriangleHit> trace(const Tree& tree, const std::vector<Triangle>& triangles, const std::vector<Ray>& rays) {
    std::vector<TriangleHit> found(rays.size());
    std::vector<int> stack;
    for (std::size_t r = 0; r < rays.size(); ++r) {
        Ray ray = rays[r];
        if (!tree.nodes.empty()) stack.push_back(0);
        while (!stack.empty()) {
            const Node& node = tree.nodes[static_cast<std::size_t>(stack.back())];
            stack.pop_back();
            if (!hit_box(node.box, ray)) continue;
            if (node.count == 0) {
                const Box &left = tree.nodes[static_cast<std::size_t>(node.left)].box,
                          &right = tree.nodes[static_cast<std::size_t>(node.right)].box;
                const bool left_first = dot(left.low + left.high - right.low - right.high, ray.direction) < 0;
                stack.push_back(left_first ? node.right : node.left);
                stack.push_back(left_first ? node.left : node.right);
                continue;
            }
            for (int i = node.first; i < node.first + node.count; ++i) {
                const int id = tree.order[static_cast<std::size_t>(i)];
                if (const auto t = hit_triangle(triangles[static_cast<std::size_t>(id)], ray)) {
                    ray.t_max = *t;
                    found[r] = {id, *t};
                }
            }
        }
    }
    return found;
}

} // namespace duet::lab
