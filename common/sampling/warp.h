// Maps from uniform numbers in [0, 1)² to other domains, each continuous and with its density.
#pragma once

#include "common/vec/vec.h"

#include <cmath>

namespace duet {

/// The unit disk, uniformly (density 1/π): squares around (½, ½) become circles, so strata stay compact. The centre
/// maps to the centre (Shirley and Chiu 1997, «A Low Distortion Map Between Disk and Square»).
template <Arithmetic T> Vec2T<T> concentric_disk(Vec2T<T> u) {
    const T a = T(2) * u.x - T(1), b = T(2) * u.y - T(1);
    if (a == T(0) && b == T(0)) return {};
    const bool wide = std::abs(a) > std::abs(b);
    const T quarter = static_cast<T>(kPiDouble / 4);
    const T r = wide ? a : b;
    const T angle = wide ? quarter * (b / a) : 2 * quarter - quarter * (a / b);
    return {r * std::cos(angle), r * std::sin(angle)};
}

/// Unit directions about +z with density cos θ / π (Malley's method). z > 0 always: the rim of the disk is moved
/// inwards by half the spacing of 24-bit numbers.
inline Vec3 cosine_hemisphere(Vec2 u) {
    const float a = 2 * u.x - 1, b = 2 * u.y - 1;
    const float r = max(std::abs(a), std::abs(b));
    const Vec2 disk = concentric_disk(u);
    // 1 − r² as a product: the difference 1 − r is exact for 24-bit numbers.
    const float gap = max(1 - r, 0x1p-24f);
    return {disk.x, disk.y, std::sqrt(gap * (1 + r))};
}
inline float cosine_hemisphere_pdf(float cos_theta) { return max(cos_theta, 0.0f) * kInvPi; }

/// Unit directions of the whole sphere, density 1/4π.
inline Vec3 uniform_sphere(Vec2 u) {
    const float phi = 2 * kPi * u.x;
    const float r = 2 * std::sqrt(u.y * (1 - u.y)); // sin θ = √(1 − z²) without the difference
    return {r * std::cos(phi), r * std::sin(phi), 1 - 2 * u.y};
}
inline constexpr float kUniformSpherePdf = kInvPi / 4;

/// Unit directions within a cone about +z, uniformly by solid angle: density 1 / (2π·one_minus_cos), with
/// one_minus_cos = 1 − cos θ_max in (0, 2], which the caller computes without cancellation.
template <Arithmetic T> Vec3T<T> uniform_cone(Vec2T<T> u, T one_minus_cos) {
    const T phi = T(2 * kPiDouble) * u.x;
    const T gap = u.y * one_minus_cos; // 1 − cos θ
    const T r = safe_sqrt(gap * (T(2) - gap));
    return {r * std::cos(phi), r * std::sin(phi), T(1) - gap};
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
