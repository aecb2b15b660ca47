// Computes the linear functions of perspective-correct interpolation, for one triangle or for one triangle per SIMD
// lane.
#pragma once

#include "raster/geometry/packet.h"

#include "common/vec/scalar.h"

#include <array>

namespace duet::raster {

/// Holds the screen-space planes of a triangle. Each is stored as the coefficients of x, y and 1, with the sign that
/// makes it positive inside the triangle. They are Interpolation's e[1] and e[2], the sum of all three e, and
/// Σ(e·depth).
template <typename D> struct TrianglePlanes {
    std::array<D, 3> e1, e2, sum, depth_sum;
    D determinant; ///< determinant of the corners; positive if they run clockwise in the image
};

/// Computes the planes from the corners' homogeneous pixel coordinates, relative to any origin.
template <typename D>
TrianglePlanes<D> triangle_planes(const std::array<D, 3>& x, const std::array<D, 3>& y, const std::array<D, 3>& w,
                                  const std::array<D, 3>& depth) {
    using xsimd::select, duet::select;
    std::array<std::array<D, 3>, 3> e; // [corner][coefficient of x, y, 1]: cross products of the other two corners
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
        e[k] = {y[a] * w[b] - w[a] * y[b], w[a] * x[b] - x[a] * w[b], x[a] * y[b] - y[a] * x[b]};
    }
    TrianglePlanes<D> result;
    const D determinant = x[0] * e[0][0] + y[0] * e[0][1] + w[0] * e[0][2];
    const D sign = select(determinant < D(0), D(-1), D(1));
    result.determinant = determinant;
    for (std::size_t c = 0; c < 3; ++c) {
        result.e1[c] = e[1][c] * sign;
        result.e2[c] = e[2][c] * sign;
        result.sum[c] = (e[0][c] + e[1][c] + e[2][c]) * sign;
        result.depth_sum[c] = (e[0][c] * depth[0] + e[1][c] * depth[1] + e[2][c] * depth[2]) * sign;
    }
    return result;
}

} // namespace duet::raster
