#include "common/light/solid_angle.h"

#include "common/sampling/warp.h"
#include "common/vec/frame.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

using Triangle = SurfaceLight::Triangle;

/// A flat shape by its area vector (its normal, as long as its area) and a point of its plane relative to p.
struct Plane {
    Vec3d area_vector, to_plane;
};
Plane plane(const Triangle& t, Vec3d p) {
    const Vec3d a(t.a);
    return {cross(Vec3d(t.b) - a, Vec3d(t.c) - a) * 0.5, a - p};
}
Plane plane(const Quad& q, Vec3d p) { return {cross(Vec3d(q.u), Vec3d(q.v)), Vec3d(q.corner) - p}; }

/// Density by solid angle of a point at offset w from p, uniform by area: d²/(A cos θ) = d³/|A⃗·w|, where A⃗·w is the
/// same for all points of the plane.
double area_pdf(const Plane& plane, Vec3d w) {
    const double slant = std::abs(dot(plane.area_vector, plane.to_plane));
    const double d2 = length_squared(w);
    return slant > 0 ? d2 * std::sqrt(d2) / slant : 0;
}

std::optional<SolidAngleSample> towards(const Plane& plane, Vec3d w) {
    const double d = length(w), pdf = area_pdf(plane, w);
    if (!(pdf > 0)) return std::nullopt;
    return SolidAngleSample{w / d, d, pdf};
}

/// 1 − cos of the half angle of the cone a sphere fills, from sin² = r²/d² < 1.
double cone_gap(double sin2) { return sin2 / (1 + std::sqrt(1 - sin2)); }

} // namespace

std::optional<SolidAngleSample> sample_solid_angle(const Triangle& t, Vec3d p, Vec2d u) {
    const Vec2d b = uniform_triangle(u);
    const Vec3d a(t.a);
    return towards(plane(t, p), (a - p) + (Vec3d(t.b) - a) * b.x + (Vec3d(t.c) - a) * b.y);
}
double solid_angle_pdf(const Triangle& t, Vec3d p, Vec3d q) { return area_pdf(plane(t, p), q - p); }

std::optional<SolidAngleSample> sample_solid_angle(const Quad& q, Vec3d p, Vec2d u) {
    return towards(plane(q, p), (Vec3d(q.corner) - p) + Vec3d(q.u) * u.x + Vec3d(q.v) * u.y);
}
double solid_angle_pdf(const Quad& quad, Vec3d p, Vec3d q) { return area_pdf(plane(quad, p), q - p); }

std::optional<SolidAngleSample> sample_solid_angle(const Sphere& sphere, Vec3d p, Vec2d u) {
    const Vec3d to_center = Vec3d(sphere.center) - p;
    const double d2 = length_squared(to_center), r2 = sqr(static_cast<double>(sphere.radius));
    if (!(r2 > 0)) return std::nullopt;
    if (d2 <= r2) { // from inside, every direction meets the sphere
        const double z = 1 - 2 * u.y, ring = 2 * std::sqrt(u.y * (1 - u.y)), phi = 2 * kPiDouble * u.x;
        const Vec3d wi(ring * std::cos(phi), ring * std::sin(phi), z);
        const double along = dot(wi, to_center), root = safe_sqrt(along * along + (r2 - d2));
        const double distance = along > 0 ? along + root : (r2 - d2) / (root - along);
        return SolidAngleSample{wi, std::isfinite(distance) ? distance : 0, 1 / (4 * kPiDouble)};
    }
    const double gap = cone_gap(r2 / d2), d = std::sqrt(d2);
    const Vec3d local = uniform_cone(u, gap);
    const Vec3d wi = frame_from_normal(to_center / d).to_world(local);
    // The nearer root of t² − 2·t·d·cos + (d² − r²) = 0, without its difference.
    const double sin2 = sqr(local.x) + sqr(local.y);
    const double distance = (d2 - r2) / (d * local.z + safe_sqrt(r2 - d2 * sin2));
    return SolidAngleSample{wi, distance, uniform_cone_pdf(gap)};
}

double solid_angle_pdf(const Sphere& sphere, Vec3d p, Vec3d) {
    const double d2 = length_squared(Vec3d(sphere.center) - p), r2 = sqr(static_cast<double>(sphere.radius));
    if (!(r2 > 0)) return 0;
    return d2 <= r2 ? 1 / (4 * kPiDouble) : uniform_cone_pdf(cone_gap(r2 / d2));
}

} // namespace duet
