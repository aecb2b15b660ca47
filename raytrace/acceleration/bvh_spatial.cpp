#include "raytrace/acceleration/bvh_spatial.h"

#include "common/system/error.h"
#include "common/system/parallel.h"
#include "raytrace/acceleration/bvh_spatial_binning.h"

#include <algorithm>
#include <cmath>

namespace duet::raytrace {

namespace {

float float_below(double x) {
    const auto f = static_cast<float>(x);
    return static_cast<double>(f) > x ? std::nextafter(f, -kInfinity) : f;
}
float float_above(double x) {
    const auto f = static_cast<float>(x);
    return static_cast<double>(f) < x ? std::nextafter(f, kInfinity) : f;
}

// Returns a box that contains the point where the edge from p to q crosses a plane. The point is computed in double
// precision and is off by fewer than 8 roundings of the edge's coordinates.
Box3 crossing(Vec3 p, Vec3 q, std::size_t axis, float plane) {
    const double a = p[axis], b = q[axis], t = (static_cast<double>(plane) - a) / (b - a);
    Box3 result;
    for (std::size_t i = 0; i < 3; ++i) {
        const double from = p[i], to = q[i], x = from + (to - from) * t;
        const double error = (std::abs(from) + std::abs(to)) * (8 * 0x1p-53);
        result.low[i] = i == axis ? plane : float_below(x - error);
        result.high[i] = i == axis ? plane : float_above(x + error);
    }
    return result;
}

} // namespace

Box3 clip(const ConvexPolygon& polygon, const Box3& box, std::size_t axis, float low, float high) {
    Box3 part;
    // The polygon is the convex hull of its corners. Where planes cut the hull, all of its edges are among the
    // segments between any two corners.
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const Vec3 p = polygon.corners[i];
        if (low <= p[axis] && p[axis] <= high) part.extend(p);
        for (std::size_t k = i + 1; k < polygon.count; ++k) {
            const Vec3 q = polygon.corners[k];
            for (const float plane : {low, high})
                if ((p[axis] < plane) != (q[axis] < plane)) part.extend(crossing(p, q, axis, plane));
        }
    }
    part.low = max(part.low, box.low);
    part.high = min(part.high, box.high);
    part.low[axis] = max(part.low[axis], low);
    part.high[axis] = min(part.high[axis], high);
    return part.empty() ? Box3() : part;
}

namespace {

// Spatial splits are tried only where the children of the best object split overlap in more than this fraction of
// the root's area. (Stich et al., §4.5, use 1e-5, which takes longer and gains nothing here.)
constexpr float kMinOverlap = 1e-4f;

// Holds a set of items to build a subtree over. `extra_items` is the number of additional items that spatial splits may
// add.
struct Task {
    std::size_t node;
    BuildItems items;
    Extent extent;
    std::size_t extra_items;
    int depth;
};

class SpatialBuilder {
public:
    SpatialBuilder(const PolygonOf& polygon_of, const RelativeArea& of_root, std::size_t job_size, int threads)
        : polygon_of_(polygon_of), of_root_(of_root), job_size_(job_size), threads_(threads) {}

    std::vector<BinaryNode> nodes;
    BuildItems leaves; // items of the leaves
    std::vector<Task> jobs;

    std::uint32_t build(BuildItems items, const Extent& extent, std::size_t extra_items, int depth) {
        const auto index = static_cast<std::uint32_t>(nodes.size());
        nodes.emplace_back();
        if (items.size() <= job_size_) {
            jobs.push_back({index, std::move(items), extent, extra_items, depth});
            return index;
        }
        nodes[index].box = extent.bounds.box();
        std::optional<SplitItems> sides = split(items, extent, extra_items, depth);
        if (!sides) {
            leaf(nodes[index], items);
            return index;
        }
        items = BuildItems(); // free the memory for the recursion
        const std::size_t both = sides->left.size() + sides->right.size();
        const std::size_t left_extra = share_of_extra(sides->extra_items, sides->left.size(), both),
                          right_extra = sides->extra_items - left_extra;
        const std::uint32_t left = build(std::move(sides->left), sides->left_extent, left_extra, depth + 1);
        const std::uint32_t right = build(std::move(sides->right), sides->right_extent, right_extra, depth + 1);
        nodes[index].left = left;
        nodes[index].right = right;
        return index;
    }

private:
    struct SplitItems {
        BuildItems left, right;
        Extent left_extent, right_extent;
        std::size_t extra_items; // additional items that are still allowed
    };

    static std::size_t share_of_extra(std::size_t extra_items, std::size_t side, std::size_t both) {
        return static_cast<std::size_t>(static_cast<double>(extra_items) * static_cast<double>(side) /
                                        static_cast<double>(both));
    }

    // Makes a node a leaf of the items. Parts of the same item are merged.
    void leaf(BinaryNode& node, Items items) {
        node.first = static_cast<std::uint32_t>(leaves.size());
        for (const BuildItem& item : items) {
            const auto same = [&](const BuildItem& other) { return other.index == item.index; };
            const auto found = std::find_if(leaves.begin() + node.first, leaves.end(), same);
            if (found == leaves.end())
                leaves.push_back(item);
            else
                found->box.extend(item.box);
        }
        node.count = static_cast<std::uint32_t>(leaves.size()) - node.first;
    }

    // Partitions the items, or returns nothing if they are to be a leaf.
    std::optional<SplitItems> split(Items items, const Extent& extent, std::size_t extra_items, int depth) {
        if (items.size() == 1) return std::nullopt;
        const bool can_be_leaf = extent.same_kind() && items.size() <= largest_leaf(items[0].kind);
        const Binning binning(extent, items.size());
        const RelativeArea area(extent.bounds);
        const LeafCost leaf_cost(extent.kinds);
        std::optional<Split> object_split;
        if (depth < kSahDepth) {
            fill(bins_, items, binning, threads_);
            object_split = best_split(bins_, binning, area, leaf_cost, items.size());
        }
        if (can_be_leaf && (!object_split || object_split->cost >= leaf_cost(items.size()))) return std::nullopt;
        if (depth < kSahDepth && extra_items > 0 && (!object_split || may_split_spatially(*object_split, binning))) {
            SpatialBinning spatial(extent.bounds, binning.bins, polygon_of_);
            spatial.fill(items, threads_);
            const auto spatial_split = spatial.best(area, leaf_cost, items.size(), extra_items);
            if (spatial_split && (!object_split || spatial_split->cost < object_split->cost))
                if (std::optional<SplitItems> sides = split_spatially(items, *spatial_split, extra_items)) return sides;
        }
        const auto goes_left = [&](const BuildItem& item) {
            return binning.bin(item)[object_split->axis] <= object_split->bin;
        };
        const Partition partition =
            object_split ? partition_items(items, goes_left) : partition_without_plane(items, extent);
        const auto middle = items.begin() + static_cast<std::ptrdiff_t>(partition.left_count);
        return SplitItems{BuildItems(items.begin(), middle), BuildItems(middle, items.end()), partition.left,
                          partition.right, extra_items};
    }

    // Returns whether the two boxes of an object split overlap so much that a spatial split may gain something.
    bool may_split_spatially(const Split& split, const Binning& binning) const {
        Bounds left, right;
        for (std::size_t i = 0; i < binning.bins; ++i)
            (static_cast<std::int32_t>(i) <= split.bin ? left : right).extend(bins_[split.axis][i].bounds);
        const Bounds both{xsimd::max(left.low, right.low), xsimd::min(left.high, right.high)};
        return !both.box().empty() && of_root_(both) > kMinOverlap;
    }

    // Partitions the items by a plane. An item that straddles the plane becomes two where that is cheaper than to
    // leave it on one side (Stich et al., §4.4, "reference unsplitting"). Returns nothing if one side would have all
    // items.
    std::optional<SplitItems> split_spatially(std::span<const BuildItem> items, const SpatialBinning::Split& split,
                                              std::size_t extra_items) const {
        SplitItems sides;
        sides.extra_items = extra_items;
        const RelativeArea area(merged(split.left, split.right));
        Bounds left = split.left, right = split.right;
        std::size_t left_count = split.left_count, right_count = split.right_count;
        const auto put = [](BuildItems& side, Extent& extent, const BuildItem& item) {
            side.push_back(item);
            extent.extend(item);
        };
        for (const BuildItem& item : items) {
            if (item.box.high[split.axis] <= split.plane) {
                put(sides.left, sides.left_extent, item);
                continue;
            }
            if (item.box.low[split.axis] >= split.plane) {
                put(sides.right, sides.right_extent, item);
                continue;
            }
            const ConvexPolygon polygon = polygon_of_(item);
            BuildItem a = item, b = item;
            a.box = clip(polygon, item.box, split.axis, item.box.low[split.axis], split.plane);
            b.box = clip(polygon, item.box, split.axis, split.plane, item.box.high[split.axis]);
            const Bounds box{low_corner(item), high_corner(item)};
            const float in_both =
                area(left) * static_cast<float>(left_count) + area(right) * static_cast<float>(right_count);
            const float in_left = area(merged(left, box)) * static_cast<float>(left_count) +
                                  area(right) * static_cast<float>(right_count - std::min<std::size_t>(right_count, 1));
            const float in_right = area(left) * static_cast<float>(left_count - std::min<std::size_t>(left_count, 1)) +
                                   area(merged(right, box)) * static_cast<float>(right_count);
            const bool cuttable = polygon.count > 0 && sides.extra_items > 0 && !(a.box.empty() && b.box.empty());
            if (cuttable && in_both < std::min(in_left, in_right)) {
                // An empty part, outside of the box that the item was clipped to before, needs no item.
                if (!a.box.empty()) put(sides.left, sides.left_extent, a);
                if (!b.box.empty()) put(sides.right, sides.right_extent, b);
                if (!a.box.empty() && !b.box.empty()) --sides.extra_items;
            } else if (in_left < in_right) {
                put(sides.left, sides.left_extent, item);
                left.extend(box);
                right_count -= std::min<std::size_t>(right_count, 1);
            } else {
                put(sides.right, sides.right_extent, item);
                right.extend(box);
                left_count -= std::min<std::size_t>(left_count, 1);
            }
        }
        const std::size_t most = std::max(sides.left.size(), sides.right.size());
        if (most >= items.size() || sides.left.empty() || sides.right.empty()) return std::nullopt;
        return sides;
    }

    static Bounds merged(Bounds a, const Bounds& b) {
        a.extend(b);
        return a;
    }

    const PolygonOf& polygon_of_;
    const RelativeArea& of_root_;
    std::size_t job_size_;
    int threads_;
    Bins bins_;
};

// Appends a subtree's nodes and items to those of the tree. The subtree's root replaces the placeholder node at
// index `slot`.
void graft(BinaryTree& tree, std::size_t slot, const SpatialBuilder& subtree) {
    const auto nodes = static_cast<std::uint32_t>(tree.nodes.size()) - 1,
               items = static_cast<std::uint32_t>(tree.items.size());
    for (std::size_t i = 0; i < subtree.nodes.size(); ++i) {
        BinaryNode node = subtree.nodes[i];
        if (node.leaf()) {
            node.first += items;
        } else {
            node.left += nodes;
            node.right += nodes;
        }
        if (i == 0)
            tree.nodes[slot] = node;
        else
            tree.nodes.push_back(node);
    }
    tree.items.insert(tree.items.end(), subtree.leaves.begin(), subtree.leaves.end());
}

} // namespace

BinaryTree build_spatial_tree(BuildItems items, const PolygonOf& polygon_of, float budget, int threads) {
    BinaryTree tree;
    if (items.empty()) return tree;
    const auto extra_items = static_cast<std::size_t>(static_cast<double>(items.size()) * static_cast<double>(budget));
    if (items.size() + extra_items > (std::size_t{1} << 31))
        throw Error(message(items.size(), " primitives: too many"));

    // The division into jobs depends only on the input, so that the tree does not depend on the number of threads.
    constexpr std::size_t kJobs = 64, kSmallestJob = 4096;
    const Extent extent = extent_of(items);
    const RelativeArea area(extent.bounds);
    SpatialBuilder top(polygon_of, area, std::max(items.size() / kJobs, kSmallestJob), threads);
    top.build(std::move(items), extent, extra_items, 0);
    std::vector<std::optional<SpatialBuilder>> subtrees(top.jobs.size());
    parallel_for(top.jobs.size(), threads, [&](std::size_t i) {
        Task& job = top.jobs[i];
        subtrees[i].emplace(polygon_of, area, 0, 1).build(std::move(job.items), job.extent, job.extra_items, job.depth);
    });
    tree.nodes = std::move(top.nodes);
    for (std::size_t i = 0; i < subtrees.size(); ++i) graft(tree, top.jobs[i].node, *subtrees[i]);
    return tree;
}

} // namespace duet::raytrace
