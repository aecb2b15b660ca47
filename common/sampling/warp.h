// Maps from the unit square to the domains that rendering samples.
#pragma once

#include "common/vec/vec.h"

#include <cmath>

namespace duet {

/// The unit square to the unit disk, area-preserving and of low distortion; (½, ½) to the centre (Shirley and Chiu
/// 1997).
template <Arithmetic T> Vec2T<T> concentric_disk(Vec2T<T> u) {
    const T a = T(2) * u.x - T(1), b = T(2) * u.y - T(1);
    if (a == T(0) && b == T(0)) return {};
    const bool wide = std::abs(a) > std::abs(b);
    const T quarter = static_cast<T>(kPiDouble / 4);
    const T r = wide ? a : b;
    const T angle = wide ? quarter * (b / a) : 2 * quarter - quarter * (a / b);
    return {r * std::cos(angle), r * std::sin(angle)};
}

} // namespace duet
