// This file defines colors in linear RGB with Rec. 709 primaries.
#pragma once

#include "common/vec/vec.h"

#include <cstdint>

namespace duet {

/// An RGB value has three channels. It may be a radiance, an irradiance, a reflectance or another quantity; the name of
/// the variable says which.
template <typename T> struct RgbT {
    T r{}, g{}, b{};

    constexpr RgbT() = default;
    constexpr explicit RgbT(T gray) : r(gray), g(gray), b(gray) {}
    constexpr RgbT(T r_, T g_, T b_) : r(r_), g(g_), b(b_) {}
    template <typename U>
    constexpr explicit RgbT(const RgbT<U>& c)
        : r(static_cast<T>(c.r)), g(static_cast<T>(c.g)), b(static_cast<T>(c.b)) {}
    constexpr T operator[](std::size_t channel) const { return channel == 0 ? r : channel == 1 ? g : b; }
    constexpr T& operator[](std::size_t channel) { return channel == 0 ? r : channel == 1 ? g : b; }
    friend bool operator==(const RgbT&, const RgbT&) = default;
};
using Rgb = RgbT<float>;
using Rgbd = RgbT<double>;

/// Broadcasts a color to all lanes of a batch.
template <typename T> constexpr RgbT<T> broadcast(Rgb c) { return {T(c.r), T(c.g), T(c.b)}; }

template <typename T> constexpr RgbT<T> operator+(RgbT<T> a, RgbT<T> b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
template <typename T> constexpr RgbT<T> operator-(RgbT<T> a, RgbT<T> b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
template <typename T> constexpr RgbT<T> operator*(RgbT<T> a, RgbT<T> b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
template <typename T> constexpr RgbT<T> operator*(RgbT<T> a, T s) { return {a.r * s, a.g * s, a.b * s}; }
template <typename T> constexpr RgbT<T> operator*(T s, RgbT<T> a) { return a * s; }
template <typename T> constexpr RgbT<T> operator/(RgbT<T> a, RgbT<T> b) { return {a.r / b.r, a.g / b.g, a.b / b.b}; }
template <typename T> constexpr RgbT<T> operator/(RgbT<T> a, T s) { return {a.r / s, a.g / s, a.b / s}; }
template <typename T> constexpr RgbT<T>& operator+=(RgbT<T>& a, RgbT<T> b) { return a = a + b; }
template <typename T> constexpr RgbT<T>& operator*=(RgbT<T>& a, RgbT<T> b) { return a = a * b; }
template <typename T> constexpr RgbT<T>& operator*=(RgbT<T>& a, T s) { return a = a * s; }
/// Interpolates linearly from a at t = 0 to b at t = 1. The result is exact at both ends.
template <typename T> constexpr RgbT<T> lerp(RgbT<T> a, RgbT<T> b, T t) { return a * (T(1) - t) + b * t; }

/// Returns the largest channel.
template <typename T> constexpr T max_component(RgbT<T> c) { return max(max(c.r, c.g), c.b); }
/// Returns the mean of the three channels.
template <typename T> constexpr T average(RgbT<T> c) { return (c.r + c.g + c.b) * T(1.0 / 3.0); }
/// Returns the relative luminance Y for Rec. 709 primaries (ITU-R BT.709-6, §3.2).
template <typename T> constexpr T luminance(RgbT<T> c) { return T(0.2126) * c.r + T(0.7152) * c.g + T(0.0722) * c.b; }
/// Returns whether all channels are exactly 0.
template <typename T> constexpr MaskOf<T> is_black(RgbT<T> c) {
    return (c.r == T(0)) & (c.g == T(0)) & (c.b == T(0));
}
/// Returns a where the condition holds, else b.
template <typename T> RgbT<T> select(MaskOf<T> condition, RgbT<T> a, RgbT<T> b) {
    return {select(condition, a.r, b.r), select(condition, a.g, b.g), select(condition, a.b, b.b)};
}
/// Maps a unit vector to the color (n + 1)/2. Rounding can make a component of n exceed 1 in magnitude by an ulp, so
/// negative results are clamped to 0.
inline Rgb direction_color(Vec3 n) {
    const auto channel = [](float component) { return max((component + 1) * 0.5f, 0.0f); };
    return {channel(n.x), channel(n.y), channel(n.z)};
}
/// Returns whether no channel is NaN or infinite.
template <Arithmetic T> bool is_finite(RgbT<T> c) {
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

/// An Rgba8 is a pixel of four 8-bit channels, as displays use it. The name of the variable says how the values are
/// encoded.
struct Rgba8 {
    std::uint8_t r = 0, g = 0, b = 0, a = 255;
    friend bool operator==(const Rgba8&, const Rgba8&) = default;
};

} // namespace duet
