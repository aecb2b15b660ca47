// This header declares curves through given points.
#pragma once

#include "common/vec/vec.h"

#include <span>
#include <vector>

namespace duet::models {

/// Returns a point on the cubic from b (f = 0) to c (f = 1) with tangents from the neighboring points (Catmull and
/// Rom 1974), for vectors of any type.
template <typename V> V catmull_rom(V a, V b, V c, V d, double f) {
    return (b * 2.0 + (c - a) * f + (a * 2.0 - b * 5.0 + c * 4.0 - d) * (f * f) +
            (b * 3.0 - a - c * 3.0 + d) * (f * f * f)) *
           0.5;
}

/// Returns count + 1 points at equal arc lengths on the spline through all points, whose end points are doubled.
std::vector<Vec2d> sample_profile(std::span<const Vec2d> points, int count);

} // namespace duet::models
