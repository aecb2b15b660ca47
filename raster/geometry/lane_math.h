// Provides math for templates whose number type is a single float or a batch of lanes.
#pragma once

#include "common/image/rgb.h"
#include "raster/geometry/packet.h"

namespace duet::raster {

/// Holds one truth value per lane of T: bool, or a batch of them.
template <typename T> using MaskOf = decltype(std::declval<T>() < std::declval<T>());

/// Returns whether the condition holds in any lane.
inline bool any_lane(bool lane) { return lane; }
inline bool any_lane(const xsimd::batch_bool<float>& lanes) { return lane_bits(lanes) != 0; }

/// Returns `a` in the lanes of `where` and `b` elsewhere.
inline RgbT<Floats> blend(const xsimd::batch_bool<float>& where, const RgbT<Floats>& a, const RgbT<Floats>& b) {
    return {xsimd::select(where, a.r, b.r), xsimd::select(where, a.g, b.g), xsimd::select(where, a.b, b.b)};
}

/// Returns the vectors scaled to length 1; lanes of zero stay zero.
inline Vec3T<Floats> unit_of(const Vec3T<Floats>& v) {
    return v * inverse_sqrt(max(dot(v, v), Floats(1e-30f)));
}

/// Returns Σ c[i] xⁱ.
template <typename T, std::size_t N> T polynomial(const std::array<float, N>& c, T x) {
    T sum(c[N - 1]);
    for (std::size_t i = N - 1; i-- > 0;) sum = multiply_add(sum, x, T(c[i]));
    return sum;
}

/// Returns arccos(x) / √(1 − x²), the ratio of an angle in [0, π/2] to its sine, for its cosine x in [0, 1]. The error
/// is below 5e-7.
template <typename T> T angle_over_sine(T x) {
    // The coefficients are a Chebyshev fit of degree 8 to a function without singularity in the interval.
    constexpr std::array<float, 9> kFit{1.57079622f, -0.99998226f,   0.78489626f,   -0.66108945f, 0.55702206f,
                                        -0.4245662f, 0.25323848f, -0.097968704f, 0.017653668f};
    return polynomial(kFit, x);
}

/// Returns arccos(x) for x in [−1, 1], with an error below 2e-6.
template <typename T> T arc_cosine(T x) {
    const T acute = angle_over_sine(abs(x)) * safe_sqrt((T(1) - x) * (T(1) + x));
    return select(x < T(0), T(kPi) - acute, acute);
}

/// Returns arctan(x) − x for x ≥ 0, to 1e-6 of the result or of 1. Near 0 it is −x³/3, which a difference would lose.
template <typename T> T arc_tangent_excess(T x) {
    constexpr std::array<float, 8> kFit{0.33333325f,  -0.1999881f,   0.14259038f,  -0.10877407f,
                                        0.080422957f, -0.049384938f, 0.020364472f, -0.0039621595f};
    const MaskOf<T> steep = x > T(1);
    const T z = select(steep, T(1) / x, x), z2 = z * z;
    const T excess = -z * z2 * polynomial(kFit, z2);
    return select(steep, T(kPi / 2) - (excess + z) - x, excess);
}

} // namespace duet::raster
