// Ray and sphere.
#pragma once

#include "common/geometry/shape.h"
#include "common/vec/ray.h"

#include <cmath>
#include <optional>
#include <type_traits>

namespace duet {

/// The direction of a line that is tested against spheres: what it is divided by is found once.
template <typename T> struct SphereLine {
    Vec3T<T> direction;
    T squared, inverse; ///< d·d, and its reciprocal

    explicit SphereLine(const Vec3T<T>& d) : direction(d), squared(dot(d, d)), inverse(T(1) / squared) {}
    /// One line in all lanes.
    explicit SphereLine(const SphereLine<double>& one)
        requires(!std::is_same_v<T, double>)
        : direction(T(one.direction.x), T(one.direction.y), T(one.direction.z)), squared(one.squared), inverse(one.inverse) {}
};

/// What a line meets of spheres, T being double or a batch of doubles. With g = centre − origin, the roots of
/// a·t² − 2b·t + c = 0 for a = d·d, b = g·d, c = g·g − r². The textbook's b² − a·c loses all digits where the sphere is
/// far or small: the discriminant is taken from the distance of the centre to the line instead, and of the two roots the
/// one without cancellation is computed first (Haines, Günther and Akenine-Möller 2019, «Precision Improvements for
/// Ray/Sphere Intersection», Ray Tracing Gems §7, eqs. 5 to 8). In double, in which the differences of float inputs are
/// exact to 1 part in 10^16: an origin 1e-7 above a sphere of radius 1000 is still outside. (No term is negated: the
/// sign of a zero b decides which root comes first, and a batch's negation may be 0 − x.)
template <typename T> struct SphereTest {
    T a, over_a, b, c; ///< over_a = 1/a
    T discriminant;    ///< over a: the line meets the sphere where it is at least 0; NaN misses, too

    SphereTest(const Vec3T<T>& to_center, const SphereLine<T>& line, T radius)
        : a(line.squared), over_a(line.inverse), b(dot(to_center, line.direction)),
          c(dot(to_center, to_center) - radius * radius) {
        const Vec3T<T> closest = line.direction * (b * over_a) - to_center; // from the centre to the line's nearest point
        discriminant = radius * radius - dot(closest, closest);
    }

    /// Whether the line meets the sphere, and not only behind its origin: there, outside and running away (b < 0 < c), both
    /// roots are below 0.
    auto meets_ahead() const { return (discriminant >= T(0)) & ((b >= T(0)) | (c <= T(0))); }

    struct Roots {
        T near, far;
    };
    /// Where the line enters and leaves the sphere; of a line that meets it.
    Roots roots() const {
        using std::copysign;
        const T q = b + copysign(sqrt(a * discriminant), b);
        const T t0 = c / q, t1 = q * over_a;
        const auto swapped = t0 > t1;
        return {select(swapped, t1, t0), select(swapped, t0, t1)};
    }
};

/// The nearest t in (t_min, t_max] where the ray meets the sphere, from outside or inside; direction of any length.
/// Without cancellation for far, huge and tiny spheres: see SphereTest.
std::optional<float> intersect_sphere(const Ray& ray, const Sphere& sphere);

/// The texture coordinates of a sphere where its outward unit normal is n: u = ½ + atan2(x, z)/2π, v = 0 at −y and 1 at
/// +y. Seen from outside with +y up, u grows to the right, so that a map of a globe isn't mirrored; its middle is at
/// +z.
Vec2 sphere_uv(Vec3 n);
/// The normal at (u, v): the inverse of sphere_uv.
Vec3 sphere_direction(Vec2 uv);

/// Where a lat-long image of a sky shows the unit direction w: u = ½ + atan2(x, −z)/2π, v = 0 at −y and 1 at +y. Seen
/// from inside, u grows to the right; the image's middle is at −z.
Vec2 latlong_uv(Vec3 w);
/// The direction at (u, v): the inverse of latlong_uv.
Vec3 latlong_direction(Vec2 uv);

} // namespace duet
