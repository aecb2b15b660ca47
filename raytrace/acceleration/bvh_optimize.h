// Making a binary tree better: subtrees are taken out and put where they cost less.
#pragma once

#include "raytrace/acceleration/bvh_build.h"

namespace duet::raytrace {

/// Takes subtrees out and inserts them where the sum of the inner nodes' areas becomes smallest (Bittner, Hapala and
/// Havran 2013, «Fast Insertion-Based Optimization of Bounding Volume Hierarchies»; all searches of a round at once, as
/// in Meister and Bittner 2018, «Parallel Reinsertion for Bounding Volume Hierarchy Optimization»). In each of at most
/// `rounds` rounds the `candidates` nodes of the largest areas are tried; ends early where a round gains nothing.
/// Leaves stay as they are. The tree does not become deeper than Bvh::kMaxDepth, and is the same for any number of
/// threads (0: all).
void reinsert(BinaryTree& tree, std::size_t candidates, int rounds, int threads);

} // namespace duet::raytrace
