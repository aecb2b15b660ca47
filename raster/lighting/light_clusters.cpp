#include "raster/lighting/light_clusters.h"

#include <cmath>

namespace duet::raster {
namespace {

using Lanes = xsimd::batch_bool<float>;
constexpr float kHuge = 1e30f; ///< greater than all coordinates, in meters
const Floats kNone(0.0f);

/// Computes the bounding box of points or normals, one batch at a time.
struct Box {
    Vec3T<Floats> low{Floats(kHuge), Floats(kHuge), Floats(kHuge)};
    Vec3T<Floats> high{Floats(-kHuge), Floats(-kHuge), Floats(-kHuge)};

    void extend(const Vec3T<Floats>& v, const Lanes& lanes) {
        low = select(lanes, min(low, v), low), high = select(lanes, max(high, v), high);
    }
    Vec3 lowest() const { return {reduce_min(low.x), reduce_min(low.y), reduce_min(low.z)}; }
    Vec3 highest() const { return {reduce_max(high.x), reduce_max(high.y), reduce_max(high.z)}; }
};

} // namespace

Lanes Cluster::lanes(const GBuffer& gbuffer, int column, int row) const {
    const Floats depth = load(gbuffer.reversed_depth, column, row);
    const Lanes in_depth = (depth > Floats(farther)) & (depth <= Floats(nearer));
    if (lane_bits(in_depth) == 0) return in_depth;
    const auto reflects = [&](const Planes3& c) { return max_component(c.color(column, row)) > kNone; };
    Lanes in_box = reflects(gbuffer.diffuse) | reflects(gbuffer.specular);
    for (const auto& [axis, plane] : {std::pair(&Vec3::x, &gbuffer.normal.x), std::pair(&Vec3::y, &gbuffer.normal.y),
                                      std::pair(&Vec3::z, &gbuffer.normal.z)}) {
        if (n_low.*axis == -kAll && n_high.*axis == kAll) continue;
        const Floats n = load(*plane, column, row);
        in_box = in_box & (n >= Floats(n_low.*axis)) & (n < Floats(n_high.*axis));
    }
    return in_depth & in_box;
}

std::optional<SurfaceBounds> surface_bounds(const GBuffer& gbuffer, const Cluster& cluster) {
    Box points, normals;
    bool any = false;
    for_each_batch_of(gbuffer, cluster, [&](int x, int y) {
        const Lanes lanes = cluster.lanes(gbuffer, x, y);
        if (lane_bits(lanes) == 0) return;
        points.extend(gbuffer.points(x, y), lanes), normals.extend(gbuffer.normal.vector(x, y), lanes);
        any = true;
    });
    if (!any) return std::nullopt;
    return SurfaceBounds{points.lowest(), points.highest(), normals.lowest(), normals.highest()};
}

std::size_t slices_of_depth(const GBuffer& gbuffer, const Cluster& cluster, std::array<Cluster, kDepthSlices>& slices) {
    Floats nearest = kNone, farthest(kHuge);
    for_each_batch_of(gbuffer, cluster, [&](int x, int y) {
        const Lanes lanes = cluster.lanes(gbuffer, x, y);
        const Floats depth = load(gbuffer.reversed_depth, x, y);
        nearest = max(nearest, xsimd::select(lanes, depth, kNone));
        farthest = min(farthest, xsimd::select(lanes, depth, Floats(kHuge)));
    });
    const float most = reduce_max(nearest), least = reduce_min(farthest);
    if (!(most > 0)) return 0;
    constexpr float kOneSlice = 1.2f; // one slice suffices up to this ratio of depths
    const std::size_t count = most < kOneSlice * least ? 1 : kDepthSlices;
    // The slices have equal steps in the logarithm of depth, as in Olsson et al. 2012.
    const float step = std::pow(least / most, 1.0f / static_cast<float>(count));
    float nearer = most;
    for (std::size_t k = 0; k < count; ++k, nearer *= step) {
        slices[k] = cluster;
        slices[k].nearer = nearer, slices[k].farther = k + 1 < count ? nearer * step : 0.0f;
    }
    return count;
}

std::optional<std::array<Cluster, 2>> split_at_edge(const GBuffer& gbuffer, const Cluster& cluster,
                                                    const SurfaceBounds& surfaces) {
    const auto spread_of = [](const SurfaceBounds& b) { return b.n_high - b.n_low; };
    const Vec3 spread = spread_of(surfaces);
    constexpr float kFlat = 0.1f; // a smaller spread of normals is not worth a division
    if (length(spread) < kFlat) return std::nullopt;
    const std::size_t axis = spread.x >= max(spread.y, spread.z) ? 0 : spread.y >= spread.z ? 1 : 2;
    std::array<Cluster, 2> parts{cluster, cluster};
    parts[0].n_high[axis] = parts[1].n_low[axis] = (surfaces.n_low[axis] + surfaces.n_high[axis]) * 0.5f;
    // A division pays only at an abrupt edge. On a curved surface each part keeps half of the normals, and the work
    // stays the same.
    constexpr float kAbrupt = 0.25f;
    for (const Cluster& part : parts)
        if (const auto bounds = surface_bounds(gbuffer, part);
            bounds && length(spread_of(*bounds)) < kAbrupt * length(spread))
            return parts;
    return std::nullopt;
}

} // namespace duet::raster
