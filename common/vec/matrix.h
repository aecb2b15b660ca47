// This file defines 4 × 4 matrices that act on column vectors, and the affine transforms built from them.
#pragma once

#include "common/vec/vec.h"

#include <array>

namespace duet {

/// The matrix is stored row by row as m[row][column]. Points are column vectors: p' = M p. The default is the identity.
template <typename T> struct Mat4T {
    std::array<std::array<T, 4>, 4> m{
        {{T(1), T(0), T(0), T(0)}, {T(0), T(1), T(0), T(0)}, {T(0), T(0), T(1), T(0)}, {T(0), T(0), T(0), T(1)}}};

    constexpr Mat4T() = default;
    template <typename U> constexpr explicit Mat4T(const Mat4T<U>& other) {
        for (std::size_t r = 0; r < 4; ++r)
            for (std::size_t c = 0; c < 4; ++c) m[r][c] = static_cast<T>(other.m[r][c]);
    }
    constexpr const std::array<T, 4>& operator[](std::size_t row) const { return m[row]; }
    constexpr std::array<T, 4>& operator[](std::size_t row) { return m[row]; }
    friend constexpr bool operator==(const Mat4T&, const Mat4T&) = default;
};

using Mat4 = Mat4T<float>;
using Mat4d = Mat4T<double>;

template <typename T> constexpr Mat4T<T> operator*(const Mat4T<T>& a, const Mat4T<T>& b) {
    Mat4T<T> product;
    for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t c = 0; c < 4; ++c) {
            T sum{};
            for (std::size_t k = 0; k < 4; ++k) sum = sum + a[r][k] * b[k][c];
            product[r][c] = sum;
        }
    return product;
}

template <typename T> constexpr Vec4T<T> operator*(const Mat4T<T>& m, Vec4T<T> v) {
    const auto row = [&](std::size_t r) { return m[r][0] * v.x + m[r][1] * v.y + m[r][2] * v.z + m[r][3] * v.w; };
    return {row(0), row(1), row(2), row(3)};
}

/// Returns the transposed matrix.
template <typename T> constexpr Mat4T<T> transpose(const Mat4T<T>& a) {
    Mat4T<T> result;
    for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t c = 0; c < 4; ++c) result[r][c] = a[c][r];
    return result;
}

/// Applies an affine map to a point and returns the first three components of M (p, 1). The last row of M is assumed to
/// be (0, 0, 0, 1).
template <typename T> constexpr Vec3T<T> transform_point(const Mat4T<T>& m, Vec3T<T> p) {
    const auto row = [&](std::size_t r) { return m[r][0] * p.x + m[r][1] * p.y + m[r][2] * p.z + m[r][3]; };
    return {row(0), row(1), row(2)};
}
/// Applies an affine map to a direction: the translation has no effect.
template <typename T> constexpr Vec3T<T> transform_vector(const Mat4T<T>& m, Vec3T<T> v) {
    const auto row = [&](std::size_t r) { return m[r][0] * v.x + m[r][1] * v.y + m[r][2] * v.z; };
    return {row(0), row(1), row(2)};
}
/// Applies the inverse of the affine map m to a point and returns M⁻¹ p. The function computes the difference p −
/// M 0 first, which loses no precision near the mapped origin M 0. The translation column of the inverse is not used:
/// its terms are as large as the distance from the world's origin, and in float its error reaches centimeters at 100
/// km.
template <typename T>
constexpr Vec3T<T> transform_point_inverse(const Mat4T<T>& m, const Mat4T<T>& inverse, Vec3T<T> p) {
    return transform_vector(inverse, p - Vec3T<T>(m[0][3], m[1][3], m[2][3]));
}
/// Applies an affine map, given by its inverse, to a normal and returns (M⁻¹)ᵀ n. The result is not normalized.
template <typename T> constexpr Vec3T<T> transform_normal(const Mat4T<T>& inverse, Vec3T<T> n) {
    const auto column = [&](std::size_t c) { return inverse[0][c] * n.x + inverse[1][c] * n.y + inverse[2][c] * n.z; };
    return {column(0), column(1), column(2)};
}

/// Returns the determinant of the upper-left 3 × 3 block. It is negative for a map that contains a reflection.
template <typename T> constexpr T determinant3(const Mat4T<T>& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// Returns the inverse of an affine map, computed by cofactors. A singular map gives infinities or NaN; the scene
/// loader rejects such maps.
template <typename T> constexpr Mat4T<T> inverse_affine(const Mat4T<T>& a) {
    const T inv_det = T(1) / determinant3(a);
    Mat4T<T> r;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) { // cofactor (j, i); cyclic indices already include its sign
            const std::size_t r1 = (j + 1) % 3, r2 = (j + 2) % 3, c1 = (i + 1) % 3, c2 = (i + 2) % 3;
            r[i][j] = (a[r1][c1] * a[r2][c2] - a[r1][c2] * a[r2][c1]) * inv_det;
        }
    for (std::size_t i = 0; i < 3; ++i) r[i][3] = -(r[i][0] * a[0][3] + r[i][1] * a[1][3] + r[i][2] * a[2][3]);
    return r;
}

/// Returns the matrix that moves points by t.
template <typename T> constexpr Mat4T<T> translation(Vec3T<T> t) {
    Mat4T<T> r;
    r[0][3] = t.x;
    r[1][3] = t.y;
    r[2][3] = t.z;
    return r;
}
/// Returns the matrix that scales each axis by a component of s.
template <typename T> constexpr Mat4T<T> scaling(Vec3T<T> s) {
    Mat4T<T> r;
    r[0][0] = s.x;
    r[1][1] = s.y;
    r[2][2] = s.z;
    return r;
}
/// Returns the rotation by an angle in radians about a unit axis (Rodrigues' formula). A positive angle turns
/// counter-clockwise for a viewer toward whom the axis points.
template <Arithmetic T> Mat4T<T> rotation(Vec3T<T> axis, T angle) {
    const T c = std::cos(angle), s = std::sin(angle), k = T(1) - c;
    Mat4T<T> r;
    r[0] = {c + k * axis.x * axis.x, k * axis.x * axis.y - s * axis.z, k * axis.x * axis.z + s * axis.y, T(0)};
    r[1] = {k * axis.y * axis.x + s * axis.z, c + k * axis.y * axis.y, k * axis.y * axis.z - s * axis.x, T(0)};
    r[2] = {k * axis.z * axis.x - s * axis.y, k * axis.z * axis.y + s * axis.x, c + k * axis.z * axis.z, T(0)};
    return r;
}

/// Interpolates two matrices entry by entry, with t = 0 at a and t = 1 at b. Moving objects interpolate their
/// transforms this way over the shutter interval.
template <typename T> constexpr Mat4T<T> lerp(const Mat4T<T>& a, const Mat4T<T>& b, T t) {
    Mat4T<T> r;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) r[i][j] = a[i][j] * (T(1) - t) + b[i][j] * t;
    return r;
}

} // namespace duet
