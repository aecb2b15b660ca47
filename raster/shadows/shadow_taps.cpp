// This file computes how much of a light is hidden by blockers at a known fraction of the way.
#include "raster/shadows/light_cone.h"

#include "common/sampling/sobol.h"
#include "common/sampling/warp.h"

namespace duet::raster {
namespace {

constexpr int kTaps = TapRange::kBlocks * TapRange::kBlock;

/// Stores sample points of a light of each kind, in units of its edges. They form a (0,2)-net, and each block of it
/// is a coarser net.
struct TapTable {
    alignas(64) std::array<float, kTaps> a, b;
};
TapTable tap_table(Emitter::Kind kind) {
    TapTable table;
    for (std::uint32_t i = 0; i < kTaps; ++i) {
        const auto index = static_cast<std::size_t>(i);
        const Vec2 point = sobol_net_point(i, kTaps);
        Vec2 u{point.y, point.x};
        if (kind == Emitter::Kind::kSphere) u = concentric_disk(u);
        if (kind == Emitter::Kind::kTriangle) u = uniform_triangle(u);
        table.a[index] = u.x, table.b[index] = u.y;
    }
    return table;
}
const TapTable& taps_of(Emitter::Kind kind) {
    static const std::array<TapTable, 3> tables{tap_table(Emitter::Kind::kParallelogram),
                                                tap_table(Emitter::Kind::kTriangle), tap_table(Emitter::Kind::kSphere)};
    return tables[static_cast<std::size_t>(kind)];
}

} // namespace

/// Returns how many taps of a range are dark, among those that one face sees. A tap follows the line from the
/// receiver to a point of the light, up to the plane parallel to the light in which the blockers are assumed to lie.
/// Of the four texels around that position, those that see a surface between receiver and light count as dark, with
/// bilinear weights.
/// The surface in such a texel may be in front of or behind the assumed plane, and the line from the receiver to it
/// may miss the light. On a plate tilted toward the light, for example, only the far edge may hide fraction of the
/// light, and the nearer fraction of the plate is seen beside that edge. A texel whose line misses the light does not
/// count. Instead, the tap is repeated at the depth of its surface. This is the first step of an iteration that
/// intersects the line with the depth map (Policarpo, Oliveira and Comba 2005, "Real-Time Relief Mapping on Arbitrary
/// Polygonal Surfaces", intersect a height field in the same way).
float AreaLightShadow::count_dark_taps(float blocker, const Cone& cone, std::size_t face, int first, int count) const {
    const ShadowMap& map = *cube_.faces[face];
    const TapTable& table = taps_of(kind_);
    const float* reversed_depth = map.reversed_depth().pixels().data();
    const Vec3 n = cone.n, axis = cone.o.axis * cone.per_height;
    // A texel in the direction d = (x, y, 1) has its surface at q = d · near / reversed_depth. It is above the
    // receiver's plane where n·(q − p) > slack, and between receiver and light where 0 < axis·(q − p) < 1. All terms
    // are multiplied by the reversed depth to avoid divisions.
    const Floats over(dot(n, cone.p) + cone.slack), before(dot(axis, cone.p)), none(0.0f), one(1.0f), near(cube_.near);
    const float per_texel = cube_.near / cube_.scale;
    const Floats margin(per_texel * cone.per_meter); // weighted texels are up to one texel away from the tap
    struct TapResult {
        /// Stores the weights of texels that hide the light and of those that miss it, and the weighted fraction
        /// of the way of the latter.
        Floats dark, beside, fraction;
    };
    const auto evaluate_tap = [&](const Floats& a, const Floats& b, const Floats& f) {
        const Floats u = a * f, v = b * f, left = one - f;
        const Vec3T<Floats> q = broadcast<Floats>(cone.p) * left + broadcast<Floats>(cone.o.corner) * f +
                                broadcast<Floats>(cone.o.u) * u + broadcast<Floats>(cone.o.v) * v;
        // Positions outside the face are not looked up.
        const auto inside_face = (q.z > none) & (xsimd::abs(q.x) <= q.z) & (xsimd::abs(q.y) <= q.z);
        TapResult result{none, none, none};
        if (!xsimd::any(inside_face)) return result;
        const Floats per_depth = xsimd::select(inside_face, Floats(cube_.scale) / q.z, none);
        const Floats x = Floats(cube_.middle - 0.5f) + q.x * per_depth, y = Floats(cube_.middle - 0.5f) - q.y *
            per_depth;
        const Floats x0 = xsimd::floor(x), y0 = xsimd::floor(y), fx = x - x0, fy = y - y0, gx = one - fx, gy = one - fy;
        const Ints texel_index = truncated(y0 * Floats(static_cast<float>(map.side())) + x0);
        const Floats right = (x0 + Floats(0.5f - cube_.middle)) * Floats(per_texel);
        const Floats up = (Floats(cube_.middle - 0.5f) - y0) * Floats(per_texel);
        const auto add = [&](int step_x, int step_y, const Floats& weight) {
            const Floats seen = gather(reversed_depth + step_y * map.side() + step_x, texel_index);
            const Vec3T<Floats> d{right + Floats(per_texel * static_cast<float>(step_x)),
                                  up - Floats(per_texel * static_cast<float>(step_y)), near};
            const Floats fraction = dot(broadcast<Floats>(axis), d) - before * seen;
            const auto between = inside_face & (dot(broadcast<Floats>(n), d) - over * seen > none) & (fraction > none) &
                                 (fraction < seen);
            if (!xsimd::any(between)) return;
            const auto hides = cone.meets(d - broadcast<Floats>(cone.p) * seen, fraction, margin);
            result.dark += xsimd::select(between & hides, weight, none);
            const Floats beside = xsimd::select(between & !hides, weight, none);
            result.beside += beside;
            result.fraction += xsimd::select(beside > none, beside * fraction / seen, none);
        };
        add(0, 0, gx * gy), add(1, 0, fx * gy), add(0, 1, gx * fy), add(1, 1, fx * fy);
        return result;
    };
    Floats dark(0.0f);
    for (int i = first; i < first + count; i += static_cast<int>(Floats::size)) {
        const auto at = static_cast<std::size_t>(i);
        const Floats a = Floats::load_aligned(&table.a[at]), b = Floats::load_aligned(&table.b[at]);
        const TapResult found = evaluate_tap(a, b, Floats(blocker));
        const auto beside = found.beside > none;
        dark += found.dark;
        if (!xsimd::any(beside)) continue;
        const TapResult there = evaluate_tap(
            a, b, xsimd::select(beside, found.fraction / max(found.beside, Floats(1e-6f)), Floats(blocker)));
        dark += xsimd::select(beside, max(there.dark - found.dark, none), none);
    }
    return xsimd::hadd(dark);
}

} // namespace duet::raster
