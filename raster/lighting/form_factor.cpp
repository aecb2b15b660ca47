#include "raster/lighting/form_factor.h"

#include "common/system/error.h"
#include "common/vec/robust.h"

#include <array>
#include <cmath>
#include <limits>

namespace duet {

namespace {

constexpr std::size_t kMaxVertices = 8; ///< of a polygon, before it is clipped to the hemisphere
/// Below this ratio of extent to distance a polygon is treated as a point. The terms of Lambert's sum are of the
/// order of this ratio and cancel down to its square. At this ratio, Lambert's sum and the far field are both
/// accurate to about ten digits.
constexpr double kFarFieldRatio = 1e-5;

Vec3d precise_cross(Vec3d a, Vec3d b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

/// Represents a convex polygon, with vertices relative to p. Clipping by one plane adds at most one vertex.
struct Polygon {
    std::array<Vec3d, kMaxVertices + 1> v;
    std::size_t count = 0;

    void add(Vec3d vertex) {
        if (count < v.size()) v[count++] = vertex;
    }
    Vec3d next(std::size_t i) const { return v[i + 1 < count ? i + 1 : 0]; }
};

/// Clips the polygon to the half-space n·v ≥ 0 (Sutherland and Hodgman 1974, for one plane).
Polygon clip_to_hemisphere(const Polygon& polygon, Vec3d n) {
    Polygon clipped;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const Vec3d a = polygon.v[i], b = polygon.next(i);
        const double za = dot(n, a), zb = dot(n, b);
        if (za >= 0) clipped.add(a);
        if ((za > 0 && zb < 0) || (za < 0 && zb > 0)) {
            // The cut is computed from the vertex above to the vertex below, so that two polygons that share the edge
            // cut it at the same point.
            const Vec3d top = za > 0 ? a : b, bottom = za > 0 ? b : a;
            const double t = max(za, zb) / std::abs(za - zb);
            const Vec3d cut = top + (bottom - top) * t;
            clipped.add(cut - n * dot(n, cut));
        }
    }
    return clipped;
}

/// Returns Lambert's term of an edge: the angle that the edge subtends, times the cosine between n and the normal of
/// the plane through p and the edge.
double edge_term(Vec3d a, Vec3d b, Vec3d n) {
    const Vec3d c = precise_cross(a, b);
    const double sine = length(c);
    if (!(sine > 0)) return 0; // the edge has no extent or passes through p
    return std::atan2(sine, dot(a, b)) * dot(c, n) / sine;
}

/// Holds a polygon's vector area and its area-weighted centroid relative to p.
struct FarField {
    Vec3d area, centroid;
};
FarField far_field(const Polygon& polygon) {
    const Vec3d origin = polygon.v[0];
    Vec3d area, moment;
    for (std::size_t i = 1; i + 1 < polygon.count; ++i) {
        const Vec3d a = polygon.v[i] - origin, b = polygon.v[i + 1] - origin;
        const Vec3d triangle_area = cross(a, b) * 0.5;
        area += triangle_area;
        moment += (a + b) * (length(triangle_area) / 3);
    }
    const double total = length(area);
    return {area, total > 0 ? origin + moment / total : origin};
}

double extent_over_distance(const Polygon& polygon) {
    double extent2 = 0, nearest2 = length_squared(polygon.v[0]);
    for (std::size_t i = 1; i < polygon.count; ++i) {
        extent2 = max(extent2, length_squared(polygon.v[i] - polygon.v[0]));
        nearest2 = min(nearest2, length_squared(polygon.v[i]));
    }
    return nearest2 > 0 ? std::sqrt(extent2 / nearest2) : std::numeric_limits<double>::infinity();
}

double polygon_factor(const Polygon& polygon, Vec3d n) {
    if (polygon.count < 3) return 0;
    const Vec3d area = far_field(polygon).area;
    // For p in the polygon's plane the solid angle is zero, or jumps from zero to the hemisphere. No value is right
    // for both sides, so the result is 0.
    if (std::abs(dot(area, polygon.v[0])) <= 1e-14 * length(area) * length(polygon.v[0])) return 0;

    const Polygon visible = clip_to_hemisphere(polygon, n);
    if (visible.count < 3) return 0;
    if (extent_over_distance(visible) < kFarFieldRatio) {
        const FarField far = far_field(visible);
        const double d2 = length_squared(far.centroid);
        return std::abs(dot(far.area, far.centroid)) * max(dot(n, far.centroid), 0.0) / (d2 * d2);
    }
    double sum = 0;
    for (std::size_t i = 0; i < visible.count; ++i) sum += edge_term(visible.v[i], visible.next(i), n);
    return min(std::abs(sum) / 2, kPiDouble);
}

} // namespace

double polygon_form_factor_times_pi(Vec3 p, Vec3 n, std::span<const Vec3> polygon) {
    DUET_CHECK_LE(polygon.size(), kMaxVertices);
    Polygon relative;
    for (const Vec3 vertex : polygon) relative.add(Vec3d(vertex) - Vec3d(p));
    return polygon_factor(relative, Vec3d(n));
}

double polygon_form_factor_times_pi(Vec3 p, Vec3 n, const Quad& quad) {
    const Vec3d corner = Vec3d(quad.corner) - Vec3d(p), u(quad.u), v(quad.v);
    Polygon polygon;
    for (const Vec3d vertex : {corner, corner + u, corner + u + v, corner + v}) polygon.add(vertex);
    return polygon_factor(polygon, Vec3d(n));
}

} // namespace duet
