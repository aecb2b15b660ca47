// Maps from uniform numbers in [0, 1)² to other domains, each continuous and with its density.
#pragma once

#include "common/vec/vec.h"

#include <cmath>
#include <type_traits>

namespace duet {

/// 1 − x²/(n(n+1))·(1 − x²/((n+2)(n+3))·(…)), for |x| ≤ π/4 as far as T can tell: the Taylor series of cos x for n = 1,
/// of sin x / x for n = 2. T is float, double, or a batch of floats.
template <int n, typename T> constexpr T trigonometric_series(T x_squared) {
    using Number = std::conditional_t<std::is_same_v<T, double>, double, float>;
    if constexpr (n > (std::is_same_v<T, double> ? 18 : 8))
        return T(Number(1));
    else
        return T(Number(1)) -
               x_squared * T(static_cast<Number>(1.0 / (n * (n + 1)))) * trigonometric_series<n + 2>(x_squared);
}

/// Cosine and sine of an angle within ±π/4, to a few roundings: a fraction of what the library's functions cost, which
/// serve any angle.
template <typename T> constexpr Vec2T<T> unit_circle_near(T angle) {
    const T squared = angle * angle;
    return {trigonometric_series<1>(squared), angle * trigonometric_series<2>(squared)};
}

/// The point (cos 2πu, sin 2πu), u in [0, 1].
template <Arithmetic T> Vec2T<T> unit_circle(T u) {
    const int quarter = static_cast<int>(4 * u + T(0.5)); // 4u less this many quarters: exact
    const Vec2T<T> p = unit_circle_near((4 * u - static_cast<T>(quarter)) * static_cast<T>(kPiDouble / 2));
    const Vec2T<T> turned = quarter & 1 ? Vec2T<T>(-p.y, p.x) : p;
    return quarter & 2 ? Vec2T<T>(-turned.x, -turned.y) : turned;
}

/// The unit disk, uniformly (density 1/π): squares around (½, ½) become circles, so strata stay compact. The centre
/// maps to the centre (Shirley and Chiu 1997, «A Low Distortion Map Between Disk and Square»). T is float or a batch of
/// floats.
template <typename T> Vec2T<T> concentric_disk(Vec2T<T> u) {
    const T zero(0.0f), a = T(2.0f) * u.x - T(1.0f), b = T(2.0f) * u.y - T(1.0f);
    const auto wide = abs(a) > abs(b);
    const T r = select(wide, a, b), other = select(wide, b, a);
    const T slope = select(r == zero, zero, other / r);
    const Vec2T<T> p = unit_circle_near(T(kPi / 4) * slope); // about the nearer axis
    const T along = r * p.x, across = r * p.y;
    return {select(wide, along, across), select(wide, across, along)};
}

/// Unit directions about +z with density cos θ / π (Malley's method). z > 0 always: the rim of the disk is moved
/// inwards by half the spacing of 24-bit numbers.
template <typename T> Vec3T<T> cosine_hemisphere(Vec2T<T> u) {
    const T one(1.0f), a = T(2.0f) * u.x - one, b = T(2.0f) * u.y - one;
    const T r = max(abs(a), abs(b));
    const Vec2T<T> disk = concentric_disk(u);
    // 1 − r² as a product: the difference 1 − r is exact for 24-bit numbers.
    const T gap = max(one - r, T(0x1p-24f));
    return {disk.x, disk.y, sqrt(gap * (one + r))};
}
template <typename T> T cosine_hemisphere_pdf(T cos_theta) { return max(cos_theta, T(0.0f)) * T(kInvPi); }

/// Unit directions of the whole sphere, density 1/4π.
inline Vec3 uniform_sphere(Vec2 u) {
    const Vec2 circle = unit_circle(u.x);
    const float r = 2 * std::sqrt(u.y * (1 - u.y)); // sin θ = √(1 − z²) without the difference
    return {r * circle.x, r * circle.y, 1 - 2 * u.y};
}
inline constexpr float kUniformSpherePdf = kInvPi / 4;

/// Unit directions within a cone about +z, uniformly by solid angle: density 1 / (2π·one_minus_cos), with
/// one_minus_cos = 1 − cos θ_max in (0, 2], which the caller computes without cancellation.
template <Arithmetic T> Vec3T<T> uniform_cone(Vec2T<T> u, T one_minus_cos) {
    const Vec2T<T> circle = unit_circle(u.x);
    const T gap = u.y * one_minus_cos; // 1 − cos θ
    const T r = safe_sqrt(gap * (T(2) - gap));
    return {r * circle.x, r * circle.y, T(1) - gap};
}
template <Arithmetic T> T uniform_cone_pdf(T one_minus_cos) { return T(1) / (T(2 * kPiDouble) * one_minus_cos); }

/// Barycentric coordinates (of b and c) uniform on a triangle abc (Heitz 2019, «A Low-Distortion Map Between Triangle
/// and Square»).
template <Arithmetic T> Vec2T<T> uniform_triangle(Vec2T<T> u) {
    if (u.y > u.x) {
        const T half = u.x / T(2);
        return {half, u.y - half};
    }
    const T half = u.y / T(2);
    return {u.x - half, half};
}

} // namespace duet
