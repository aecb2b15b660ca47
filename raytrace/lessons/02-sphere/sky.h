// The blue-white sky of the lessons.
#pragma once

#include "common/image/rgb.h"

namespace duet::lesson {

/// White at the horizon and below, blue overhead: what a ray sees that hits nothing. The direction may have any length.
inline Rgb sky_color(Vec3 direction) {
    const float height = 0.5f * (normalize(direction).y + 1);
    return lerp(Rgb(1, 1, 1), Rgb(0.5f, 0.7f, 1), height);
}

} // namespace duet::lesson
