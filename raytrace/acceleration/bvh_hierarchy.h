// build_hierarchy makes packed nodes from primitives at the requested quality.
#pragma once

#include "raytrace/acceleration/bvh_quality.h"
#include "raytrace/acceleration/bvh_spatial.h"

namespace duet::raytrace {

/// Holds a packed hierarchy and the items that its leaves refer to. With spatial splits, several items may have the
/// same index.
struct Hierarchy {
    BuildItems items;
    CollapsedBvh collapsed;
};

/// Holds the functions by which a builder queries the primitives of items.
struct PrimitiveQueries {
    PolygonOf polygon_of; ///< used by spatial splits
    RemoveDuplicates remove_duplicates;
};

/// Builds a hierarchy over the items. It is the same for any number of threads (0 = all).
Hierarchy build_hierarchy(BuildItems items, const PrimitiveQueries& primitives, BvhQuality quality, int threads);

} // namespace duet::raytrace
