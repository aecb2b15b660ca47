// Polygons into triangles: the one triangulation that both pipelines share.
#pragma once

#include "common/vec/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace duet {

/// Ear clipping takes time quadratic in the corners.
inline constexpr std::size_t kMaxConcaveCorners = 10'000;

/// Splits a polygon of n ≥ 3 corners into n − 2 triangles of its orientation, appended as indices of corners. A quad is
/// split along its shorter diagonal (the first where equal), a concave one along the one that lies inside; another
/// convex polygon is a fan around corner 0; a concave one is cut ear by ear (Meisters 1975), the best-shaped ear first
/// among neighbours. Decided in double on the plane of the two axes in which the polygon's area (Newell's normal) is
/// largest, by signs that are right at any scale or offset. A polygon that crosses itself or has no area still yields n
/// − 2 triangles, which need not be what one hoped for. Returns false, having appended nothing, for a concave polygon
/// of more than kMaxConcaveCorners corners.
bool triangulate(std::span<const Vec3> polygon, std::vector<std::array<std::uint32_t, 3>>& triangles);

/// The polygon's normal by Newell's method, its length twice the area; zero for one without area. Exact in direction
/// for a planar polygon up to rounding in double.
Vec3d newell_normal(std::span<const Vec3> polygon);

} // namespace duet
