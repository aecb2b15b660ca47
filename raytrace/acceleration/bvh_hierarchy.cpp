#include "raytrace/acceleration/bvh_hierarchy.h"

namespace duet::raytrace {

Hierarchy build_hierarchy(BuildItems items, const RemoveDuplicates& remove_duplicates, int threads) {
    BinaryTree tree = build_binary_tree(std::move(items), threads, remove_duplicates);
    if (tree.nodes.empty()) return {};
    CollapsedBvh collapsed = collapse(tree, threads);
    add_list_where_faster(tree, collapsed);
    return {std::move(tree.items), std::move(collapsed)};
}

} // namespace duet::raytrace
