#include "common/light/solid_angle.h"

#include "common/light/spherical_rectangle.h"
#include "common/light/spherical_triangle.h"
#include "common/sampling/warp.h"
#include "common/vec/frame.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet {

namespace {

using Triangle = LightTriangle;

using Plane = AreaSampling<double>;

std::optional<SolidAngleSample> if_positive(const SolidAngleSample& sample) {
    return sample.pdf > 0 ? std::optional(sample) : std::nullopt;
}

/// SubtendedTriangles are a flat shape projected to N spherical triangles.
template <std::size_t N> struct SubtendedTriangles {
    std::array<SphericalTriangle, N> triangles;
    std::array<double, N> solid_angles;
    double total = 0;
};

/// These are the limits of the solid angle, beyond which rounding errors would become visible.
constexpr double kMinSolidAngle = 1e-4, kMaxSolidAngle = 6.2;

/// Returns the spherical triangles of the shape (a fan about the first corner), with corners relative to the point p.
/// The result is empty where the shape is to be sampled by area. The decision depends on shape and point alone, so
/// that sampling and density always agree.
template <std::size_t Corners>
std::optional<SubtendedTriangles<Corners - 2>> subtended_triangles(const Plane& plane,
                                                                   const std::array<Vec3d, Corners>& corners) {
    Vec3d center;
    for (const Vec3d corner : corners) center += corner * (1.0 / Corners);
    if (!plane.near(center)) return std::nullopt;

    std::array<Vec3d, Corners> w;
    for (std::size_t i = 0; i < Corners; ++i) {
        const double d = length(corners[i]);
        if (!(d > 0)) return std::nullopt;
        w[i] = corners[i] / d;
    }
    SubtendedTriangles<Corners - 2> subtended;
    for (std::size_t i = 0; i + 2 < Corners; ++i) {
        subtended.triangles[i] = {w[0], w[i + 1], w[i + 2]};
        subtended.solid_angles[i] = subtended.triangles[i].solid_angle();
        if (!(subtended.solid_angles[i] > kMinSolidAngle)) return std::nullopt;
        subtended.total += subtended.solid_angles[i];
    }
    if (!(subtended.total < kMaxSolidAngle)) return std::nullopt;
    return subtended;
}

/// Returns the spherical rectangle of a near quad with right angles. The result is empty where the quad is to be
/// sampled by area.
std::optional<SphericalRectangle> subtended_rectangle(const QuadSeen<double>& quad) {
    if (!quad.near()) return std::nullopt;
    if (dot(quad.area_vector, quad.to_plane) == 0) return std::nullopt;
    const SphericalRectangle subtended(quad.to_plane, quad.u, quad.v);
    if (!(subtended.solid_angle() > kMinSolidAngle && subtended.solid_angle() < kMaxSolidAngle)) return std::nullopt;
    return subtended;
}

template <std::size_t N>
std::optional<SolidAngleSample> sample_subtended(const Plane& plane, const SubtendedTriangles<N>& subtended, Vec2d u) {
    double target = u.x * subtended.total; // chooses the triangle, and the remainder is reused
    std::size_t i = 0;
    while (i + 1 < N && target >= subtended.solid_angles[i]) target -= subtended.solid_angles[i++];
    const double x = std::min(target / subtended.solid_angles[i], 1.0);
    const Vec3d wi = normalize(subtended.triangles[i].sample(subtended.solid_angles[i], {x, u.y}));
    const double distance = dot(plane.area_vector, plane.to_plane) / dot(plane.area_vector, wi);
    if (!(distance > 0) || !std::isfinite(distance)) return std::nullopt;
    return SolidAngleSample{wi, distance, 1 / subtended.total};
}

// Each overload returns the shape's corners relative to p.
std::array<Vec3d, 3> corners(const Triangle& t, Vec3d p) { return {Vec3d(t.a) - p, Vec3d(t.b) - p, Vec3d(t.c) - p}; }
std::array<Vec3d, 4> corners(const Quad& q, Vec3d p) {
    const Vec3d corner = Vec3d(q.corner) - p, u(q.u), v(q.v);
    return {corner, corner + u, corner + u + v, corner + v};
}

template <typename Shape> double flat_pdf(const Shape& shape, Vec3d p, Vec3d q) {
    const Plane plane = area_seen(shape, p);
    const auto subtended = subtended_triangles(plane, corners(shape, p));
    return subtended ? 1 / subtended->total : plane.pdf(q - p);
}

/// Returns 1 − cos of the half angle of the cone that a sphere subtends, from sin² = r²/d² < 1.
double one_minus_cos_of_cone(double sin2) { return sin2 / (1 + std::sqrt(1 - sin2)); }

} // namespace

AreaSampling<double> area_seen(const Triangle& t, Vec3d p) {
    const Vec3d a(t.a);
    return {cross(Vec3d(t.b) - a, Vec3d(t.c) - a) * 0.5, a - p};
}
QuadSeen<double> area_seen(const Quad& q, Vec3d p) { return {Vec3d(q.corner), Vec3d(q.u), Vec3d(q.v), p}; }

bool is_rectangle(const Quad& q) {
    const double cosine = dot(Vec3d(q.u), Vec3d(q.v));
    return cosine * cosine <= 1e-12 * length_squared(Vec3d(q.u)) * length_squared(Vec3d(q.v));
}

std::optional<SolidAngleSample> sample_solid_angle(const Triangle& t, Vec3d p, Vec2d u) {
    const Plane plane = area_seen(t, p);
    const std::array<Vec3d, 3> c = corners(t, p);
    if (const auto subtended = subtended_triangles(plane, c)) return sample_subtended(plane, *subtended, u);
    const Vec2d b = uniform_triangle(u);
    return if_positive(plane.sample(c[0] + (c[1] - c[0]) * b.x + (c[2] - c[0]) * b.y));
}
double solid_angle_pdf(const Triangle& t, Vec3d p, Vec3d q) { return flat_pdf(t, p, q); }

std::optional<SolidAngleSample> sample_solid_angle(const Quad& q, Vec3d p, Vec2d u) {
    const QuadSeen<double> quad = area_seen(q, p);
    if (is_rectangle(q)) {
        if (const auto subtended = subtended_rectangle(quad)) {
            const Vec3d w = subtended->sample(u);
            const double distance = length(w);
            return SolidAngleSample{w / distance, distance, 1 / subtended->solid_angle()};
        }
    } else if (const auto subtended = subtended_triangles(quad, corners(q, p))) {
        return sample_subtended(quad, *subtended, u);
    }
    return if_positive(quad.sample(u));
}
double solid_angle_pdf(const Quad& quad, Vec3d p, Vec3d q) {
    if (!is_rectangle(quad)) return flat_pdf(quad, p, q);
    const QuadSeen<double> far = area_seen(quad, p);
    const auto subtended = subtended_rectangle(far);
    return subtended ? 1 / subtended->solid_angle() : far.pdf(q - p);
}

std::optional<SolidAngleSample> sample_solid_angle(const Sphere& sphere, Vec3d p, Vec2d u) {
    const Vec3d to_center = Vec3d(sphere.center) - p;
    const double d2 = length_squared(to_center), r2 = sqr(static_cast<double>(sphere.radius));
    if (!(r2 > 0)) return std::nullopt;
    if (d2 <= r2) { // from inside, every direction hits the sphere
        const double z = 1 - 2 * u.y, ring_radius = 2 * std::sqrt(u.y * (1 - u.y)), phi = 2 * kPiDouble * u.x;
        const Vec3d wi(ring_radius * std::cos(phi), ring_radius * std::sin(phi), z);
        const double along = dot(wi, to_center), root = safe_sqrt(along * along + (r2 - d2));
        const double distance = along > 0 ? along + root : (r2 - d2) / (root - along);
        return SolidAngleSample{wi, std::isfinite(distance) ? distance : 0, 1 / (4 * kPiDouble)};
    }
    const double one_minus_cos = one_minus_cos_of_cone(r2 / d2), d = std::sqrt(d2);
    const Vec3d local = uniform_cone(u, one_minus_cos);
    const Vec3d wi = frame_from_normal(to_center / d).to_world(local);
    // The distance is the smaller root of t² − 2·t·d·cos + (d² − r²) = 0, in a form without the cancelling
    // difference.
    const double sin2 = sqr(local.x) + sqr(local.y);
    const double distance = (d2 - r2) / (d * local.z + safe_sqrt(r2 - d2 * sin2));
    return SolidAngleSample{wi, distance, uniform_cone_pdf(one_minus_cos)};
}

double solid_angle_pdf(const Sphere& sphere, Vec3d p, Vec3d) {
    const double d2 = length_squared(Vec3d(sphere.center) - p), r2 = sqr(static_cast<double>(sphere.radius));
    if (!(r2 > 0)) return 0;
    return d2 <= r2 ? 1 / (4 * kPiDouble) : uniform_cone_pdf(one_minus_cos_of_cone(r2 / d2));
}

} // namespace duet
