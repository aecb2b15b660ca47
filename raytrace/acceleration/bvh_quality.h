// How much work goes into a hierarchy.
#pragma once

#include <cstdint>
#include <string_view>

namespace duet::raytrace {

enum class BvhQuality {
    kDefault, ///< binned surface area heuristic, and a few moves of what lies wrong
    kHigh,    ///< moves until little is gained, and spatial splits where they pay: many times the work
};
/// "default", "high"; throws Error for another name.
BvhQuality bvh_quality(std::string_view name);

} // namespace duet::raytrace
