// This file defines vectors of two, three and four components. The component type is float, double or a SIMD batch.
#pragma once

#include "common/vec/scalar.h"

#include <cstddef>

namespace duet {

/// A Vec2 holds texture coordinates, a position in pixels, or a sample in [0, 1)².
template <typename T> struct Vec2T {
    T x{}, y{};

    constexpr Vec2T() = default;
    constexpr Vec2T(T x_, T y_) : x(x_), y(y_) {}
    template <typename U>
    constexpr explicit Vec2T(const Vec2T<U>& v) : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)) {}
    friend bool operator==(const Vec2T&, const Vec2T&) = default;
};

/// One type represents points, vectors and normals. The name of a variable says which of them it is.
template <typename T> struct Vec3T {
    T x{}, y{}, z{};

    constexpr Vec3T() = default;
    constexpr Vec3T(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    template <typename U>
    constexpr explicit Vec3T(const Vec3T<U>& v)
        : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}
    constexpr T operator[](std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr T& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    friend bool operator==(const Vec3T&, const Vec3T&) = default;
};

/// A Vec4 holds homogeneous coordinates.
template <typename T> struct Vec4T {
    T x{}, y{}, z{}, w{};

    constexpr Vec4T() = default;
    constexpr Vec4T(T x_, T y_, T z_, T w_) : x(x_), y(y_), z(z_), w(w_) {}
    constexpr Vec4T(const Vec3T<T>& v, T w_) : x(v.x), y(v.y), z(v.z), w(w_) {}
    friend bool operator==(const Vec4T&, const Vec4T&) = default;
};

using Vec2 = Vec2T<float>;
using Vec2d = Vec2T<double>;
using Vec3 = Vec3T<float>;
using Vec3d = Vec3T<double>;
using Vec4 = Vec4T<float>;
using Vec4d = Vec4T<double>;

// Component-wise arithmetic ------------------------------------------------------------------------------------------

template <typename T> constexpr Vec2T<T> operator+(Vec2T<T> a, Vec2T<T> b) { return {a.x + b.x, a.y + b.y}; }
template <typename T> constexpr Vec2T<T> operator-(Vec2T<T> a, Vec2T<T> b) { return {a.x - b.x, a.y - b.y}; }
template <typename T> constexpr Vec2T<T> operator*(Vec2T<T> a, T s) { return {a.x * s, a.y * s}; }
template <typename T> constexpr Vec2T<T> operator*(T s, Vec2T<T> a) { return a * s; }

template <typename T> constexpr Vec3T<T> operator+(Vec3T<T> a, Vec3T<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <typename T> constexpr Vec3T<T> operator-(Vec3T<T> a, Vec3T<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <typename T> constexpr Vec3T<T> operator-(Vec3T<T> a) { return {-a.x, -a.y, -a.z}; }
template <typename T> constexpr Vec3T<T> operator*(Vec3T<T> a, Vec3T<T> b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
template <typename T> constexpr Vec3T<T> operator*(Vec3T<T> a, T s) { return {a.x * s, a.y * s, a.z * s}; }
template <typename T> constexpr Vec3T<T> operator*(T s, Vec3T<T> a) { return a * s; }
template <typename T> constexpr Vec3T<T> operator/(Vec3T<T> a, T s) { return {a.x / s, a.y / s, a.z / s}; }
template <typename T> constexpr Vec3T<T>& operator+=(Vec3T<T>& a, Vec3T<T> b) { return a = a + b; }
template <typename T> constexpr Vec3T<T>& operator-=(Vec3T<T>& a, Vec3T<T> b) { return a = a - b; }
template <typename T> constexpr Vec3T<T>& operator*=(Vec3T<T>& a, T s) { return a = a * s; }

template <typename T> constexpr Vec4T<T> operator+(Vec4T<T> a, Vec4T<T> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
template <typename T> constexpr Vec4T<T> operator*(Vec4T<T> a, T s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }

/// Returns the smaller of each pair of components.
template <typename T> constexpr Vec3T<T> min(Vec3T<T> a, Vec3T<T> b) {
    return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
/// Broadcasts a vector of scalars to all lanes of a batch.
template <typename T, Arithmetic S> constexpr Vec3T<T> broadcast(Vec3T<S> v) { return {T(v.x), T(v.y), T(v.z)}; }
/// Returns the larger of each pair of components.
template <typename T> constexpr Vec3T<T> max(Vec3T<T> a, Vec3T<T> b) {
    return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}
/// Returns the absolute value of each component.
template <typename T> Vec3T<T> abs(Vec3T<T> a) { return {abs(a.x), abs(a.y), abs(a.z)}; }
/// Returns a where the condition holds, else b.
template <typename T, typename Mask> Vec3T<T> select(Mask condition, Vec3T<T> a, Vec3T<T> b) {
    return {select(condition, a.x, b.x), select(condition, a.y, b.y), select(condition, a.z, b.z)};
}
/// Returns the largest component.
template <typename T> constexpr T max_component(Vec3T<T> a) { return max(max(a.x, a.y), a.z); }
/// Interpolates linearly from a at t = 0 to b at t = 1. The result is exact at both ends.
template <typename T> constexpr Vec3T<T> lerp(Vec3T<T> a, Vec3T<T> b, T t) { return a * (T(1) - t) + b * t; }

// Products and lengths -----------------------------------------------------------------------------------------------

/// Returns the sum of the products of the components: |a| |b| times the cosine between a and b.
template <typename T> constexpr T dot(Vec2T<T> a, Vec2T<T> b) { return a.x * b.x + a.y * b.y; }
template <typename T> constexpr T dot(Vec3T<T> a, Vec3T<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// Returns the vector that is perpendicular to a and b by the right-hand rule. Its length is the area of their
/// parallelogram.
template <typename T> constexpr Vec3T<T> cross(Vec3T<T> a, Vec3T<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Returns |a|², which overflows in float for lengths beyond 1.8e19.
template <typename T> constexpr T length_squared(Vec3T<T> a) { return dot(a, a); }
/// Returns the Euclidean length. In float it overflows to infinity for lengths beyond 1.8e19, where the squared length
/// does.
template <typename T> T length(Vec3T<T> a) { return sqrt(length_squared(a)); }
/// Returns a / |a|. A zero vector gives NaN, so callers must test for it where it can occur.
template <typename T> Vec3T<T> normalize(Vec3T<T> a) { return a / length(a); }
/// Returns a / |a|, or the zero vector if |a| is 0.
template <Arithmetic T> Vec3T<T> normalize_or_zero(Vec3T<T> a) { return length(a) > 0 ? normalize(a) : Vec3T<T>(); }
/// Returns a / |a| for any nonzero vector with finite components. The vector is scaled first, so that the squares
/// neither overflow nor underflow.
template <typename T> Vec3T<T> normalize_scaled(Vec3T<T> a) { return normalize(a / max_component(abs(a))); }
/// Returns w mirrored about the unit normal n. Both w and the result point away from the surface.
template <typename T> constexpr Vec3T<T> reflect(Vec3T<T> w, Vec3T<T> n) { return n * (T(2) * dot(w, n)) - w; }

/// Returns whether no component is NaN or infinite.
template <typename T> MaskOf<T> is_finite(Vec3T<T> a) { // NaN is below no number
    const Vec3T<T> size = abs(a);
    const T limit(std::numeric_limits<float>::infinity());
    return (size.x < limit) & (size.y < limit) & (size.z < limit);
}

/// Rounds each component to float. There is an overload for batches in widen.h.
inline Vec3 to_floats(Vec3d v) { return Vec3(v); }

} // namespace duet
