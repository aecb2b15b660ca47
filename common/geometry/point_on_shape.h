// This file holds the formulas of surface points on quads, triangles and spheres. They are templates over the number
// type, so that one source computes one point (surface_point) or the points of a SIMD batch of paths.
#pragma once

#include "common/geometry/shading_terminator.h"
#include "common/geometry/surface_geometry.h"

#include <array>

namespace duet {

/// Holds a point of a shape in object space. T is double or a batch of doubles. Positions are computed in double from
/// the float vertices, so their only error is the final rounding to float.
template <typename T> struct PointOnShapeT {
    Vec3T<T> p;
    Vec3T<T> magnitude;  ///< sum of the magnitudes of p's terms, per axis; the error of p is a multiple of it
    Vec3T<T> ng;         ///< of any length
    bool unit = false;   ///< whether ng has unit length
    bool smooth = false; ///< whether the shape has vertex normals; else ns is ng, and terminator_offset is (0, 0, 0)
    Vec3T<T> ns;         ///< of any length
    Vec3T<T> terminator_offset; ///< vector to the smooth surface on the viewer's side (see shading_terminator_offset)
};

/// Returns the point corner + u·du + v·dv of a triangle or, where `quad` holds, of a quad.
template <typename T>
inline PointOnShapeT<T> point_on_flat(const Vec3T<T>& corner, const Vec3T<T>& du, const Vec3T<T>& dv, T u, T v,
                               MaskOf<T> quad) {
    PointOnShapeT<T> point;
    point.p = corner + du * u + dv * v;
    // The other corners of a quad are rounded sums of these three vectors.
    point.magnitude = select(quad, abs(corner) + abs(du) + abs(dv), abs(point.p));
    point.ng = cross(du, dv);
    return point;
}

/// Returns the point of a triangle with the barycentric coordinates u and v, as seen along `direction`, which may have
/// any length.
template <typename T>
inline PointOnShapeT<T> point_on_smooth_triangle(const std::array<Vec3T<T>, 3>& vertices,
                                          const std::array<Vec3T<T>, 3>& normals, T u, T v,
                                          const Vec3T<T>& direction) {
    const auto& [a, b, c] = vertices;
    PointOnShapeT<T> point = point_on_flat(a, b - a, c - a, u, v, MaskOf<T>(false));
    const T w = T(1.0) - u - v;
    point.smooth = true;
    point.ns = normals[0] * w + normals[1] * u + normals[2] * v;
    point.terminator_offset =
        shading_terminator_offset<T>(vertices, normals, {w, u, v}, point.ns, point.ng, direction);
    return point;
}

/// Returns the point of a sphere at the parameter t of a ray. Projecting onto the sphere removes the error of t along
/// the normal.
template <typename T>
inline PointOnShapeT<T> point_on_sphere(const Vec3T<T>& center, T radius, const Vec3T<T>& origin,
                                        const Vec3T<T>& direction, T t) {
    PointOnShapeT<T> point;
    point.ng = normalize(origin + direction * t - center);
    point.unit = true;
    point.p = center + point.ng * radius;
    point.magnitude = abs(point.p);
    return point;
}

/// This is twice the bound on the relative error of one rounding to float.
inline constexpr double kPointRounding = 2 * static_cast<double>(kRoundoff<float>);

/// Sets the shading normal, and the shading-terminator fix by the offset to the smooth surface. The other fields must
/// have been set. T is float or a batch of floats.
template <typename T> inline void set_shading_normal(SurfaceGeometryT<T>& point, Vec3T<T> ns, Vec3T<T> offset) {
    ns = select(is_finite(ns), ns, point.ng);
    point.ns = select(dot(ns, point.ng) < T(0), -ns, ns);
    // An offset within the error of p is ignored.
    const MaskOf<T> bulges = abs(dot(offset, point.ng)) > dot(abs(point.ng), point.p_error);
    point.terminator_normal = select(bulges, point.ns, point.ng);
    point.terminator_offset = select(bulges, offset, Vec3T<T>(T(0), T(0), T(0)));
}

/// Returns the surface geometry of a point whose object space is the world space.
template <typename T> inline auto surface_geometry(const PointOnShapeT<T>& local) {
    const auto n = to_floats(local.unit ? local.ng : normalize(local.ng));
    using F = decltype(n.x);
    SurfaceGeometryT<F> point{
        to_floats(local.p), to_floats(local.magnitude * T(kPointRounding)), n, n, n, Vec3T<F>(F(0), F(0), F(0))};
    if (local.smooth) set_shading_normal(point, to_floats(normalize(local.ns)), to_floats(local.terminator_offset));
    return point;
}

} // namespace duet
