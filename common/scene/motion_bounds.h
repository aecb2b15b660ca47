// This header defines the bounds of an object over its motion.
#pragma once

#include "common/scene/scene.h"

namespace duet {

/// Returns the bounds of an object of the given shape over its motion. Matrix entries are interpolated linearly, so
/// points move on straight lines, and the boxes at both ends enclose all positions in between. The margins of the boxes
/// cover the rounding of the interpolated matrix.
inline Box3 motion_bounds(const Object& object, const Shape& shape) {
    Box3 box = bounds(shape, object.to_world);
    if (object.moving) box.extend(bounds(shape, object.to_world_end));
    return box;
}

} // namespace duet
