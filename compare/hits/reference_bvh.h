// This file declares a bounding volume hierarchy in double precision, used by the reference ray tracer.
#pragma once

#include "common/vec/box.h"
#include "common/vec/ray.h"
#include "common/vec/robust.h"

#include <array>
#include <cstdint>
#include <vector>

namespace duet::compare {

/// A ReferenceBvh splits boxes at the median of their centers along the longest axis. The double-precision reference
/// tracer uses it to judge the two pipelines. It is therefore simple, shares no code with the path tracer's BVH, and
/// never skips a box that the ray touches.
class ReferenceBvh {
public:
    explicit ReferenceBvh(const std::vector<Box3d>& boxes);

    /// Calls t_max = visit(index, t_max) for every box that the ray may touch within (ray.t_min, t_max]. The
    /// visitor shortens the ray as it finds hits. Nearer subtrees are visited first.
    template <typename Visit> void visit(const Rayd& ray, Visit&& visit) const;

private:
    struct Node {
        Box3d box;
        std::uint32_t first = 0; ///< leaf: index of its first item; inner node: index of its right child (the left
                                 ///< child is the next node)
        std::uint32_t count = 0; ///< number of items in a leaf; 0 for an inner node
    };
    std::uint32_t build(const std::vector<Box3d>& boxes, std::uint32_t first, std::uint32_t count);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> items_;
};

/// Returns t where the ray enters the box, or infinity if it misses the box or enters beyond t_max. The test is
/// conservative: the exit distance is enlarged by the rounding error of its computation (Ize 2013, "Robust BVH
/// Ray Traversal", §3). If the ray does not move along an axis and its origin lies on the slab, the result is
/// NaN, which every comparison below ignores.
inline double entry_distance(const Box3d& box, const Rayd& ray, double t_max) {
    double near = ray.t_min, far = t_max;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double inverse = 1 / ray.direction[axis];
        const double low = (box.low[axis] - ray.origin[axis]) * inverse;
        const double high = (box.high[axis] - ray.origin[axis]) * inverse;
        const double enter = inverse < 0 ? high : low;
        const double leave = (inverse < 0 ? low : high) * (1 + 2 * gamma_bound<double>(3));
        if (enter > near) near = enter;
        if (leave < far) far = leave;
    }
    return near <= far ? near : std::numeric_limits<double>::infinity();
}

template <typename Visit> void ReferenceBvh::visit(const Rayd& ray, Visit&& visit) const {
    if (nodes_.empty()) return;
    double t_max = ray.t_max;
    std::array<std::uint32_t, 64> stack; // median splits: the depth is logarithmic in the number of boxes
    std::size_t size = 0;
    stack[size++] = 0;
    while (size > 0) {
        const std::uint32_t index = stack[--size];
        const Node& node = nodes_[index];
        if (!std::isfinite(entry_distance(node.box, ray, t_max))) continue;
        if (node.count > 0) {
            for (std::uint32_t i = 0; i < node.count; ++i) t_max = visit(items_[node.first + i], t_max);
            continue;
        }
        std::uint32_t near = index + 1, far = node.first;
        if (entry_distance(nodes_[far].box, ray, t_max) < entry_distance(nodes_[near].box, ray, t_max))
            std::swap(near, far);
        stack[size++] = far;
        stack[size++] = near;
    }
}

} // namespace duet::compare
