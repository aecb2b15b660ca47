#include "raytrace/acceleration/bvh_reinsertion.h"

#include "common/system/parallel.h"

#include <algorithm>

namespace duet::raytrace {

namespace {

constexpr std::uint32_t kNone = ~0u;

bool same(const Box3& a, const Box3& b) { return a.low == b.low && a.high == b.high; }
Bounds merge(Bounds a, const Bounds& b) {
    a.extend(b);
    return a;
}

// Adds links to parents to a binary tree. to parents. Areas are relative to the root's. The root remains node 0.
class LinkedTree {
public:
    explicit LinkedTree(std::vector<BinaryNode>& nodes)
        : nodes_(nodes), area_of_(nodes[0].bounds()), parents_(nodes.size(), kNone) {
        for (std::uint32_t i = 0; i < nodes.size(); ++i)
            if (!nodes[i].leaf()) parents_[nodes[i].left] = parents_[nodes[i].right] = i;
    }

    float area(std::uint32_t node) const { return area_of_(nodes_[node].bounds()); }
    // A move removes the node's parent, but the root must stay.
    bool movable(std::uint32_t node) const { return node != 0 && parents_[node] != 0; }

    struct Move {
        std::uint32_t node, target; ///< the target becomes the node's sibling
        float gain;
    };
    struct SearchEntry {
        std::uint32_t node;
        float gain; ///< area saved above the node
    };

    /// Returns the move of a subtree that reduces the inner nodes' areas most. Its target is kNone if no move
    /// reduces them. `stack` is scratch memory.
    Move best_move(std::uint32_t node, std::vector<SearchEntry>& stack) const {
        Move best{node, kNone, 0};
        if (!movable(node)) return best;
        const Bounds box = nodes_[node].bounds();
        const float own = area_of_(box);
        const auto search = [&](std::uint32_t subtree, float gain) {
            stack.push_back({subtree, gain});
            while (!stack.empty()) {
                const SearchEntry entry = stack.back();
                stack.pop_back();
                // A new parent is at least as large as the node itself.
                if (entry.gain - own <= best.gain) continue;
                const BinaryNode& candidate = nodes_[entry.node];
                const float merged = area_of_(merge(candidate.bounds(), box));
                if (entry.gain - merged > best.gain) best = {node, entry.node, entry.gain - merged};
                if (candidate.leaf()) continue;
                const float below = entry.gain + area_of_(candidate.bounds()) - merged;
                stack.push_back({candidate.left, below});
                stack.push_back({candidate.right, below});
            }
        };
        // Walk from the node to the root. Search the sibling subtrees on the way, and try each ancestor as a target.
        float gain = area(parents_[node]); // the parent is removed
        Bounds rest = nodes_[sibling(node)].bounds(); // bounds of what remains below `child`
        search(sibling(node), gain);
        for (std::uint32_t child = parents_[node]; child != 0; child = parents_[child]) {
            const std::uint32_t beside = sibling(child), parent = parents_[child];
            search(beside, gain);
            rest.extend(nodes_[beside].bounds());
            gain -= area_of_(rest);
            if (parent != 0 && gain > best.gain) best = {node, parent, gain};
            gain += area(parent);
        }
        return best;
    }

    /// Makes a move if it is still possible and still a gain after the moves before it. Returns the gain, or 0.
    float apply(const Move& move) {
        if (!movable(move.node) || move.target == parents_[move.node]) return 0;
        for (std::uint32_t i = move.target; i != kNone; i = parents_[i])
            if (i == move.node) return 0;
        const std::uint32_t from = sibling(move.node);
        const double gain = attach(move.node, move.target);
        if (gain > 0) {
            log_.push_back({move.node, from});
            return static_cast<float>(gain);
        }
        attach(move.node, from);
        return 0;
    }

    /// Undoes all moves.
    void restore() {
        for (; !log_.empty(); log_.pop_back()) attach(log_.back().node, log_.back().sibling);
    }

    int depth(std::uint32_t node = 0) const {
        return nodes_[node].leaf() ? 0 : 1 + std::max(depth(nodes_[node].left), depth(nodes_[node].right));
    }

private:
    std::uint32_t sibling(std::uint32_t node) const {
        const BinaryNode& parent = nodes_[parents_[node]];
        return parent.left == node ? parent.right : parent.left;
    }

    void replace_child(std::uint32_t parent, std::uint32_t child, std::uint32_t by) {
        (nodes_[parent].left == child ? nodes_[parent].left : nodes_[parent].right) = by;
        parents_[by] = parent;
    }

    // Recomputes the boxes from a node up to the root, and returns by how much their areas shrink.
    double refit(std::uint32_t node) {
        double gain = 0;
        for (; node != kNone; node = parents_[node]) {
            Box3 box = nodes_[nodes_[node].left].box;
            box.extend(nodes_[nodes_[node].right].box);
            if (same(box, nodes_[node].box)) break;
            gain += area(node);
            nodes_[node].box = box;
            gain -= area(node);
        }
        return gain;
    }

    // Removes a subtree together with its parent, and inserts them as the target's sibling and parent. Returns the
    // gain.
    double attach(std::uint32_t node, std::uint32_t target) {
        const std::uint32_t parent = parents_[node], rest = sibling(node);
        double gain = area(parent);
        replace_child(parents_[parent], parent, rest);
        gain += refit(parents_[rest]);
        replace_child(parents_[target], target, parent);
        nodes_[parent].left = target;
        nodes_[parent].right = node;
        parents_[target] = parents_[node] = parent;
        nodes_[parent].box = nodes_[target].box;
        nodes_[parent].box.extend(nodes_[node].box);
        return gain - area(parent) + refit(parents_[parent]);
    }

    struct Origin {
        std::uint32_t node, sibling; // the moved node, and its former sibling
    };

    std::vector<BinaryNode>& nodes_;
    RelativeArea area_of_;
    std::vector<std::uint32_t> parents_;
    std::vector<Origin> log_;
};

bool by_gain(const LinkedTree::Move& a, const LinkedTree::Move& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.node < b.node;
}

// Returns the movable nodes with the largest areas. No node is larger than its parent, so they are found from the
// root down.
std::vector<LinkedTree::Move> largest(const std::vector<BinaryNode>& nodes, const LinkedTree& tree, std::size_t count) {
    std::vector<LinkedTree::Move> result, next{{0, kNone, tree.area(0)}};
    const auto smaller = [](const LinkedTree::Move& a, const LinkedTree::Move& b) { return by_gain(b, a); };
    while (result.size() < count && !next.empty()) {
        std::pop_heap(next.begin(), next.end(), smaller);
        const LinkedTree::Move node = next.back();
        next.pop_back();
        if (tree.movable(node.node)) result.push_back(node);
        if (nodes[node.node].leaf()) continue;
        for (const std::uint32_t child : {nodes[node.node].left, nodes[node.node].right}) {
            next.push_back({child, kNone, tree.area(child)});
            std::push_heap(next.begin(), next.end(), smaller);
        }
    }
    return result;
}

} // namespace

void reinsert(BinaryTree& tree, std::size_t candidates, int rounds, int threads) {
    if (tree.nodes.size() < 5) return; // no node is movable
    constexpr std::size_t kChunk = 64;
    LinkedTree linked(tree.nodes);
    for (int round = 0; round < rounds; ++round) {
        std::vector<LinkedTree::Move> moves = largest(tree.nodes, linked, candidates);
        parallel_for((moves.size() + kChunk - 1) / kChunk, threads, [&](std::size_t chunk) {
            std::vector<LinkedTree::SearchEntry> stack;
            const std::size_t end = std::min(moves.size(), (chunk + 1) * kChunk);
            for (std::size_t i = chunk * kChunk; i < end; ++i) moves[i] = linked.best_move(moves[i].node, stack);
        });
        std::erase_if(moves, [](const LinkedTree::Move& move) { return move.target == kNone; });
        std::sort(moves.begin(), moves.end(), by_gain);
        double gain = 0;
        for (const LinkedTree::Move& move : moves) gain += linked.apply(move);
        if (!(gain > 0)) break;
    }
    if (linked.depth() > Bvh::kMaxDepth) linked.restore();
}

} // namespace duet::raytrace
