// These functions map uniform samples in [0, 1)² to other domains. Each map is continuous and has a known density.
#pragma once

#include "common/vec/vec.h"

#include <cmath>
#include <type_traits>

namespace duet {

/// Returns 1 − x²/(n(n+1))·(1 − x²/((n+2)(n+3))·(…)). This is the Taylor series of cos x for n = 1 and of sin
/// x / x for n = 2, with enough terms for the precision of T where |x| <= π/4. T is float, double, or a batch of
/// floats.
template <int n, typename T> constexpr T trigonometric_series(T x_squared) {
    using Number = std::conditional_t<std::is_same_v<T, double>, double, float>;
    if constexpr (n > (std::is_same_v<T, double> ? 18 : 8))
        return T(Number(1));
    else
        return T(Number(1)) -
               x_squared * T(static_cast<Number>(1.0 / (n * (n + 1)))) * trigonometric_series<n + 2>(x_squared);
}

/// Returns the cosine and the sine of an angle in [−π/4, π/4], with an error of a few roundings. The library
/// functions support any angle, but cost several times as much.
template <typename T> constexpr Vec2T<T> cos_sin_near_zero(T angle) {
    const T squared = angle * angle;
    return {trigonometric_series<1>(squared), angle * trigonometric_series<2>(squared)};
}

/// Returns the point (cos 2πu, sin 2πu) for u in [0, 1].
template <Arithmetic T> Vec2T<T> unit_circle(T u) {
    const int quarter = static_cast<int>(4 * u + T(0.5)); // the difference 4u − quarter is exact
    const Vec2T<T> p = cos_sin_near_zero((4 * u - static_cast<T>(quarter)) * static_cast<T>(kPiDouble / 2));
    const Vec2T<T> rotated = quarter & 1 ? Vec2T<T>(-p.y, p.x) : p;
    return quarter & 2 ? Vec2T<T>(-rotated.x, -rotated.y) : rotated;
}

/// Maps the unit square uniformly to the unit disk (density 1/π). Squares around (½, ½) become circles around the
/// center, so strata stay compact (Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square"). T is float
/// or a batch of floats.
template <typename T> Vec2T<T> concentric_disk(Vec2T<T> u) {
    const T zero(0.0f), a = T(2.0f) * u.x - T(1.0f), b = T(2.0f) * u.y - T(1.0f);
    const auto wide = abs(a) > abs(b);
    const T r = select(wide, a, b), other = select(wide, b, a);
    const T slope = select(r == zero, zero, other / r);
    const Vec2T<T> p = cos_sin_near_zero(T(kPi / 4) * slope); // angle to the nearer axis
    const T along = r * p.x, across = r * p.y;
    return {select(wide, along, across), select(wide, across, along)};
}

/// Returns a unit direction around +z with density cos θ / π (Malley's method). z is always positive, because the
/// edge of the disk is moved inward by half the spacing of 24-bit numbers.
template <typename T> Vec3T<T> cosine_hemisphere(Vec2T<T> u) {
    const T one(1.0f), a = T(2.0f) * u.x - one, b = T(2.0f) * u.y - one;
    const T r = max(abs(a), abs(b));
    const Vec2T<T> disk = concentric_disk(u);
    // Compute 1 − r² as (1 − r)(1 + r), because the difference 1 − r is exact for 24-bit numbers.
    const T gap = max(one - r, T(0x1p-24f));
    return {disk.x, disk.y, sqrt(gap * (one + r))};
}
/// Returns the density, by solid angle, of cosine_hemisphere; 0 below the surface.
template <typename T> T cosine_hemisphere_pdf(T cos_theta) { return max(cos_theta, T(0.0f)) * T(kInvPi); }

/// Returns a unit direction of the whole sphere with the uniform density 1/4π.
template <Arithmetic T> Vec3T<T> uniform_sphere(Vec2T<T> u) {
    const Vec2T<T> circle = unit_circle(u.x);
    const T r = 2 * std::sqrt(u.y * (1 - u.y)); // sin θ = √(1 − z²), computed without cancellation
    return {r * circle.x, r * circle.y, 1 - 2 * u.y};
}
inline constexpr float kUniformSpherePdf = kInvPi / 4;

/// Returns a unit direction inside a cone around +z, uniform in solid angle with density 1 / (2π·one_minus_cos). The
/// argument one_minus_cos = 1 − cos θ_max is in (0, 2]; the caller must compute it without cancellation.
template <Arithmetic T> Vec3T<T> uniform_cone(Vec2T<T> u, T one_minus_cos) {
    const Vec2T<T> circle = unit_circle(u.x);
    const T gap = u.y * one_minus_cos; // 1 − cos θ
    const T r = safe_sqrt(gap * (T(2) - gap));
    return {r * circle.x, r * circle.y, T(1) - gap};
}
/// Returns the density, by solid angle, of uniform_cone inside the cone.
template <Arithmetic T> T uniform_cone_pdf(T one_minus_cos) { return T(1) / (T(2 * kPiDouble) * one_minus_cos); }

/// Returns the barycentric coordinates of b and c of a point that is uniform on a triangle abc (Heitz 2019, "A
/// Low-Distortion Map Between Triangle and Square").
template <Arithmetic T> Vec2T<T> uniform_triangle(Vec2T<T> u) {
    if (u.y > u.x) {
        const T half = u.x / T(2);
        return {half, u.y - half};
    }
    const T half = u.y / T(2);
    return {u.x - half, half};
}

} // namespace duet
