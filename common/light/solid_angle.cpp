#include "common/light/solid_angle.h"

#include "common/sampling/warp.h"
#include "common/vec/frame.h"

#include <cmath>

namespace duet {

namespace {

using Triangle = LightTriangle;

std::optional<SolidAngleSample> if_positive(const SolidAngleSample& sample) {
    return sample.pdf > 0 ? std::optional(sample) : std::nullopt;
}

/// Returns 1 − cos of the half angle of the cone that a sphere subtends, from sin² = r²/d² < 1.
double one_minus_cos_of_cone(double sin2) { return sin2 / (1 + std::sqrt(1 - sin2)); }

} // namespace

AreaSampling<double> area_seen(const Triangle& t, Vec3d p) {
    const Vec3d a(t.a);
    return {cross(Vec3d(t.b) - a, Vec3d(t.c) - a) * 0.5, a - p};
}
QuadSeen<double> area_seen(const Quad& q, Vec3d p) { return {Vec3d(q.corner), Vec3d(q.u), Vec3d(q.v), p}; }

std::optional<SolidAngleSample> sample_solid_angle(const Triangle& t, Vec3d p, Vec2d u) {
    const Vec3d a = Vec3d(t.a) - p;
    const Vec2d b = uniform_triangle(u);
    return if_positive(area_seen(t, p).sample(a + (Vec3d(t.b) - p - a) * b.x + (Vec3d(t.c) - p - a) * b.y));
}
double solid_angle_pdf(const Triangle& t, Vec3d p, Vec3d q) { return area_seen(t, p).pdf(q - p); }

std::optional<SolidAngleSample> sample_solid_angle(const Quad& q, Vec3d p, Vec2d u) {
    return if_positive(area_seen(q, p).sample(u));
}
double solid_angle_pdf(const Quad& quad, Vec3d p, Vec3d q) { return area_seen(quad, p).pdf(q - p); }

std::optional<SolidAngleSample> sample_solid_angle(const Sphere& sphere, Vec3d p, Vec2d u) {
    const Vec3d to_center = Vec3d(sphere.center) - p;
    const double d2 = length_squared(to_center), r2 = sqr(static_cast<double>(sphere.radius));
    if (!(r2 > 0)) return std::nullopt;
    if (d2 <= r2) { // from inside, every direction hits the sphere
        const Vec3d wi = uniform_sphere(u);
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
