// Computes the irradiance from triangles and parallelograms in closed form (Lambert 1760; Arvo 1995, "Analytic Methods
// for Simulated Light Transport", §4.1.1), for one point or a batch of points. Applied to a linearly transformed
// polygon, the same formula gives the light that a specular lobe reflects (Heitz et al. 2016, "Real-Time
// Polygonal-Light Shading with Linearly Transformed Cosines").
#pragma once

#include "raster/geometry/lane_math.h"

namespace duet::raster {

/// Holds a triangle (corner, corner + u, corner + v), or the parallelogram with the fourth vertex corner + u + v,
/// relative to the point that receives light, whose normal is +z. Edges are stored rather than vertices because their
/// differences would lose the digits that a small or distant light needs.
template <typename T> struct PolygonT {
    Vec3T<T> corner, u, v;
};

namespace polygon {

/// Returns the z component of a × b.
template <typename T> T cross_z(const Vec3T<T>& a, const Vec3T<T>& b) {
    return product_difference(a.x, b.y, a.y, b.x);
}
/// Returns 1 / |a|, and 1e15 for vectors shorter than 1e-15.
template <typename T> T inverse_length(const Vec3T<T>& a) { return inverse_sqrt(max(T(dot(a, a)), T(1e-30f))); }

/// Returns the angle between a and b times the z component of the unit vector along a × b, whose z is given.
template <typename T>
T edge_term(const Vec3T<T>& a, const Vec3T<T>& b, T inverse_a, T inverse_b, T cross_z) {
    const T scale = inverse_a * inverse_b, cosine = dot(a, b) * scale;
    const MaskOf<T> obtuse = cosine < T(0);
    T ratio = angle_over_sine(abs(cosine));
    if (any_lane(obtuse)) {
        const Vec3T<T> sine = cross(a, b) * scale;
        ratio = select(obtuse, T(kPi) * inverse_sqrt(max(T(dot(sine, sine)), T(1e-12f))) - ratio, ratio);
    }
    return cross_z * scale * ratio;
}

/// Represents a polygon's vertices relative to the corner, and its edges.
template <std::size_t N, typename T> struct Outline {
    std::array<Vec3T<T>, N> offset, edge, vertex;

    explicit Outline(const PolygonT<T>& p) {
        if constexpr (N == 4)
            offset = {Vec3T<T>(), p.u, p.u + p.v, p.v}, edge = {p.u, p.v, -p.u, -p.v};
        else
            offset = {Vec3T<T>(), p.u, p.v}, edge = {p.u, p.v - p.u, -p.v};
        for (std::size_t i = 0; i < N; ++i) vertex[i] = p.corner + offset[i];
    }
};

/// Returns the sum of the edges' terms if no lane's polygon reaches below the horizon.
template <std::size_t N, typename T> T whole_sum(const Outline<N, T>& p) {
    std::array<T, N> inverse;
    for (std::size_t i = 0; i < N; ++i) inverse[i] = inverse_length(p.vertex[i]);
    T sum(0);
    for (std::size_t i = 0; i < N; ++i) {
        const std::size_t j = (i + 1) % N;
        sum = sum + edge_term(p.vertex[i], p.vertex[j], inverse[i], inverse[j], cross_z(p.vertex[i], p.edge[i]));
    }
    return sum;
}

/// Returns the sum of the terms of the edges clipped to the upper half-space, and of the edge along the horizon that
/// closes the clipped polygon.
template <std::size_t N, typename T> T clipped_sum(const Outline<N, T>& p) {
    const T none(0), all(1);
    // The boundary leaves the upper half-space and returns to it at these points, relative to the corner.
    Vec3T<T> leaving, returning;
    T sum(0);
    for (std::size_t i = 0; i < N; ++i) {
        const Vec3T<T>&a = p.vertex[i], &b = p.vertex[(i + 1) % N], &edge = p.edge[i];
        const MaskOf<T> a_below = a.z < none, b_below = b.z < none;
        const T cut = a.z / (a.z - b.z); // used only where one end is below
        const T from = select(a_below, cut, none), to = select(b_below, cut, all);
        const auto along = [&](T t) { return Vec3T<T>(a.x + edge.x * t, a.y + edge.y * t, a.z); };
        Vec3T<T> first = along(from), last = along(to);
        first.z = select(a_below, none, a.z), last.z = select(b_below, none, b.z);
        const T term = edge_term(first, last, inverse_length(first), inverse_length(last),
                                 T(cross_z(a, edge) * (to - from)));
        sum = sum + select(a_below & b_below, none, term);
        const Vec3T<T> at(p.offset[i].x + edge.x * cut, p.offset[i].y + edge.y * cut, none);
        leaving = select((!a_below) & b_below, at, leaving);
        returning = select(a_below & (!b_below), at, returning);
    }
    const auto flat = [&](const Vec3T<T>& offset) {
        return Vec3T<T>(p.vertex[0].x + offset.x, p.vertex[0].y + offset.y, none);
    };
    const Vec3T<T> a = flat(leaving), b = flat(returning);
    return sum + edge_term(a, b, inverse_length(a), inverse_length(b), cross_z(a, returning - leaving));
}

} // namespace polygon

/// Polygons that are smaller than this fraction of their distance count as points. The error is then below 3e-4 of the
/// value, except at the horizon, where it is below 1 % of what the polygon would give at the zenith.
inline constexpr float kFarPolygon = 1.0f / 32;

/// Returns ∫ max(0, z) dw over the solid angle of a triangle (N = 3) or parallelogram (N = 4), clipped to z ≥ 0. This
/// is the irradiance per unit of radiance, in [−π, π]. It is positive on the polygon's front side, to which u × v
/// points. Results in lanes outside `lanes` are unspecified.
template <std::size_t N, typename T> T polygon_form_factor_times_pi(const PolygonT<T>& p, const MaskOf<T>& lanes) {
    static_assert(N == 3 || N == 4);
    const Vec3T<T> center = p.corner + (p.u + p.v) * T(N == 4 ? 0.5f : 1.0f / 3);
    const T squared = dot(center, center);
    const MaskOf<T> far = dot(p.u, p.u) + dot(p.v, p.v) < T(kFarPolygon * kFarPolygon) * squared;
    T result(0);
    if (any_lane(far & lanes)) {
        const T over = T(1) / squared;
        result = dot(cross(p.v, p.u), center) * max(center.z, T(0)) * (over * over * T(N == 4 ? 1.0f : 0.5f));
    }
    if (any_lane((!far) & lanes)) {
        const polygon::Outline<N, T> outline(p);
        T lowest = outline.vertex[0].z;
        for (std::size_t i = 1; i < N; ++i) lowest = min(lowest, outline.vertex[i].z);
        const T sum = any_lane((lowest < T(0)) & lanes) ? polygon::clipped_sum(outline) : polygon::whole_sum(outline);
        result = select(far, result, sum * T(-0.5f));
    }
    return clamp(result, T(-kPi), T(kPi));
}

} // namespace duet::raster
