#include "raster/lighting/light_clusters.h"

#include <cmath>

namespace duet::raster {
namespace {

using Lanes = xsimd::batch_bool<float>;
constexpr float kHuge = 1e30f;
constexpr int kBatchesPerRow = LightClusters::kTileSide / static_cast<int>(Floats::size);

/// Encloses a batch of points or normals at a time.
struct Box {
    Vec3T<Floats> low{Floats(kHuge), Floats(kHuge), Floats(kHuge)};
    Vec3T<Floats> high{Floats(-kHuge), Floats(-kHuge), Floats(-kHuge)};

    void extend(const Vec3T<Floats>& v, const Lanes& lanes) {
        low = select(lanes, min(low, v), low), high = select(lanes, max(high, v), high);
    }
    Vec3 lowest() const { return {duet::lowest(low.x), duet::lowest(low.y), duet::lowest(low.z)}; }
    Vec3 highest() const { return {duet::highest(high.x), duet::highest(high.y), duet::highest(high.z)}; }
};

/// Calls visit(batch, x, y) for each batch of a tile that lies in the image.
template <typename Visit> void for_each_batch_of_tile(const GBuffer& gbuffer, int x0, int y0, const Visit& visit) {
    for (int row = 0; row < LightClusters::kTileSide && y0 + row < gbuffer.height(); ++row)
        for (int column = 0; column < kBatchesPerRow; ++column) {
            const int x = x0 + column * static_cast<int>(Floats::size);
            if (x < gbuffer.width()) visit(static_cast<std::size_t>(row * kBatchesPerRow + column), x, y0 + row);
        }
}

} // namespace

/// Holds the bounds of the surfaces of one slice.
struct LightClusters::Slice {
    Vec3 p_low, p_high, n_low, n_high;
    bool smooth; ///< whether some surface may show highlights
};

LightClusters::LightClusters(std::span<const FrameLight> lights)
    : count_(lights.size()), bounds_(static_cast<int>(lights.size()), kRows) {
    for (std::size_t i = 0; i < count_; ++i) {
        const FrameLight& light = lights[i];
        const int column = static_cast<int>(i);
        const auto set = [&](int row, float value) { bounds_(column, row) = value; };
        const auto set_vector = [&](int row, Vec3 v) { set(row, v.x), set(row + 1, v.y), set(row + 2, v.z); };
        constexpr float kSunDistance = 1e9f; // meters: far beyond every scene, while its square is still a float
        Vec3 low = light.position, high = light.position;
        const float power = average(light.emitted);
        float intensity = power, most = kHuge;
        set(kPlane, -1); // with an axis of 0, all points are in front
        switch (light.kind) {
        case FrameLight::Kind::kTriangle:
        case FrameLight::Kind::kQuad: {
            const bool quad = light.kind == FrameLight::Kind::kQuad;
            low += min(min(Vec3(), light.u), min(light.v, quad ? light.u + light.v : Vec3()));
            high += max(max(Vec3(), light.u), max(light.v, quad ? light.u + light.v : Vec3()));
            intensity = power * length(cross(light.u, light.v)) * (quad ? 1.0f : 0.5f), most = kPi * power;
            if (!light.two_sided) set_vector(kAxisX, light.axis), set(kPlane, dot(light.axis, light.position));
            break;
        }
        case FrameLight::Kind::kSphere:
            low -= Vec3(light.radius, light.radius, light.radius), high += Vec3(light.radius, light.radius, light.radius);
            intensity = kPi * sqr(light.radius) * power, most = kPi * power;
            break;
        case FrameLight::Kind::kPoint: break;
        case FrameLight::Kind::kSpot:
            set_vector(kAxisX, light.axis);
            set(kConeCosine, light.cos_outer), set(kConeSine, safe_sqrt(1 - sqr(light.cos_outer)));
            set(kPlane, light.cos_outer >= 0 ? dot(light.axis, light.position) : -kHuge);
            break;
        case FrameLight::Kind::kSun:
            low = high = light.axis * kSunDistance;
            intensity = power * sqr(kSunDistance), most = power;
            break;
        }
        set_vector(kLowX, low), set_vector(kHighX, high);
        set(kIntensity, intensity), set(kMost, most);
    }
}

void LightClusters::list_all(TileLights& result) const {
    result.batch_slices.fill(1);
    for (std::size_t i = 0; i < count_; ++i) result.entries.push_back({static_cast<std::uint32_t>(i), 1});
}

void LightClusters::list(const GBuffer& gbuffer, int x0, int y0, TileLights& result) const {
    result.entries.clear();
    if (count_ <= kFewLights) return list_all(result);
    result.batch_slices.fill(0), result.slices.assign(count_, 0);
    Floats farthest(kHuge), nearest(0.0f);
    for_each_batch_of_tile(gbuffer, x0, y0, [&](std::size_t, int x, int y) {
        const Floats depth = load(gbuffer.reversed_depth, x, y);
        nearest = max(nearest, depth);
        farthest = min(farthest, xsimd::select(depth > Floats(0.0f), depth, Floats(kHuge)));
    });
    const float most = highest(nearest), least = lowest(farthest);
    if (!(most > 0)) return;
    // The slices are equal steps of the logarithm of depth, as in the paper.
    const int slices = most < 1.2f * least ? 1 : kSlices;
    const float step = std::pow(least / most, 1.0f / static_cast<float>(slices));
    float upper = kHuge, lower = most * step;
    for (int k = 0; k < slices; ++k, upper = lower, lower *= step) {
        if (k == slices - 1) lower = 0;
        Box points, normals;
        Floats width(1.0f);
        bool any = false;
        for_each_batch_of_tile(gbuffer, x0, y0, [&](std::size_t batch, int x, int y) {
            const Floats depth = load(gbuffer.reversed_depth, x, y);
            const Lanes lanes = (depth > Floats(lower)) & (depth <= Floats(upper));
            if (lane_bits(lanes) == 0) return;
            any = true;
            result.batch_slices[batch] |= 1u << k;
            points.extend(gbuffer.points(x, y), lanes), normals.extend(gbuffer.normal.vector(x, y), lanes);
            width = xsimd::select(lanes, min(width, load(gbuffer.alpha, x, y)), width);
            if (!gbuffer.coat.empty())
                width = xsimd::select(lanes & (load(gbuffer.coat, x, y) > Floats(0.0f)), Floats(0.0f), width);
        });
        if (any)
            cull({points.lowest(), points.highest(), normals.lowest(), normals.highest(), lowest(width) < kSmoothest},
                 1u << k, result);
    }
    for (std::size_t i = 0; i < count_; ++i)
        if (result.slices[i] != 0) result.entries.push_back({static_cast<std::uint32_t>(i), result.slices[i]});
}

void LightClusters::cull(const Slice& slice, std::uint32_t bit, TileLights& result) const {
    const auto wide = [](Vec3 v) { return spread<Floats>(v); };
    const Vec3T<Floats> p_low = wide(slice.p_low), p_high = wide(slice.p_high), n_low = wide(slice.n_low),
                        n_high = wide(slice.n_high);
    const Vec3 center = (slice.p_low + slice.p_high) * 0.5f, mean = slice.n_low + slice.n_high;
    const Vec3T<Floats> p = wide(center), n = wide(mean / max(length(mean), 1e-6f));
    const float radius = length(slice.p_high - slice.p_low) * 0.5f;
    const Floats none(0.0f);
    const auto bound = [](const Floats& n0, const Floats& n1, const Floats& d0, const Floats& d1) {
        return max(max(n0 * d0, n0 * d1), max(n1 * d0, n1 * d1));
    };
    result.most.resize(static_cast<std::size_t>(bounds_.stride()));
    Floats estimate = none;
    for (int i = 0; i < bounds_.width(); i += static_cast<int>(Floats::size)) {
        const auto row = [&](int r) { return load(bounds_, i, r); };
        const auto vector = [&](int r) { return Vec3T<Floats>(row(r), row(r + 1), row(r + 2)); };
        const Vec3T<Floats> low = vector(kLowX), high = vector(kHighX), axis = vector(kAxisX);
        const Vec3T<Floats> to_low = low - p_high, to_high = high - p_low; // bounds of vectors from surfaces to lights
        const Floats above = bound(n_low.x, n_high.x, to_low.x, to_high.x) +
                             bound(n_low.y, n_high.y, to_low.y, to_high.y) +
                             bound(n_low.z, n_high.z, to_low.z, to_high.z);
        const Floats front = max(axis.x * p_low.x, axis.x * p_high.x) + max(axis.y * p_low.y, axis.y * p_high.y) +
                             max(axis.z * p_low.z, axis.z * p_high.z) - row(kPlane);
        const Vec3T<Floats> from = p - low; // from a spot, whose box is a point
        const Floats along = dot(from, axis), across = xsimd::sqrt(max(dot(from, from) - along * along, none));
        const Floats outside = across * row(kConeCosine) - along * row(kConeSine);
        const Lanes reaches = (above > none) & (front > none) & (outside <= Floats(radius)) & (row(kIntensity) > none);

        const Vec3T<Floats> apart = max(max(to_low, -to_high), Vec3T<Floats>(none, none, none));
        const Floats nearest2 = max(dot(apart, apart), Floats(1e-12f));
        const Floats cosine = min(above * inverse_sqrt(nearest2), Floats(1.0f));
        const Floats most = min(row(kIntensity) * cosine / nearest2, row(kMost));
        const Vec3T<Floats> to = (low + high) * Floats(0.5f) - p;
        const Floats squared = max(dot(to, to), Floats(1e-12f)), inverse = inverse_sqrt(squared);
        const Floats facing = max(xsimd::select(dot(axis, axis) > none, -dot(to, axis) * inverse, Floats(1.0f)), none);
        const Floats there = row(kIntensity) * max(dot(to, n) * inverse, none) * facing * inverse * inverse;
        estimate += xsimd::select(reaches, min(there, row(kMost)), none);
        xsimd::select(reaches, most, none).store_aligned(result.most.data() + i);
    }
    // Sums the bounds by powers of two, and finds the greatest power that can be dropped with all smaller ones.
    const float allowed = slice.smooth ? 0 : kDropped * xsimd::hadd(estimate);
    constexpr int kPowers = 64;
    std::array<float, kPowers> sums{};
    const auto power = [](float x) { return std::clamp(std::ilogb(x) + kPowers / 2, 0, kPowers - 1); };
    for (std::size_t i = 0; i < count_; ++i)
        if (const float x = result.most[i]; x > 0) sums[static_cast<std::size_t>(power(x))] += x;
    int first = 0;
    for (float sum = sums[0]; first < kPowers && sum <= allowed;)
        if (++first < kPowers) sum += sums[static_cast<std::size_t>(first)];
    for (std::size_t i = 0; i < count_; ++i)
        if (result.most[i] > 0 && power(result.most[i]) >= first) result.slices[i] |= bit;
}

} // namespace duet::raster
