// This file defines the intersection of a ray and a sphere, and the texture coordinates of spheres and lat-long images.
#pragma once

#include "common/geometry/shape.h"
#include "common/vec/ray.h"

#include <cmath>
#include <optional>
#include <type_traits>

namespace duet {

/// A sphere line stores the direction of a line for tests against many spheres. d·d and its reciprocal are computed
/// once.
template <typename T> struct SphereTestLine {
    Vec3T<T> direction;
    T squared, inverse; ///< d·d and its reciprocal

    explicit SphereTestLine(const Vec3T<T>& d) : direction(d), squared(dot(d, d)), inverse(T(1) / squared) {}
    /// Broadcasts a line to all lanes of a batch.
    explicit SphereTestLine(const SphereTestLine<double>& one) requires(!std::is_same_v<T, double>)
        : direction(T(one.direction.x), T(one.direction.y), T(one.direction.z)), squared(one.squared),
          inverse(one.inverse) {}
};

/// Computes the intersections of a line and a sphere. T is double or a batch of doubles. With g = center − origin,
/// they are the roots of a·t² − 2b·t + c = 0 for a = d·d, b = g·d and c = g·g − r².
///
/// The usual discriminant b² − a·c loses all digits if the sphere is far away or small. The discriminant is
/// therefore computed from the distance between the center and the line, and the root without cancellation is computed
/// first (Haines, Günther and Akenine-Möller 2019, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing
/// Gems §7, eqs. 5 to 8). In double, the differences of float inputs are exact to 1 part in 10^16: an origin 1e-7
/// above a sphere of radius 1000 is still outside. The code negates no term, because the sign of b = ±0 decides which
/// root is computed first, and the negation of a batch may be implemented as 0 − x.
template <typename T> struct SphereTest {
    T a, over_a, b, c; ///< coefficients of the quadratic equation; over_a = 1/a
    T discriminant;    ///< discriminant divided by a; the line hits the sphere if it is >= 0, so NaN is a miss

    SphereTest(const Vec3T<T>& to_center, const SphereTestLine<T>& line, T radius)
        : a(line.squared), over_a(line.inverse), b(dot(to_center, line.direction)),
          c(dot(to_center, to_center) - radius * radius) {
        // `closest` is the vector from the sphere's center to the nearest point of the line.
        const Vec3T<T> closest = line.direction * (b * over_a) - to_center;
        discriminant = radius * radius - dot(closest, closest);
    }

    /// Returns whether the line hits the sphere at some t >= 0. Both roots are negative if the origin is outside the
    /// sphere and the line points away from it (b < 0 < c).
    auto hits_forward() const { return (discriminant >= T(0)) & ((b >= T(0)) | (c <= T(0))); }

    struct Roots {
        T near, far;
    };
    /// Returns the parameters t at which the line enters and leaves the sphere. The line must hit the sphere.
    Roots roots() const {
        using std::copysign;
        const T q = b + copysign(sqrt(a * discriminant), b);
        const T t0 = c / q, t1 = q * over_a;
        const auto swapped = t0 > t1;
        return {select(swapped, t1, t0), select(swapped, t0, t1)};
    }
};

/// Returns the smallest t in (t_min, t_max] at which the ray hits the sphere from outside or inside, or nothing on a
/// miss. The ray's direction may have any length. SphereTest avoids cancellation for far, huge and tiny spheres.
std::optional<float> intersect_sphere(const Ray& ray, const Sphere& sphere);

/// Returns the texture coordinates of a sphere at the outward unit normal n: u = ½ + atan2(x, z)/2π, and v is 0 at
/// −y and 1 at +y. Seen from outside with +y up, u increases to the right, so a map of the earth is not mirrored. The
/// center of the texture is at +z.
Vec2 sphere_uv(Vec3 n);
/// Returns the unit normal at (u, v). This is the inverse of sphere_uv.
Vec3 sphere_direction(Vec2 uv);

/// Returns the position of the unit direction w in a lat-long environment map: u = ½ + atan2(x, −z)/2π, and v is 0
/// at −y and 1 at +y. Seen from inside, u increases to the right. The center of the image is at −z.
Vec2 latlong_uv(Vec3 w);

} // namespace duet
