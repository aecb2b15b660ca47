#include "raytrace/acceleration/bvh_build.h"

#include "common/system/error.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

namespace duet::raytrace {

namespace {

constexpr std::size_t kMaxBins = 32;
// The cost of a step down, in tests of a leaf's block.
constexpr float kStepCost = 1;
// Below this depth boxes are halved by count, so that no input makes the tree deeper than another log2(2³²) levels.
constexpr int kSahDepth = Bvh::kMaxDepth - 32;
// Ranges of more items are binned and divided by all threads, in chunks of this many.
constexpr std::size_t kChunk = std::size_t{1} << 15;

using Items = std::span<BuildItem>;
using Four = FloatBatch<4>; // x, y, z and one that nobody looks at

// An item's corners: the fourth number of each is its neighbour in memory.
Four low_corner(const BuildItem& item) { return Four::load_unaligned(reinterpret_cast<const float*>(&item)); }
Four high_corner(const BuildItem& item) { return Four::load_unaligned(reinterpret_cast<const float*>(&item) + 3); }
static_assert(offsetof(BuildItem, box) == 0 && sizeof(Box3) == 6 * sizeof(float) && sizeof(BuildItem) >= 7 * sizeof(float));
// Twice the centre: it saves a product.
Four doubled_center(const BuildItem& item) { return low_corner(item) + high_corner(item); }

struct Bounds {
    Four low = Four(kInfinity), high = Four(-kInfinity);

    void extend(Four l, Four h) {
        low = xsimd::min(low, l);
        high = xsimd::max(high, h);
    }
    void extend(const Bounds& other) { extend(other.low, other.high); }
    Box3 box() const {
        alignas(16) std::array<float, 4> l, h;
        low.store_aligned(l.data());
        high.store_aligned(h.data());
        return {Vec3(l[0], l[1], l[2]), Vec3(h[0], h[1], h[2])};
    }
};

// What the builder knows of a set of items.
struct Extent {
    Bounds bounds, centers; ///< of the boxes, and of their centres (doubled)
    unsigned kinds = 0;     ///< a bit for each kind that occurs

    void extend(const BuildItem& item) {
        bounds.extend(low_corner(item), high_corner(item));
        const Four center = doubled_center(item);
        centers.extend(center, center);
        kinds |= 1u << static_cast<unsigned>(item.kind);
    }
    void extend(const Extent& other) {
        bounds.extend(other.bounds);
        centers.extend(other.centers);
        kinds |= other.kinds;
    }
    bool one_center() const { return (lane_bits(centers.low == centers.high) & 7u) == 7u; }
    bool one_kind() const { return (kinds & (kinds - 1)) == 0; }
};

Extent extent_of(std::span<const BuildItem> items) {
    Extent extent;
    for (const BuildItem& item : items) extent.extend(item);
    return extent;
}

// The cost of testing so many primitives: by the block; of instances each is a hierarchy of its own. (That a block of
// quads takes longer than one of spheres changes no tree that was tried.)
class Tests {
public:
    explicit Tests(unsigned kinds)
        : shift_(kinds == 1u << static_cast<unsigned>(PrimitiveKind::kInstance) ? 0 : std::countr_zero(kBlockSize)) {}
    float operator()(std::size_t count) const {
        return static_cast<float>((count + (std::size_t{1} << shift_) - 1) >> shift_);
    }

private:
    int shift_;
};

// Maps centres to bins of equal width on each axis; axes on which the centres have no extent have one bin.
class Binning {
public:
    Binning(const Extent& extent, std::size_t count) : low_(extent.centers.low) {
        // Few items: few bins, as their evaluation would cost more than it gains.
        bins = std::min(kMaxBins, 4 + count / 16);
        const Four width = extent.centers.high - extent.centers.low;
        const Four scale = Four(static_cast<float>(bins)) / width;
        const auto usable = (width > Four(0.0f)) & (scale < Four(kInfinity));
        scale_ = xsimd::select(usable, scale, Four(0.0f));
        usable_ = lane_bits(usable);
    }
    bool usable(std::size_t axis) const { return (usable_ >> axis & 1) != 0; }
    std::array<std::int32_t, 4> bin(const BuildItem& item) const {
        const Four place = (doubled_center(item) - low_) * scale_;
        const auto index = xsimd::min(xsimd::to_int(place), xsimd::batch<std::int32_t, Four::arch_type>(static_cast<std::int32_t>(bins) - 1));
        alignas(16) std::array<std::int32_t, 4> result;
        index.store_aligned(result.data());
        return result;
    }

    std::size_t bins;

private:
    Four low_, scale_;
    unsigned usable_;
};

struct Bin {
    Bounds bounds;
    std::size_t count = 0;

    void extend(const Bin& other) {
        bounds.extend(other.bounds);
        count += other.count;
    }
};
using Bins = std::array<std::array<Bin, kMaxBins>, 3>;

void fill(Bins& bins, std::span<const BuildItem> items, const Binning& binning) {
    for (const BuildItem& item : items) {
        const auto index = binning.bin(item);
        const Four low = low_corner(item), high = high_corner(item);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Bin& bin = bins[axis][static_cast<std::size_t>(index[axis])];
            bin.bounds.extend(low, high);
            ++bin.count;
        }
    }
}

// Half the surface area of boxes inside a larger one, as a part of the larger one's: in range whatever the scale.
class RelativeArea {
public:
    explicit RelativeArea(const Bounds& whole) {
        const Vec3 size = whole.box().diagonal();
        const float largest = max_component(size);
        scale_ = Four(largest > 0 ? 1 / max(largest, 0x1p-126f) : 0.0f);
        const float area = half(whole);
        per_area_ = area > 0 ? 1 / area : 0;
    }
    float operator()(const Bounds& bounds) const { return half(bounds) * per_area_; }

private:
    float half(const Bounds& bounds) const {
        alignas(16) std::array<float, 4> d;
        ((bounds.high - bounds.low) * scale_).store_aligned(d.data());
        return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
    }
    Four scale_;
    float per_area_;
};

struct Split {
    std::size_t axis = 0;
    std::int32_t bin = 0; // items in bins up to `bin` go left
    float cost = 0;
};

// The cheapest of the planes between bins; none where all centres are one point.
std::optional<Split> best_split(const Bins& bins, const Binning& binning, const RelativeArea& area,
                                const Tests& tests, std::size_t count) {
    std::optional<Split> best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!binning.usable(axis)) continue;
        std::array<float, kMaxBins> right_cost;
        Bin right;
        for (std::size_t i = binning.bins; i-- > 1;) {
            right.extend(bins[axis][i]);
            right_cost[i] = right.count > 0 ? area(right.bounds) * tests(right.count) : 0;
        }
        Bin left;
        for (std::size_t i = 0; i + 1 < binning.bins; ++i) {
            left.extend(bins[axis][i]);
            if (left.count == 0 || left.count == count) continue;
            const float cost = area(left.bounds) * tests(left.count) + right_cost[i + 1];
            if (!best || cost < best->cost) best = Split{axis, static_cast<std::int32_t>(i), cost};
        }
    }
    if (best) best->cost += kStepCost;
    return best;
}

// An instance is a hierarchy of its own: a box around each pays.
std::size_t largest_leaf(PrimitiveKind kind) { return kind == PrimitiveKind::kInstance ? 1 : Bvh::kMaxLeaf; }

// A set of items that has become two, the left one's in front.
struct Halves {
    std::size_t left_count = 0;
    Extent left, right;
};

template <typename GoesLeft> Halves divide(Items items, const GoesLeft& goes_left) {
    Halves halves;
    std::size_t begin = 0, end = items.size();
    for (;;) {
        for (; begin < end && goes_left(items[begin]); ++begin) halves.left.extend(items[begin]);
        for (; begin < end && !goes_left(items[end - 1]); --end) halves.right.extend(items[end - 1]);
        if (begin == end) break;
        std::swap(items[begin], items[end - 1]);
    }
    halves.left_count = begin;
    return halves;
}

// The same by all threads, through a second array: each chunk's items keep their order.
template <typename GoesLeft>
Halves divide_in_parallel(Items items, BuildItems& copy, int threads, const GoesLeft& goes_left) {
    const std::size_t chunks = (items.size() + kChunk - 1) / kChunk;
    std::vector<Halves> parts(chunks);
    const auto chunk = [&](std::size_t i) { return items.subspan(i * kChunk, std::min(kChunk, items.size() - i * kChunk)); };
    parallel_for(chunks, threads, [&](std::size_t i) {
        for (const BuildItem& item : chunk(i)) {
            const bool left = goes_left(item);
            (left ? parts[i].left : parts[i].right).extend(item);
            parts[i].left_count += left ? 1 : 0;
        }
    });
    Halves halves;
    std::vector<std::size_t> left_begin(chunks), right_begin(chunks);
    for (std::size_t i = 0; i < chunks; ++i) {
        left_begin[i] = halves.left_count;
        halves.left_count += parts[i].left_count;
        halves.left.extend(parts[i].left);
        halves.right.extend(parts[i].right);
    }
    std::size_t right = halves.left_count;
    for (std::size_t i = 0; i < chunks; ++i) {
        right_begin[i] = right;
        right += chunk(i).size() - parts[i].left_count;
    }
    if (copy.size() < items.size()) copy = BuildItems(items.size());
    parallel_for(chunks, threads, [&](std::size_t i) {
        std::size_t l = left_begin[i], r = right_begin[i];
        for (const BuildItem& item : chunk(i)) copy[goes_left(item) ? l++ : r++] = item;
    });
    parallel_for(chunks, threads, [&](std::size_t i) {
        const Items target = chunk(i);
        std::copy_n(copy.begin() + static_cast<std::ptrdiff_t>(i * kChunk), target.size(), target.begin());
    });
    return halves;
}

// Subtrees of at most `job_size` items are left as placeholders, to be built by several threads at once.
struct Job {
    std::size_t node;
    std::size_t first, count;
    Extent extent;
    int depth;
};

class Builder {
public:
    Builder(Items items, std::size_t job_size, int threads, const DropTwins& drop_twins)
        : items_(items), job_size_(job_size), threads_(threads), drop_twins_(drop_twins) {}

    std::vector<BinaryNode> nodes;
    std::vector<Job> jobs;

    std::uint32_t build(std::size_t first, std::size_t count, const Extent& extent, int depth) {
        const auto index = static_cast<std::uint32_t>(nodes.size());
        nodes.emplace_back();
        // Boxes cannot tell these apart: without this a ray at n twins would test all n.
        if (count > Bvh::kMaxLeaf && extent.one_center() && drop_twins_) count = drop_twins_(items_.subspan(first, count));
        if (count <= job_size_) {
            jobs.push_back({index, first, count, extent, depth});
            return index;
        }
        nodes[index].box = extent.bounds.box();
        const std::optional<Halves> halves = split(items_.subspan(first, count), extent, depth);
        if (halves) {
            const std::size_t left_count = halves->left_count;
            const std::uint32_t left = build(first, left_count, halves->left, depth + 1);
            const std::uint32_t right = build(first + left_count, count - left_count, halves->right, depth + 1);
            nodes[index].left = left;
            nodes[index].right = right;
        } else {
            nodes[index].first = static_cast<std::uint32_t>(first);
            nodes[index].count = static_cast<std::uint32_t>(count);
        }
        return index;
    }

private:
    // None where the items are a leaf.
    std::optional<Halves> split(Items items, const Extent& extent, int depth) {
        if (items.size() == 1) return std::nullopt;
        const bool can_be_leaf = extent.one_kind() && items.size() <= largest_leaf(items[0].kind);
        const Binning binning(extent, items.size());
        const Tests tests(extent.kinds);
        std::optional<Split> best;
        if (depth < kSahDepth) {
            const Bins& bins = binned(items, binning);
            best = best_split(bins, binning, RelativeArea(extent.bounds), tests, items.size());
        }
        if (can_be_leaf && (!best || best->cost >= tests(items.size()))) return std::nullopt;
        if (best) {
            const auto goes_left = [&](const BuildItem& item) { return binning.bin(item)[best->axis] <= best->bin; };
            if (items.size() > 2 * kChunk) return divide_in_parallel(items, copy_, threads_, goes_left);
            return divide(items, goes_left);
        }
        // All in one place (or too deep): by kind where only that keeps them from being a leaf, else by count.
        if (items.size() <= Bvh::kMaxLeaf && !extent.one_kind())
            return divide(items, [kind = items[0].kind](const BuildItem& item) { return item.kind == kind; });
        const std::size_t half = items.size() / 2;
        return Halves{half, extent_of(items.first(half)), extent_of(items.subspan(half))};
    }

    const Bins& binned(Items items, const Binning& binning) {
        const auto clear = [&](Bins& bins) {
            for (auto& axis : bins) std::fill_n(axis.begin(), binning.bins, Bin());
        };
        clear(bins_);
        if (items.size() <= 2 * kChunk) {
            fill(bins_, items, binning);
            return bins_;
        }
        const std::size_t chunks = (items.size() + kChunk - 1) / kChunk;
        std::vector<Bins> parts(chunks);
        parallel_for(chunks, threads_, [&](std::size_t i) {
            fill(parts[i], items.subspan(i * kChunk, std::min(kChunk, items.size() - i * kChunk)), binning);
        });
        for (const Bins& part : parts)
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (std::size_t i = 0; i < binning.bins; ++i) bins_[axis][i].extend(part[axis][i]);
        return bins_;
    }

    Items items_;
    std::size_t job_size_;
    int threads_;
    const DropTwins& drop_twins_;
    Bins bins_;
    BuildItems copy_;
};

// Moves a subtree's nodes behind those of the tree; its root takes the placeholder's seat.
void graft(std::vector<BinaryNode>& tree, std::size_t seat, const std::vector<BinaryNode>& subtree) {
    const auto offset = static_cast<std::uint32_t>(tree.size()) - 1;
    const auto rebased = [&](BinaryNode node) {
        if (!node.leaf()) {
            node.left += offset;
            node.right += offset;
        }
        return node;
    };
    tree[seat] = rebased(subtree[0]);
    std::transform(subtree.begin() + 1, subtree.end(), std::back_inserter(tree), rebased);
}

} // namespace

BinaryTree build_binary_tree(BuildItems items, int threads, const DropTwins& drop_twins) {
    BinaryTree tree{{}, std::move(items)};
    if (tree.items.empty()) return tree;
    if (tree.items.size() > (std::size_t{1} << 31)) throw Error(message(tree.items.size(), " primitives: too many"));

    // The division into jobs depends on the input alone, so that the tree does, too.
    constexpr std::size_t kJobs = 64, kSmallestJob = 4096;
    Builder top(tree.items, std::max(tree.items.size() / kJobs, kSmallestJob), threads, drop_twins);
    top.build(0, tree.items.size(), extent_of(tree.items), 0);
    std::vector<std::vector<BinaryNode>> subtrees(top.jobs.size());
    parallel_for(top.jobs.size(), threads, [&](std::size_t i) {
        const Job& job = top.jobs[i];
        Builder builder(tree.items, 0, 1, drop_twins);
        builder.nodes.reserve(job.count);
        builder.build(job.first, job.count, job.extent, job.depth);
        subtrees[i] = std::move(builder.nodes);
    });
    tree.nodes = std::move(top.nodes);
    std::size_t size = tree.nodes.size();
    for (const auto& subtree : subtrees) size += subtree.size();
    tree.nodes.reserve(size);
    for (std::size_t i = 0; i < subtrees.size(); ++i) graft(tree.nodes, top.jobs[i].node, subtrees[i]);
    return tree;
}

} // namespace duet::raytrace
