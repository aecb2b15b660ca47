// This file recovers the normals of the triangles that the pixels of a G-buffer show.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/gbuffer/neighbors.h"

namespace duet::raster {

/// Returns the unit normals of the triangles that a batch of pixels shows, on the side of the shading normals n. A
/// normal is the cross product of the offsets from the point p to a neighbor in its row and to one in its column.
/// Reversed depth (in an orthographic view, depth) is linear over a triangle. Of two neighbors on opposite sides, the
/// one with the smaller second difference of that depth is therefore used. Where both second differences exceed
/// rounding, as on spheres and fine meshes, and where GBuffer::position holds the points, the result is n.
inline Vec3T<Floats> facet_normals(const GBuffer& gbuffer, const Vec3T<Floats>& p, const Vec3T<Floats>& n, int x,
                                   int y) {
    if (!gbuffer.position.empty()) return n;
    constexpr float kRounding = 0x1p-20f; // relative rounding error of a second difference
    const bool perspective = gbuffer.projection.perspective();
    const Floats zero(0.0f), tiny(1e-37f), one(1.0f), here = load(gbuffer.reversed_depth, x, y);
    const auto linear = [&](const Floats& depth) { return perspective ? depth : one / depth; };
    const Floats column = Floats(static_cast<float>(x)) + load(kLanesAsFloats, 0),
                 last(static_cast<float>(gbuffer.width() - 1));
    struct Neighbor {
        Vec3T<Floats> offset; ///< vector from p to the neighbor's point
        Floats bend;          ///< relative second difference of the linear depth; above 1 if nothing is visible
    };
    const auto neighbor = [&](int dx, int dy) -> Neighbor {
        const Floats depth = load_at(gbuffer.reversed_depth, x + dx, y + dy),
                     next = load_at(gbuffer.reversed_depth, x + 2 * dx, y + 2 * dy);
        const Floats at = column + Floats(static_cast<float>(dx));
        const bool row_visible = y + dy >= 0 && y + dy < gbuffer.height();
        const auto visible = (min(depth, next) > zero) & (at >= zero) & (at <= last) &
                             (Floats(row_visible ? 1.0f : 0.0f) > zero);
        const Floats bend = abs(linear(next) - linear(depth) - (linear(depth) - linear(here))) / linear(here);
        return {gbuffer.projection.point(at, Floats(static_cast<float>(y + dy)), max(depth, tiny)) - p,
                xsimd::select(visible, bend, Floats(2.0f))};
    };
    const auto flatter = [&](int dx, int dy) -> Neighbor {
        const Neighbor after = neighbor(dx, dy), before = neighbor(-dx, -dy);
        return {select(after.bend < before.bend, after.offset, -before.offset), min(after.bend, before.bend)};
    };
    const Neighbor across = flatter(1, 0), down = flatter(0, 1);
    const Vec3T<Floats> facet = cross(across.offset, down.offset);
    const Floats over_length = inverse_sqrt(max(dot(facet, facet), tiny));
    return select(max(across.bend, down.bend) < Floats(kRounding),
                  facet * xsimd::select(dot(facet, n) < zero, -over_length, over_length), n);
}

} // namespace duet::raster
