#include "common/geometry/sphere.h"

#include "common/system/sabotage.h"

#include <cmath>
#include <utility>

namespace duet {

// With f = origin − centre, the roots of a·t² − 2b·t + c = 0 for a = d·d, b = −f·d, c = f·f − r². The textbook's
// b² − a·c loses all digits where the sphere is far or small: the discriminant is taken from the distance of the centre
// to the ray instead, and of the two roots the one without cancellation is computed first (Haines et al. 2019, eqs. 5
// to 8). In double, in which the differences of float inputs are exact to 1 part in 10^16: an origin 1e-7 above a
// sphere of radius 1000 is still outside.
std::optional<float> intersect_sphere(const Ray& ray, const Sphere& sphere) {
    const Vec3d f = Vec3d(ray.origin) - Vec3d(sphere.center);
    const Vec3d d(ray.direction);
    const double r = static_cast<double>(sphere.radius);
    const double a = dot(d, d), b = -dot(f, d);
    const Vec3d closest = f + d * (b / a); // from the centre to the ray's nearest point
    double discriminant = r * r - dot(closest, closest);
    if (sabotaged(Guard::kSphereRoots)) { // the textbook's, in float
        const Vec3 g = ray.origin - sphere.center, e = ray.direction;
        const float half = dot(g, e);
        discriminant = static_cast<double>(half * half - dot(e, e) * (dot(g, g) - sqr(sphere.radius))) / a;
    }
    if (!(discriminant >= 0)) return std::nullopt; // a NaN misses, too
    const double c = dot(f, f) - r * r;
    const double q = b + std::copysign(std::sqrt(a * discriminant), b);
    double near = c / q, far = q / a;
    if (near > far) std::swap(near, far);
    const float t_near = static_cast<float>(near), t_far = static_cast<float>(far);
    if (t_near > ray.t_min && t_near <= ray.t_max) return t_near;
    if (t_far > ray.t_min && t_far <= ray.t_max) return t_far;
    return std::nullopt;
}

Vec2 sphere_uv(Vec3 n) {
    const double u = 0.5 + std::atan2(static_cast<double>(n.x), -static_cast<double>(n.z)) / (2 * kPiDouble);
    // atan2 of both components is accurate at the poles, where acos(y) is not.
    const double v =
        0.5 + std::atan2(static_cast<double>(n.y), std::hypot(static_cast<double>(n.x), static_cast<double>(n.z))) /
                  kPiDouble;
    return {min(static_cast<float>(u), kOneMinusEpsilon), static_cast<float>(v)};
}

Vec3 sphere_direction(Vec2 uv) {
    const double longitude = (static_cast<double>(uv.x) - 0.5) * 2 * kPiDouble;
    const double latitude = (static_cast<double>(uv.y) - 0.5) * kPiDouble;
    const double ring = std::cos(latitude);
    return Vec3(Vec3d(ring * std::sin(longitude), std::sin(latitude), -ring * std::cos(longitude)));
}

} // namespace duet
