// How much of a light is hidden by blockers at a known fraction of the way.
#include "raster/light_cone.h"

#include "common/sampling/sobol.h"
#include "common/sampling/warp.h"

namespace duet::raster {
namespace {

constexpr int kTaps = TapRange::kBlocks * TapRange::kBlock;

/// Points of a light of each kind, as parts of its edges: a (0,2)-net, of which each block is a coarser one.
struct TapTable {
    alignas(64) std::array<float, kTaps> a, b;
};
TapTable tap_table(Emitter::Kind kind) {
    TapTable table;
    for (std::uint32_t i = 0; i < kTaps; ++i) {
        const auto index = static_cast<std::size_t>(i);
        const Vec2 point = net_point(i, kTaps);
        Vec2 u{point.y, point.x};
        if (kind == Emitter::Kind::kBall) u = concentric_disk(u);
        if (kind == Emitter::Kind::kTriangle) u = uniform_triangle(u);
        table.a[index] = u.x, table.b[index] = u.y;
    }
    return table;
}
const TapTable& taps_of(Emitter::Kind kind) {
    static const std::array<TapTable, 3> tables{tap_table(Emitter::Kind::kParallelogram),
                                                tap_table(Emitter::Kind::kTriangle), tap_table(Emitter::Kind::kBall)};
    return tables[static_cast<std::size_t>(kind)];
}

} // namespace

/// How many of some taps, in the plane parallel to the light in which blockers are taken to be, are dark, of those that
/// one face sees: of the four texels about each, weighed by how near they are, those that see something between
/// receiver and light.
float SoftLight::dark_taps(float blocker, const Cone& cone, std::size_t face, int first, int count) const {
    const ShadowMap& map = *cube_.faces[face];
    const TapTable& table = taps_of(kind_);
    const float* nearness = map.nearness().pixels().data();
    const Vec3 n = cone.n, axis = cone.o.axis * cone.per_height;
    // A texel in the direction d = (x, y, 1) stands at q = d · near / nearness: over the plane where n·(q − p) > slack,
    // between where 0 < axis·(q − p) < 1. All times nearness, so that nothing is divided.
    const Floats over(dot(n, cone.p) + cone.slack), before(dot(axis, cone.p));
    const float per_texel = cube_.near / cube_.scale;
    const Floats n_x(n.x * per_texel), n_y(-n.y * per_texel), a_x(axis.x * per_texel), a_y(-axis.y * per_texel);
    const Vec3 start = cone.p * (1 - blocker) + cone.o.corner * blocker, u = cone.o.u * blocker, v = cone.o.v * blocker;
    Floats dark(0.0f);
    for (int i = first; i < first + count; i += static_cast<int>(Floats::size)) {
        const auto at = static_cast<std::size_t>(i);
        const Floats a = Floats::load_aligned(&table.a[at]), b = Floats::load_aligned(&table.b[at]);
        const Floats qx = Floats(start.x) + a * Floats(u.x) + b * Floats(v.x), qy = Floats(start.y) + a * Floats(u.y) + b * Floats(v.y),
                     qz = Floats(start.z) + a * Floats(u.z) + b * Floats(v.z);
        // Of what is beyond the face nothing is looked up.
        const auto seen_here = (qz > Floats(0.0f)) & (xsimd::abs(qx) <= qz) & (xsimd::abs(qy) <= qz);
        if (!xsimd::any(seen_here)) continue;
        const Floats per_depth = xsimd::select(seen_here, Floats(cube_.scale) / qz, Floats(0.0f));
        const Floats x = Floats(cube_.middle - 0.5f) + qx * per_depth, y = Floats(cube_.middle - 0.5f) - qy * per_depth;
        const Floats x0 = xsimd::floor(x), y0 = xsimd::floor(y), fx = x - x0, fy = y - y0;
        const Ints place = truncated(y0 * Floats(static_cast<float>(map.side())) + x0);
        const Floats from_middle_x = x0 + Floats(0.5f - cube_.middle), from_middle_y = y0 + Floats(0.5f - cube_.middle);
        const Floats height = Floats(n.z * cube_.near) + n_x * from_middle_x + n_y * from_middle_y;
        const Floats way = Floats(axis.z * cube_.near) + a_x * from_middle_x + a_y * from_middle_y;
        const auto hidden = [&](int step, const Floats& h, const Floats& w, const Floats& weight) {
            const Floats seen = gather(nearness + step, place), part = w - before * seen;
            const auto between = (h - over * seen > Floats(0.0f)) & (part > Floats(0.0f)) & (part < seen);
            return xsimd::select(between, weight, Floats(0.0f));
        };
        const Floats one(1.0f), gx = one - fx, gy = one - fy;
        const Floats upper = hidden(0, height, way, gx * gy) + hidden(1, height + n_x, way + a_x, fx * gy);
        const Floats lower = hidden(map.side(), height + n_y, way + a_y, gx * fy) +
                             hidden(map.side() + 1, height + n_x + n_y, way + a_x + a_y, fx * fy);
        dark += xsimd::select(seen_here, upper + lower, Floats(0.0f));
    }
    return xsimd::hadd(dark);
}

} // namespace duet::raster
