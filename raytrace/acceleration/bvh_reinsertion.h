// `reinsert` improves a binary tree by moving subtrees to where they cost less.
#pragma once

#include "raytrace/acceleration/bvh_build.h"

namespace duet::raytrace {

/// Removes subtrees and inserts them where the sum of the inner nodes' areas becomes smallest (Bittner, Hapala and
/// Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies"). The searches of a round run in
/// parallel, as in Meister and Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization". Each
/// of at most `rounds` rounds tries the `candidates` nodes with the largest areas; a round without gain is the last.
/// Leaves stay as they are. The tree does not become deeper than Bvh::kMaxDepth, and it is the same for any number
/// of threads (0 = all).
void reinsert(BinaryTree& tree, std::size_t candidates, int rounds, int threads);

} // namespace duet::raytrace
