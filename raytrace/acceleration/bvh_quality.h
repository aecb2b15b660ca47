// The quality of a hierarchy trades build time for traversal speed.
#pragma once

#include <cstdint>
#include <string_view>

namespace duet::raytrace {

enum class BvhQuality {
    kDefault, ///< binned SAH, and reinsertion of the 1/64 of nodes with the largest areas
    kHigh,    ///< reinsertion of all nodes, and spatial splits where they pay off; many times the work
};
/// Returns the quality named "default" or "high". Throws Error for any other name.
BvhQuality bvh_quality(std::string_view name);

} // namespace duet::raytrace
