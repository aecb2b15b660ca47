// This file recovers the normals of the triangles that the pixels of a G-buffer show.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/gbuffer/neighbors.h"

namespace duet::raster {

/// Returns the unit normals of the flat surfaces in a batch of pixels, on the side of the shading normals n. They
/// follow from the points p and those of one neighbor in the row and one in the column: of both, the one that is more
/// nearly on a line with the next pixel, because reversed depth is linear over a triangle and bends at its edges. Where
/// no neighbor is visible, or the result leans away from the shading normal by more than 75 degrees, and where the
/// points are no image of a view, it is the shading normal.
inline Vec3T<Floats> facet_normals(const GBuffer& gbuffer, const Vec3T<Floats>& p, const Vec3T<Floats>& n, int x,
                                   int y) {
    if (!gbuffer.position.empty()) return n;
    const Floats zero(0.0f), tiny(1e-37f), here = load(gbuffer.reversed_depth, x, y);
    const Floats column = Floats(static_cast<float>(x)) + load(kLanesAsFloats, 0),
                 last(static_cast<float>(gbuffer.width() - 1));
    struct Neighbor {
        Vec3T<Floats> offset; ///< from p; zero where none is visible
        Floats bend;          ///< of the reversed depth there; above 1 where none is visible
    };
    const auto neighbor = [&](int dx, int dy) -> Neighbor {
        const Floats depth = load_at(gbuffer.reversed_depth, x + dx, y + dy),
                     next = load_at(gbuffer.reversed_depth, x + 2 * dx, y + 2 * dy);
        const Floats at = column + Floats(static_cast<float>(dx));
        const bool row_visible = y + dy >= 0 && y + dy < gbuffer.height();
        const auto visible = (depth > zero) & (at >= zero) & (at <= last) & (Floats(row_visible ? 1.0f : 0.0f) > zero);
        const Vec3T<Floats> q = gbuffer.projection.point(at, Floats(static_cast<float>(y + dy)), max(depth, tiny));
        return {select(visible, q - p, Vec3T<Floats>{zero, zero, zero}),
                xsimd::select(visible, abs(next - depth - (depth - here)), Floats(4.0f))};
    };
    const auto tangent = [&](int dx, int dy) {
        const Neighbor after = neighbor(dx, dy), before = neighbor(-dx, -dy);
        return select(after.bend < before.bend, after.offset, -before.offset);
    };
    const Vec3T<Floats> facet = cross(tangent(1, 0), tangent(0, 1));
    const Floats over_length = inverse_sqrt(max(dot(facet, facet), tiny)), cosine = dot(facet, n) * over_length;
    constexpr float kLeastCosine = 0.26f;
    return select(abs(cosine) > Floats(kLeastCosine),
                  facet * xsimd::select(cosine < zero, -over_length, over_length), n);
}

} // namespace duet::raster
