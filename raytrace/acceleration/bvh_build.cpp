#include "raytrace/acceleration/bvh_build.h"

#include "common/system/error.h"
#include "common/system/parallel.h"
#include "raytrace/acceleration/bvh_binning.h"

#include <algorithm>
#include <optional>

namespace duet::raytrace {

namespace {

// Partitions the items like `partition_items`, but in parallel and through a second array, `copy`. Items of one chunk
// keep their order.
template <typename GoesLeft>
Partition partition_in_parallel(Items items, BuildItems& copy, int threads, const GoesLeft& goes_left) {
    const std::size_t chunks = (items.size() + kChunk - 1) / kChunk;
    std::vector<Partition> chunk_partitions(chunks);
    const auto chunk = [&](std::size_t i) {
        return items.subspan(i * kChunk, std::min(kChunk, items.size() - i * kChunk));
    };
    parallel_for(chunks, threads, [&](std::size_t i) {
        for (const BuildItem& item : chunk(i)) {
            const bool left = goes_left(item);
            (left ? chunk_partitions[i].left : chunk_partitions[i].right).extend(item);
            chunk_partitions[i].left_count += left ? 1 : 0;
        }
    });
    Partition partition;
    std::vector<std::size_t> left_begin(chunks), right_begin(chunks);
    for (std::size_t i = 0; i < chunks; ++i) {
        left_begin[i] = partition.left_count;
        partition.left_count += chunk_partitions[i].left_count;
        partition.left.extend(chunk_partitions[i].left);
        partition.right.extend(chunk_partitions[i].right);
    }
    std::size_t right = partition.left_count;
    for (std::size_t i = 0; i < chunks; ++i) {
        right_begin[i] = right;
        right += chunk(i).size() - chunk_partitions[i].left_count;
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
    return partition;
}

// Describes a subtree of at most `job_size` items. The builder leaves a placeholder node for it, so that several
// threads can build these subtrees at once.
struct Job {
    std::size_t node;
    std::size_t first, count;
    Extent extent;
    int depth;
    bool deduplicated;
};

class Builder {
public:
    Builder(Items items, std::size_t job_size, int threads, const RemoveDuplicates& remove_duplicates)
        : items_(items), job_size_(job_size), threads_(threads), remove_duplicates_(remove_duplicates) {}

    std::vector<BinaryNode> nodes;
    std::vector<Job> jobs;

    /// Builds the subtree of items [first, first + count) and returns the index of its node. `deduplicated` is true if
    /// duplicates have been removed already.
    std::uint32_t build(std::size_t first, std::size_t count, const Extent& extent, int depth, bool deduplicated) {
        const auto index = static_cast<std::uint32_t>(nodes.size());
        nodes.emplace_back();
        // Boxes cannot separate items with the same center. Without this step, a ray that reaches n duplicates would
        // test all n.
        if (count > Bvh::kMaxLeaf && extent.same_center() && remove_duplicates_ && !deduplicated) {
            count = remove_duplicates_(items_.subspan(first, count));
            deduplicated = true;
        }
        if (count <= job_size_) {
            jobs.push_back({index, first, count, extent, depth, deduplicated});
            return index;
        }
        nodes[index].box = extent.bounds.box();
        const std::optional<Partition> partition = split(items_.subspan(first, count), extent, depth);
        if (partition) {
            const std::size_t left_count = partition->left_count;
            const std::uint32_t left = build(first, left_count, partition->left, depth + 1, deduplicated);
            const std::uint32_t right =
                build(first + left_count, count - left_count, partition->right, depth + 1, deduplicated);
            nodes[index].left = left;
            nodes[index].right = right;
        } else {
            nodes[index].first = static_cast<std::uint32_t>(first);
            nodes[index].count = static_cast<std::uint32_t>(count);
        }
        return index;
    }

private:
    // Partitions the items, or returns nothing if they are to be a leaf.
    std::optional<Partition> split(Items items, const Extent& extent, int depth) {
        if (items.size() == 1) return std::nullopt;
        const bool can_be_leaf = extent.same_kind() && items.size() <= largest_leaf(items[0].kind);
        const Binning binning(extent, items.size());
        const LeafCost leaf_cost(extent.kinds);
        std::optional<Split> best;
        if (depth < kSahDepth) {
            fill(bins_, items, binning, threads_);
            best = best_split(bins_, binning, RelativeArea(extent.bounds), leaf_cost, items.size());
        }
        if (can_be_leaf && (!best || best->cost >= leaf_cost(items.size()))) return std::nullopt;
        if (best) {
            const auto goes_left = [&](const BuildItem& item) { return binning.bin(item)[best->axis] <= best->bin; };
            if (items.size() > 2 * kChunk) return partition_in_parallel(items, copy_, threads_, goes_left);
            return partition_items(items, goes_left);
        }
        return partition_without_plane(items, extent);
    }

    Items items_;
    std::size_t job_size_;
    int threads_;
    const RemoveDuplicates& remove_duplicates_;
    Bins bins_;
    BuildItems copy_;
};

// Appends the nodes of a subtree to the tree. The subtree's root replaces the placeholder node at index `slot`.
void graft(std::vector<BinaryNode>& tree, std::size_t slot, const std::vector<BinaryNode>& subtree) {
    const auto offset = static_cast<std::uint32_t>(tree.size()) - 1;
    const auto rebased = [&](BinaryNode node) {
        if (!node.leaf()) {
            node.left += offset;
            node.right += offset;
        }
        return node;
    };
    tree[slot] = rebased(subtree[0]);
    std::transform(subtree.begin() + 1, subtree.end(), std::back_inserter(tree), rebased);
}

} // namespace

BinaryTree build_binary_tree(BuildItems items, int threads, const RemoveDuplicates& remove_duplicates) {
    BinaryTree tree{{}, std::move(items)};
    if (tree.items.empty()) return tree;
    if (tree.items.size() > (std::size_t{1} << 31)) throw Error(message(tree.items.size(), " primitives: too many"));

    // The division into jobs depends only on the input, so that the tree does not depend on the number of threads.
    constexpr std::size_t kJobs = 64, kSmallestJob = 4096;
    Builder top(tree.items, std::max(tree.items.size() / kJobs, kSmallestJob), threads, remove_duplicates);
    top.build(0, tree.items.size(), extent_of(tree.items), 0, false);
    std::vector<std::vector<BinaryNode>> subtrees(top.jobs.size());
    parallel_for(top.jobs.size(), threads, [&](std::size_t i) {
        const Job& job = top.jobs[i];
        Builder builder(tree.items, 0, 1, remove_duplicates);
        builder.nodes.reserve(job.count);
        builder.build(job.first, job.count, job.extent, job.depth, job.deduplicated);
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
