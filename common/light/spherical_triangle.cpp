#include "common/light/spherical_triangle.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

/// Returns the component of v orthogonal to the unit vector `axis`, normalized.
Vec3d orthogonal(Vec3d v, Vec3d axis) { return normalize(v - axis * dot(v, axis)); }

} // namespace

double SphericalTriangle::solid_angle() const {
    // Differences of corners retain the digits that the triple product of nearly parallel vectors would lose.
    const double volume = std::abs(dot(a, cross(b - a, c - a)));
    return 2 * std::atan2(volume, 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

Vec3d SphericalTriangle::sample(double solid_angle, Vec2d u) const {
    // alpha is the angle at a, between the planes of ab and ac.
    const Vec3d ab = cross(a, b), ac = cross(a, c);
    const double alpha = std::atan2(length(cross(ab, ac)), dot(ab, ac));
    const double sin_alpha = std::sin(alpha), cos_alpha = std::cos(alpha), cos_c = dot(a, b);

    // Move c along the edge ac to the point c', where the triangle a b c' has the fraction u.x of the solid angle
    // (Arvo 1995, eq. 3 and 4).
    const double sub_angle = u.x * solid_angle - alpha;
    const double s = std::sin(sub_angle), t = std::cos(sub_angle);
    const double p = t - cos_alpha, q = s + sin_alpha * cos_c;
    const double denominator = (q * s + p * t) * sin_alpha;
    const double cos_b =
        denominator != 0 ? std::clamp(((q * t - p * s) * cos_alpha - q) / denominator, -1.0, 1.0) : 1.0;
    const Vec3d moved = a * cos_b + orthogonal(c, a) * std::sqrt(1 - cos_b * cos_b);

    // The sample on the arc from b to c' is uniform in the height above b.
    const double gap = u.y * (1 - dot(moved, b));
    if (!(gap > 0)) return b;
    return b * (1 - gap) + orthogonal(moved, b) * safe_sqrt(gap * (2 - gap));
}

} // namespace duet
