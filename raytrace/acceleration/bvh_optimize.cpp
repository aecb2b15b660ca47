#include "raytrace/acceleration/bvh_optimize.h"

#include "common/system/parallel.h"

#include <algorithm>

namespace duet::raytrace {

namespace {

using Four = FloatBatch<4>; // x, y, z and a zero

struct Bounds {
    Four low, high;

    Bounds operator|(const Bounds& other) const {
        return {xsimd::min(low, other.low), xsimd::max(high, other.high)};
    }
    float half_area() const {
        alignas(16) std::array<float, 4> d;
        (high - low).store_aligned(d.data());
        return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
    }
};

constexpr std::uint32_t kNone = ~0u;

// A tree with links both ways. Node 0 is the root and stays where it is.
class LinkedTree {
public:
    explicit LinkedTree(std::vector<BinaryNode> nodes)
        : nodes_(std::move(nodes)), boxes_(nodes_.size()), areas_(nodes_.size()), parents_(nodes_.size(), kNone) {
        // Sizes relative to the whole: areas stay in range.
        const Box3 whole = nodes_[0].box;
        const float largest = max_component(whole.diagonal());
        const float scale = largest > 0 ? 1 / max(largest, 0x1p-126f) : 0.0f;
        const auto four = [&](Vec3 p) {
            const Vec3 q = p * scale - whole.low * scale;
            alignas(16) const std::array<float, 4> values{q.x, q.y, q.z, 0};
            return Four::load_aligned(values.data());
        };
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            boxes_[i] = {four(nodes_[i].box.low), four(nodes_[i].box.high)};
            areas_[i] = boxes_[i].half_area();
            if (!nodes_[i].leaf()) parents_[nodes_[i].left] = parents_[nodes_[i].right] = i;
        }
    }

    std::size_t size() const { return nodes_.size(); }
    float area(std::uint32_t node) const { return areas_[node]; }
    bool movable(std::uint32_t node) const { return node != 0 && parents_[node] != 0; } // the root must stay

    struct Move {
        std::uint32_t node, target; ///< the target becomes the node's sibling
        float gain;
    };
    struct Place {
        std::uint32_t node;
        float gain; ///< of all that changes above the node
    };

    /// The move of a subtree by which the inner nodes' areas shrink most; to nowhere where none makes them shrink.
    Move best_move(std::uint32_t node, std::vector<Place>& stack) const {
        Move best{node, kNone, 0};
        if (!movable(node)) return best;
        const Bounds box = boxes_[node];
        const auto search = [&](std::uint32_t subtree, float gain) {
            stack.push_back({subtree, gain});
            while (!stack.empty()) {
                const Place place = stack.back();
                stack.pop_back();
                // A new parent is at least as large as the node itself.
                if (place.gain - areas_[node] <= best.gain) continue;
                const float merged = (boxes_[place.node] | box).half_area();
                if (place.gain - merged > best.gain) best = {node, place.node, place.gain - merged};
                if (nodes_[place.node].leaf()) continue;
                const float below = place.gain + areas_[place.node] - merged;
                stack.push_back({nodes_[place.node].left, below});
                stack.push_back({nodes_[place.node].right, below});
            }
        };
        // Up from the node: the subtrees beside the way, and the places on it.
        float gain = areas_[parents_[node]]; // the parent vanishes
        Bounds rest = boxes_[sibling(node)]; // of what is below `child` without the node
        search(sibling(node), gain);
        for (std::uint32_t child = parents_[node]; child != 0; child = parents_[child]) {
            const std::uint32_t beside = sibling(child), parent = parents_[child];
            search(beside, gain);
            rest = rest | boxes_[beside];
            gain -= rest.half_area();
            if (parent != 0 && gain > best.gain) best = {node, parent, gain};
            gain += areas_[parent];
        }
        return best;
    }

    /// Moves a subtree if that is still possible and a gain after what has been moved before; returns the gain.
    float apply(const Move& move) {
        if (!movable(move.node) || move.target == parents_[move.node]) return 0;
        for (std::uint32_t i = move.target; i != kNone; i = parents_[i])
            if (i == move.node) return 0;
        const std::uint32_t old_sibling = sibling(move.node);
        const double gain = attach(move.node, move.target);
        if (gain > 0) return static_cast<float>(gain);
        attach(move.node, old_sibling);
        return 0;
    }

    /// The nodes, children behind their parents; false where the tree is deeper than Bvh::kMaxDepth.
    bool ordered(std::vector<BinaryNode>& result) const {
        result.clear();
        result.reserve(nodes_.size());
        return copy(0, 0, result);
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

    // The boxes from here to the root; by how much their areas shrink.
    double refit(std::uint32_t node) {
        double gain = 0;
        for (; node != kNone; node = parents_[node]) {
            const Bounds box = boxes_[nodes_[node].left] | boxes_[nodes_[node].right];
            if (xsimd::all(box.low == boxes_[node].low) && xsimd::all(box.high == boxes_[node].high)) break;
            boxes_[node] = box;
            gain += areas_[node];
            areas_[node] = box.half_area();
            gain -= areas_[node];
        }
        return gain;
    }

    // Takes a subtree out, with its parent, and makes both the target's sibling and parent. Returns the gain.
    double attach(std::uint32_t node, std::uint32_t target) {
        const std::uint32_t parent = parents_[node], rest = sibling(node);
        double gain = areas_[parent];
        replace_child(parents_[parent], parent, rest);
        gain += refit(parents_[rest]);
        replace_child(parents_[target], target, parent);
        nodes_[parent].left = target;
        nodes_[parent].right = node;
        parents_[target] = parents_[node] = parent;
        boxes_[parent] = boxes_[target] | boxes_[node];
        areas_[parent] = boxes_[parent].half_area();
        return gain - areas_[parent] + refit(parents_[parent]);
    }

    bool copy(std::uint32_t from, int depth, std::vector<BinaryNode>& result) const {
        if (depth > Bvh::kMaxDepth) return false;
        const std::size_t index = result.size();
        result.push_back(nodes_[from]);
        if (nodes_[from].leaf()) return true;
        const auto child = [&](std::uint32_t BinaryNode::*side) {
            const auto seat = static_cast<std::uint32_t>(result.size());
            result[index].*side = seat;
            return copy(nodes_[from].*side, depth + 1, result);
        };
        if (!child(&BinaryNode::left) || !child(&BinaryNode::right)) return false;
        result[index].box = result[result[index].left].box;
        result[index].box.extend(result[result[index].right].box);
        return true;
    }

    std::vector<BinaryNode> nodes_; // their boxes are those of before
    std::vector<Bounds> boxes_;
    std::vector<float> areas_;
    std::vector<std::uint32_t> parents_;
};

bool by_gain(const LinkedTree::Move& a, const LinkedTree::Move& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.node < b.node;
}

// The movable nodes of the largest areas.
std::vector<LinkedTree::Move> candidates(const LinkedTree& tree, float part) {
    std::vector<LinkedTree::Move> result;
    result.reserve(tree.size());
    for (std::uint32_t i = 1; i < tree.size(); ++i)
        if (tree.movable(i)) result.push_back({i, kNone, tree.area(i)});
    const auto count = static_cast<std::size_t>(static_cast<float>(tree.size()) * part);
    if (count >= result.size()) return result;
    std::nth_element(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(count), result.end(), by_gain);
    result.resize(count);
    return result;
}

} // namespace

void reinsert(BinaryTree& tree, float part, int rounds, int threads) {
    if (tree.nodes.size() < 5) return; // too few for a subtree to move
    constexpr float kEnough = 0.001f;  // of the root's area
    constexpr std::size_t kChunk = 256;
    LinkedTree linked(tree.nodes);
    for (int round = 0; round < rounds; ++round) {
        std::vector<LinkedTree::Move> moves = candidates(linked, part);
        parallel_for((moves.size() + kChunk - 1) / kChunk, threads, [&](std::size_t chunk) {
            std::vector<LinkedTree::Place> stack;
            const std::size_t end = std::min(moves.size(), (chunk + 1) * kChunk);
            for (std::size_t i = chunk * kChunk; i < end; ++i) moves[i] = linked.best_move(moves[i].node, stack);
        });
        std::erase_if(moves, [](const LinkedTree::Move& move) { return move.target == kNone; });
        std::sort(moves.begin(), moves.end(), by_gain);
        double gain = 0;
        for (const LinkedTree::Move& move : moves) gain += linked.apply(move);
        if (getenv("VERBOSE")) fprintf(stderr, "round %d: %zu moves, gain %g\n", round, moves.size(), gain / linked.area(0));
        std::vector<BinaryNode> ordered;
        if (!linked.ordered(ordered)) break;
        tree.nodes = std::move(ordered);
        if (gain <= kEnough * linked.area(0)) break;
    }
}

} // namespace duet::raytrace
