// This file triangulates polygons. Both pipelines share this triangulation.
#pragma once

#include "common/vec/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace duet {

/// The corners of a concave polygon are limited to this number, because the time of ear clipping is quadratic in it.
inline constexpr std::size_t kMaxConcaveCorners = 10'000;

/// Splits a polygon of n ≥ 3 corners into n − 2 triangles of the same orientation, and appends them as indices of
/// corners. A convex quad is split along its shorter diagonal (along corners 0 and 2 where both are equal), and a
/// concave quad along the diagonal that lies inside. Another convex polygon becomes a fan around corner 0. Another
/// concave polygon is split by ear clipping (Meisters 1975), ear by ear along its boundary.
///
/// The computation is in double, on the plane of the two axes in which the polygon's area (Newell's normal) is
/// largest. The signs of areas are correct at any scale or offset. A polygon that intersects itself or has no area
/// still yields n − 2 triangles, but they may overlap.
///
/// Returns false and appends nothing for a concave polygon of more than kMaxConcaveCorners corners.
bool triangulate(std::span<const Vec3> polygon, std::vector<std::array<std::uint32_t, 3>>& triangles);

/// Returns the polygon's normal by Newell's method, with twice the area as its length. It is zero for a polygon
/// without area. For a planar polygon the direction is exact up to rounding in double.
Vec3d newell_normal(std::span<const Vec3> polygon);

} // namespace duet
