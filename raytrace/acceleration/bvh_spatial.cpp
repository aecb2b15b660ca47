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

Box3 clip(const Outline& outline, const Box3& box, std::size_t axis, float low, float high) {
    Box3 part;
    // The polygon is the convex hull of its corners. Where planes cut the hull, all of its edges are among the
    // segments between any two corners.
    for (std::size_t i = 0; i < outline.count; ++i) {
        const Vec3 p = outline.corners[i];
        if (low <= p[axis] && p[axis] <= high) part.extend(p);
        for (std::size_t k = i + 1; k < outline.count; ++k) {
            const Vec3 q = outline.corners[k];
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
constexpr float kLeastOverlap = 1e-4f;

// Holds a set of items to build a subtree over. `room` is the number of additional items that spatial splits may
// add.
struct Task {
    std::size_t node;
    BuildItems items;
    Extent extent;
    std::size_t room;
    int depth;
};

class SpatialBuilder {
public:
    SpatialBuilder(const OutlineOf& outline_of, const RelativeArea& of_root, std::size_t job_size, int threads)
        : outline_of_(outline_of), of_root_(of_root), job_size_(job_size), threads_(threads) {}

    std::vector<BinaryNode> nodes;
    BuildItems leaves; // items of the leaves
    std::vector<Task> jobs;

    std::uint32_t build(BuildItems items, const Extent& extent, std::size_t room, int depth) {
        const auto index = static_cast<std::uint32_t>(nodes.size());
        nodes.emplace_back();
        if (items.size() <= job_size_) {
            jobs.push_back({index, std::move(items), extent, room, depth});
            return index;
        }
        nodes[index].box = extent.bounds.box();
        std::optional<Parts> parts = split(items, extent, room, depth);
        if (!parts) {
            leaf(nodes[index], items);
            return index;
        }
        items = BuildItems(); // free the memory for the recursion
        const std::size_t both = parts->left.size() + parts->right.size();
        const std::size_t left_room = room_of(parts->room, parts->left.size(), both),
                          right_room = parts->room - left_room;
        const std::uint32_t left = build(std::move(parts->left), parts->left_extent, left_room, depth + 1);
        const std::uint32_t right = build(std::move(parts->right), parts->right_extent, right_room, depth + 1);
        nodes[index].left = left;
        nodes[index].right = right;
        return index;
    }

private:
    struct Parts {
        BuildItems left, right;
        Extent left_extent, right_extent;
        std::size_t room; // additional items that are still allowed
    };

    static std::size_t room_of(std::size_t room, std::size_t part, std::size_t whole) {
        return static_cast<std::size_t>(static_cast<double>(room) * static_cast<double>(part) /
                                        static_cast<double>(whole));
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
    std::optional<Parts> split(Items items, const Extent& extent, std::size_t room, int depth) {
        if (items.size() == 1) return std::nullopt;
        const bool can_be_leaf = extent.one_kind() && items.size() <= largest_leaf(items[0].kind);
        const Binning binning(extent, items.size());
        const RelativeArea area(extent.bounds);
        const Tests tests(extent.kinds);
        std::optional<Split> whole;
        if (depth < kSahDepth) {
            fill(bins_, items, binning, threads_);
            whole = best_split(bins_, binning, area, tests, items.size());
        }
        if (can_be_leaf && (!whole || whole->cost >= tests(items.size()))) return std::nullopt;
        if (depth < kSahDepth && room > 0 && (!whole || worth_cutting(*whole, binning))) {
            SpatialBinning spatial(extent.bounds, binning.bins, outline_of_);
            spatial.fill(items, threads_);
            const auto cut_split = spatial.best(area, tests, items.size(), room);
            if (cut_split && (!whole || cut_split->cost < whole->cost))
                if (std::optional<Parts> parts = cut(items, *cut_split, room)) return parts;
        }
        const auto goes_left = [&](const BuildItem& item) { return binning.bin(item)[whole->axis] <= whole->bin; };
        const Halves halves = whole ? divide(items, goes_left) : divide_anyhow(items, extent);
        const auto middle = items.begin() + static_cast<std::ptrdiff_t>(halves.left_count);
        return Parts{BuildItems(items.begin(), middle), BuildItems(middle, items.end()), halves.left, halves.right,
                     room};
    }

    // Returns whether the two boxes of an object split overlap so much that a spatial split may gain something.
    bool worth_cutting(const Split& split, const Binning& binning) const {
        Bounds left, right;
        for (std::size_t i = 0; i < binning.bins; ++i)
            (static_cast<std::int32_t>(i) <= split.bin ? left : right).extend(bins_[split.axis][i].bounds);
        const Bounds both{xsimd::max(left.low, right.low), xsimd::min(left.high, right.high)};
        return !both.box().empty() && of_root_(both) > kLeastOverlap;
    }

    // Partitions the items by a plane. An item that straddles the plane becomes two where that is cheaper than to
    // leave it on one side (Stich et al., §4.4, "reference unsplitting"). Returns nothing if one side would have all
    // items.
    std::optional<Parts> cut(std::span<const BuildItem> items, const SpatialBinning::Split& split,
                             std::size_t room) const {
        Parts parts;
        parts.room = room;
        const RelativeArea area(merged(split.left, split.right));
        Bounds left = split.left, right = split.right;
        std::size_t left_count = split.left_count, right_count = split.right_count;
        const auto put = [](BuildItems& side, Extent& extent, const BuildItem& item) {
            side.push_back(item);
            extent.extend(item);
        };
        for (const BuildItem& item : items) {
            if (item.box.high[split.axis] <= split.plane) {
                put(parts.left, parts.left_extent, item);
                continue;
            }
            if (item.box.low[split.axis] >= split.plane) {
                put(parts.right, parts.right_extent, item);
                continue;
            }
            const Outline outline = outline_of_(item);
            BuildItem a = item, b = item;
            a.box = clip(outline, item.box, split.axis, item.box.low[split.axis], split.plane);
            b.box = clip(outline, item.box, split.axis, split.plane, item.box.high[split.axis]);
            const Bounds box{low_corner(item), high_corner(item)};
            const float in_both =
                area(left) * static_cast<float>(left_count) + area(right) * static_cast<float>(right_count);
            const float in_left = area(merged(left, box)) * static_cast<float>(left_count) +
                                  area(right) * static_cast<float>(right_count - std::min<std::size_t>(right_count, 1));
            const float in_right = area(left) * static_cast<float>(left_count - std::min<std::size_t>(left_count, 1)) +
                                   area(merged(right, box)) * static_cast<float>(right_count);
            const bool cuttable = outline.count > 0 && parts.room > 0 && !(a.box.empty() && b.box.empty());
            if (cuttable && in_both < std::min(in_left, in_right)) {
                // An empty part, outside of the box that the item was clipped to before, needs no item.
                if (!a.box.empty()) put(parts.left, parts.left_extent, a);
                if (!b.box.empty()) put(parts.right, parts.right_extent, b);
                if (!a.box.empty() && !b.box.empty()) --parts.room;
            } else if (in_left < in_right) {
                put(parts.left, parts.left_extent, item);
                left.extend(box);
                right_count -= std::min<std::size_t>(right_count, 1);
            } else {
                put(parts.right, parts.right_extent, item);
                right.extend(box);
                left_count -= std::min<std::size_t>(left_count, 1);
            }
        }
        const std::size_t most = std::max(parts.left.size(), parts.right.size());
        if (most >= items.size() || parts.left.empty() || parts.right.empty()) return std::nullopt;
        return parts;
    }

    static Bounds merged(Bounds a, const Bounds& b) {
        a.extend(b);
        return a;
    }

    const OutlineOf& outline_of_;
    const RelativeArea& of_root_;
    std::size_t job_size_;
    int threads_;
    Bins bins_;
};

// Appends a subtree's nodes and items to those of the tree. The subtree's root replaces the placeholder node at
// index `seat`.
void graft(BinaryTree& tree, std::size_t seat, const SpatialBuilder& subtree) {
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
            tree.nodes[seat] = node;
        else
            tree.nodes.push_back(node);
    }
    tree.items.insert(tree.items.end(), subtree.leaves.begin(), subtree.leaves.end());
}

} // namespace

BinaryTree build_spatial_tree(BuildItems items, const OutlineOf& outline_of, float budget, int threads) {
    BinaryTree tree;
    if (items.empty()) return tree;
    const auto room = static_cast<std::size_t>(static_cast<double>(items.size()) * static_cast<double>(budget));
    if (items.size() + room > (std::size_t{1} << 31)) throw Error(message(items.size(), " primitives: too many"));

    // The division into jobs depends only on the input, so that the tree does not depend on the number of threads.
    constexpr std::size_t kJobs = 64, kSmallestJob = 4096;
    const Extent extent = extent_of(items);
    const RelativeArea area(extent.bounds);
    SpatialBuilder top(outline_of, area, std::max(items.size() / kJobs, kSmallestJob), threads);
    top.build(std::move(items), extent, room, 0);
    std::vector<std::optional<SpatialBuilder>> subtrees(top.jobs.size());
    parallel_for(top.jobs.size(), threads, [&](std::size_t i) {
        Task& job = top.jobs[i];
        subtrees[i].emplace(outline_of, area, 0, 1).build(std::move(job.items), job.extent, job.room, job.depth);
    });
    tree.nodes = std::move(top.nodes);
    for (std::size_t i = 0; i < subtrees.size(); ++i) graft(tree, top.jobs[i].node, *subtrees[i]);
    return tree;
}

} // namespace duet::raytrace
