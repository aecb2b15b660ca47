#include "raytrace/acceleration/bvh_build.h"

#include "common/system/error.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace duet::raytrace {

namespace {

constexpr std::size_t kBins = 16;
// Costs of the heuristic, in primitive tests. Eight boxes are tested at once: a step down is cheap.
constexpr double kStepCost = 0.5;
// Below this depth boxes are halved by count, so that no input makes the tree deeper than another log2(2³²) levels.
constexpr int kSahDepth = Bvh::kMaxDepth - 32;

using Items = std::span<BuildItem>;

double half_area(const Box3& box) { return Box3d{Vec3d(box.low), Vec3d(box.high)}.half_area(); }

// Maps a coordinate of the centroids' extent to a bin; no scale where the extent is none.
struct Binning {
    float low = 0, scale = 0;

    Binning(float low_, float high) : low(low_) {
        const float s = static_cast<float>(kBins) / (high - low_);
        if (std::isfinite(s)) scale = s;
    }
    bool usable() const { return scale > 0; }
    std::size_t bin(float x) const { return std::min(static_cast<std::size_t>((x - low) * scale), kBins - 1); }
};

struct Split {
    std::size_t axis = 0, bin = 0; // items in bins up to `bin` go left
    double cost = 0;
};

// The cheapest of the (kBins − 1) × 3 planes between bins; none where all centroids are one point.
std::optional<Split> best_split(Items items, const std::array<Binning, 3>& binnings, double area) {
    struct Bin {
        Box3 box;
        std::size_t count = 0;
    };
    std::array<std::array<Bin, kBins>, 3> bins;
    for (const BuildItem& item : items) {
        const Vec3 center = item.box.center();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!binnings[axis].usable()) continue;
            Bin& bin = bins[axis][binnings[axis].bin(center[axis])];
            bin.box.extend(item.box);
            ++bin.count;
        }
    }
    std::optional<Split> best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!binnings[axis].usable()) continue;
        std::array<double, kBins> right_cost;
        Bin right;
        for (std::size_t i = kBins; i-- > 1;) {
            right.box.extend(bins[axis][i].box);
            right.count += bins[axis][i].count;
            right_cost[i] = half_area(right.box) * static_cast<double>(right.count);
        }
        Bin left;
        for (std::size_t i = 0; i + 1 < kBins; ++i) {
            left.box.extend(bins[axis][i].box);
            left.count += bins[axis][i].count;
            if (left.count == 0 || left.count == items.size()) continue;
            const double cost = half_area(left.box) * static_cast<double>(left.count) + right_cost[i + 1];
            if (!best || cost < best->cost) best = Split{axis, i, cost};
        }
    }
    if (best) best->cost = kStepCost + best->cost / std::max(area, std::numeric_limits<double>::min());
    return best;
}

bool one_kind(Items items) {
    return std::all_of(items.begin(), items.end(), [&](const BuildItem& i) { return i.kind == items[0].kind; });
}

// An instance is a hierarchy of its own: a box around each pays.
std::size_t largest_leaf(PrimitiveKind kind) { return kind == PrimitiveKind::kInstance ? 1 : Bvh::kMaxLeaf; }

// How many of the items go to the left child, having been moved to the front; 0: the items are a leaf.
std::size_t partition(Items items, const Box3& box, int depth) {
    if (items.size() == 1) return 0;
    const bool same_kind = one_kind(items);
    const bool can_be_leaf = same_kind && items.size() <= largest_leaf(items[0].kind);

    Box3 centers;
    for (const BuildItem& item : items) centers.extend(item.box.center());
    const std::array<Binning, 3> binnings{Binning(centers.low.x, centers.high.x),
                                          Binning(centers.low.y, centers.high.y),
                                          Binning(centers.low.z, centers.high.z)};
    const auto split = depth < kSahDepth ? best_split(items, binnings, half_area(box)) : std::nullopt;
    if (can_be_leaf && (!split || split->cost >= static_cast<double>(items.size()))) return 0;
    const auto count_left = [&](auto middle) { return static_cast<std::size_t>(middle - items.begin()); };
    if (split)
        return count_left(std::partition(items.begin(), items.end(), [&](const BuildItem& item) {
            return binnings[split->axis].bin(item.box.center()[split->axis]) <= split->bin;
        }));
    // All in one place (or too deep): by kind where only that keeps them from being a leaf, else by count.
    if (items.size() <= Bvh::kMaxLeaf && !same_kind)
        return count_left(std::partition(items.begin(), items.end(),
                                         [kind = items[0].kind](const BuildItem& i) { return i.kind == kind; }));
    return items.size() / 2;
}

// Subtrees of at most `job_size` items are left as placeholders, to be built by several threads at once.
struct Job {
    std::size_t node;
    std::size_t first, count;
    int depth;
};

class Builder {
public:
    Builder(std::span<BuildItem> items, std::size_t job_size) : items_(items), job_size_(job_size) {}

    std::vector<BinaryNode> nodes;
    std::vector<Job> jobs;

    std::uint32_t build(std::size_t first, std::size_t count, int depth) {
        const auto index = static_cast<std::uint32_t>(nodes.size());
        nodes.emplace_back();
        if (count <= job_size_) {
            jobs.push_back({index, first, count, depth});
            return index;
        }
        const Items items = items_.subspan(first, count);
        Box3 box;
        for (const BuildItem& item : items) box.extend(item.box);
        nodes[index].box = box;
        if (const std::size_t left_count = partition(items, box, depth)) {
            const std::uint32_t left = build(first, left_count, depth + 1);
            const std::uint32_t right = build(first + left_count, count - left_count, depth + 1);
            nodes[index].left = left;
            nodes[index].right = right;
        } else {
            nodes[index].first = static_cast<std::uint32_t>(first);
            nodes[index].count = static_cast<std::uint32_t>(count);
        }
        return index;
    }

private:
    std::span<BuildItem> items_;
    std::size_t job_size_;
};

// Moves a subtree's nodes behind those of the tree; its root takes the placeholder's seat.
void graft(std::vector<BinaryNode>& tree, std::size_t seat, const std::vector<BinaryNode>& subtree) {
    const auto moved = [&](std::uint32_t child) { return static_cast<std::uint32_t>(tree.size() + child - 1); };
    const auto rebased = [&](BinaryNode node) {
        if (!node.leaf()) {
            node.left = moved(node.left);
            node.right = moved(node.right);
        }
        return node;
    };
    std::vector<BinaryNode> rest;
    rest.reserve(subtree.size());
    for (const BinaryNode& node : subtree) rest.push_back(rebased(node));
    tree[seat] = rest[0];
    tree.insert(tree.end(), rest.begin() + 1, rest.end());
}

} // namespace

BinaryTree build_binary_tree(std::vector<BuildItem> items, int threads) {
    BinaryTree tree{{}, std::move(items)};
    if (tree.items.empty()) return tree;
    if (tree.items.size() > (std::size_t{1} << 31)) throw Error(message(tree.items.size(), " primitives: too many"));

    // The division into jobs depends on the input alone, so that the tree does, too.
    constexpr std::size_t kJobs = 64, kSmallestJob = 4096;
    Builder top(tree.items, std::max(tree.items.size() / kJobs, kSmallestJob));
    top.build(0, tree.items.size(), 0);
    std::vector<std::vector<BinaryNode>> subtrees(top.jobs.size());
    parallel_for(top.jobs.size(), threads, [&](std::size_t i) {
        const Job& job = top.jobs[i];
        Builder builder(tree.items, 0);
        builder.build(job.first, job.count, job.depth);
        subtrees[i] = std::move(builder.nodes);
    });
    tree.nodes = std::move(top.nodes);
    for (std::size_t i = 0; i < subtrees.size(); ++i) graft(tree.nodes, top.jobs[i].node, subtrees[i]);
    return tree;
}

} // namespace duet::raytrace
