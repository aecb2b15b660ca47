// From primitives to packed nodes, at the quality asked for.
#pragma once

#include "raytrace/acceleration/bvh_quality.h"
#include "raytrace/acceleration/bvh_spatial.h"

namespace duet::raytrace {

/// A hierarchy, and the items that its leaves name; with spatial splits there may be several of one index.
struct Hierarchy {
    BuildItems items;
    Collapsed collapsed;
};

/// What a builder has to ask of the primitives that items stand for.
struct Primitives {
    OutlineOf outline_of; ///< for spatial splits
    DropTwins drop_twins;
};

/// The same for any number of threads (0: all).
Hierarchy build_hierarchy(BuildItems items, const Primitives& primitives, BvhQuality quality, int threads);

} // namespace duet::raytrace
