#include "raster/probes/radiance_map.h"

#include "common/material/ggx.h"
#include "common/sampling/hash.h"
#include "common/sampling/sobol.h"
#include "common/system/error.h"
#include "common/system/parallel.h"
#include "common/vec/frame.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

constexpr int kSamples = 64; ///< number of samples of a lobe; a multiple of any batch size

/// Holds samples of the GGX lobe about +z. Each has a weight, and the mip level whose texels subtend the solid angle
/// that the sample represents (Křivánek and Colbert 2008, "Real-time Shading with Filtered Importance Sampling").
struct LobeSamples {
    std::array<Vec3, kSamples> w{};
    std::array<float, kSamples> weight{};
    std::array<std::size_t, kSamples> level{};

    LobeSamples(float alpha, int side, std::size_t levels) {
        const Vec3 n(0, 0, 1);
        const float texel = 4 * kPi / static_cast<float>(side * side);
        float sum = 0;
        for (std::size_t i = 0; i < kSamples; ++i) {
            const Vec2 u(unit_float(reverse_bits(static_cast<std::uint32_t>(i))),
                         (static_cast<float>(i) + 0.5f) / kSamples);
            const Vec3 h = ggx_sample_visible_normal(n, alpha, u);
            w[i] = normalize(reflect(n, h));
            weight[i] = std::max(w[i].z, 0.0f);
            const float solid_angle = 1 / (kSamples * ggx_reflection_pdf(n, h, alpha));
            const float mip = 0.5f * std::log2(std::max(solid_angle / texel, 1.0f)) + 0.5f; // blurs slightly
            level[i] = std::min(static_cast<std::size_t>(mip), levels - 1);
            sum += weight[i];
        }
        for (float& x : weight) x /= sum;
    }
};

/// Returns a map of half the resolution. Texels of the octahedral square differ in solid angle by a factor of up to 5,
/// but neighbors hardly do, so all have equal weight.
OctahedralMap halved(const OctahedralMap& fine) {
    OctahedralMap coarse(fine.side() / 2);
    for (int y = 0; y < coarse.side(); ++y)
        for (int x = 0; x < coarse.side(); ++x)
            for (std::size_t c = 0; c < OctahedralMap::kChannels; ++c)
                coarse.texel(x, y)[c] = 0.25f * (fine.texel(2 * x, 2 * y)[c] + fine.texel(2 * x + 1, 2 * y)[c] +
                                                 fine.texel(2 * x, 2 * y + 1)[c] + fine.texel(2 * x + 1, 2 * y + 1)[c]);
    coarse.finish();
    return coarse;
}

/// Holds the channels of a batch of texels.
using Texels = std::array<Floats, OctahedralMap::kChannels>;

/// Returns the mean of the lobe's samples about each of some unit directions.
Texels filtered(const std::vector<OctahedralMap>& mips, const LobeSamples& samples, const Vec3T<Floats>& axis) {
    const FrameT<Floats> frame = frame_from_normal(axis);
    Texels sum;
    sum.fill(Floats(0.0f));
    for (std::size_t i = 0; i < kSamples; ++i) {
        if (samples.weight[i] == 0) continue;
        const Vec3T<Floats> w = frame.to_world(Vec3T<Floats>(samples.w[i]));
        const Texels texels = mips[samples.level[i]].nearest<OctahedralMap::kChannels>(w);
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += texels[c] * Floats(samples.weight[i]);
    }
    return sum;
}

/// Sets each texel to the mean of the lobe's samples about its direction.
void filter(const std::vector<OctahedralMap>& mips, const LobeSamples& samples, OctahedralMap& map, int threads) {
    const std::size_t side = static_cast<std::size_t>(map.side());
    DUET_CHECK_EQ(side * side % kPacketSize, 0u);
    parallel_for(side * side / kPacketSize, threads, [&](std::size_t packet) {
        const auto column = [&](std::size_t i) { return static_cast<int>((packet * kPacketSize + i) % side); };
        const auto row = [&](std::size_t i) { return static_cast<int>((packet * kPacketSize + i) / side); };
        PacketOf<float> x, y, z;
        for (std::size_t i = 0; i < kPacketSize; ++i) {
            const Vec3 w = map.direction(column(i), row(i));
            x[i] = w.x, y[i] = w.y, z[i] = w.z;
        }
        std::array<PacketOf<float>, OctahedralMap::kChannels> means;
        for (std::size_t i = 0; i < kPacketSize; i += Floats::size) {
            const Texels mean = filtered(mips, samples, {load(x, i), load(y, i), load(z, i)});
            for (std::size_t c = 0; c < means.size(); ++c) store(means[c], i, mean[c]);
        }
        for (std::size_t i = 0; i < kPacketSize; ++i)
            for (std::size_t c = 0; c < means.size(); ++c) map.texel(column(i), row(i))[c] = means[c][i];
    });
    map.finish();
}

template <typename Value> void for_each_texel(OctahedralMap& map, int threads, const Value& value) {
    parallel_for(static_cast<std::size_t>(map.side()), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < map.side(); ++x) map.texel(x, y) = value(map.direction(x, y));
    });
    map.finish();
}

} // namespace

RadianceMap::RadianceMap(int side, const Source& without_lights, const Source& with_lights, int threads)
    : sharp_(side) {
    const auto sample = [&](const Source& source, OctahedralMap& map) {
        for_each_texel(map, threads, [&](Vec3 w) -> OctahedralMap::Texel {
            const auto [radiance, distance] = source(w);
            return {radiance.r, radiance.g, radiance.b, 1 / clamp(distance, 1 / kFarthest, kFarthest)};
        });
    };
    sample(without_lights, sharp_);
    if (with_lights) sample(with_lights, bright_ = OctahedralMap(side));
    std::vector<OctahedralMap> mips{sharp_};
    while (mips.back().side() > 4) mips.push_back(halved(mips.back()));
    for (int k = 0; k < kLevels; ++k) {
        const float roughness = static_cast<float>(k + 1) / kLevels;
        OctahedralMap& map = rough_[static_cast<std::size_t>(k)];
        map = OctahedralMap(std::clamp(side >> (k + 1), 8, 64));
        const LobeSamples samples(sqr(roughness), side, mips.size());
        filter(mips, samples, map, threads);
    }
}

RgbT<Floats> RadianceMap::at(const Vec3T<Floats>& w) const {
    const auto [r, g, b] = (bright_.empty() ? sharp_ : bright_).at<3>(w);
    return {r, g, b};
}

/// Returns kCount channels, from index `first` on, filtered by lobes of GGX width alpha.
template <std::size_t kCount>
std::array<Floats, kCount> RadianceMap::lookup(const Vec3T<Floats>& axis, const Floats& alpha,
                                               std::size_t first) const {
    const Floats level = xsimd::sqrt(alpha) * Floats(static_cast<float>(kLevels)); // 0: unfiltered
    std::array<Floats, kCount> sum;
    sum.fill(Floats(0.0f));
    for (int k = 0; k <= kLevels; ++k) {
        // Levels are interpolated linearly: each has a tent of width 2 as its weight.
        const Floats weight = max(Floats(1.0f) - abs(level - Floats(static_cast<float>(k))), Floats(0.0f));
        if (!xsimd::any(weight > Floats(0.0f))) continue;
        const OctahedralMap& map = k == 0 ? sharp_ : rough_[static_cast<std::size_t>(k - 1)];
        const std::array<Floats, kCount> texels = map.at<kCount>(axis, first);
        for (std::size_t c = 0; c < kCount; ++c) sum[c] += texels[c] * weight;
    }
    return sum;
}

RgbT<Floats> RadianceMap::at(const Vec3T<Floats>& axis, const Floats& alpha) const {
    const auto [r, g, b] = lookup<3>(axis, alpha, 0);
    return {r, g, b};
}

Floats RadianceMap::distance(const Vec3T<Floats>& axis, const Floats& alpha) const {
    return Floats(1.0f) / lookup<1>(axis, alpha, kInverseDistance)[0];
}

std::size_t RadianceMap::memory_bytes() const {
    std::size_t sum = sharp_.memory_bytes() + bright_.memory_bytes();
    for (const OctahedralMap& map : rough_) sum += map.memory_bytes();
    return sum;
}

} // namespace duet::raster
