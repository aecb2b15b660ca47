// build_hierarchy makes packed nodes from primitives.
#pragma once

#include "raytrace/acceleration/bvh_build.h"

namespace duet::raytrace {

/// Holds a packed hierarchy and the items that its leaves refer to.
struct Hierarchy {
    BuildItems items;
    CollapsedBvh collapsed;
};

/// Builds a hierarchy over the items by binned SAH. It is the same for any number of threads (0 = all).
Hierarchy build_hierarchy(BuildItems items, const RemoveDuplicates& remove_duplicates, int threads);

} // namespace duet::raytrace
