#include "common/material/ggx_albedo.h"

#include "common/material/ggx.h"
#include "common/sampling/sobol.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <array>

namespace duet {

namespace {

constexpr int kSide = 32, kSamples = 512;
constexpr float kSmoothest = 0.01f, kRoughest = 1; // roughness is √alpha

float roughness_of(int row) { return lerp(kSmoothest, kRoughest, static_cast<float>(row) / (kSide - 1)); }
float alpha_of(int row) { return sqr(roughness_of(row)); }

// What is lost changes with the cosine over alpha: columns at equal steps of this, from 0 at the horizon to 1.
float steepness(float alpha, float cosine) { return (1 + alpha) * cosine / (cosine + alpha); }
float cosine_of_steepness(float alpha, float x) { return x * alpha / (1 + alpha - x); }
// Schlick's share changes with the cosine, most near the horizon.
float height(float cosine) { return std::sqrt(cosine); }

struct Entry {
    double lost = 0, share = 0;
};
/// By samples of visible normals, whose weight is G₂/G₁.
Entry integrate(float alpha, float cosine) {
    const Vec3 wo(std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine);
    double energy = 0, offset = 0, lost = 0;
    for (int i = 0; i < kSamples; ++i) {
        const Vec2 u((static_cast<float>(i) + 0.5f) / kSamples,
                     static_cast<float>(reverse_bits(static_cast<std::uint32_t>(i)) >> 8) * 0x1p-24f + 0x1p-25f);
        const Vec3 h = ggx_sample_visible_normal(wo, alpha, u), wi = reflect(wo, h);
        const double weight = wi.z > 0 ? static_cast<double>(ggx_g2_over_g1(wo, wi, alpha)) : 0;
        const double x = 1 - static_cast<double>(dot(wo, h));
        energy += weight;
        lost += 1 - weight;
        offset += weight * x * x * x * x * x;
    }
    return {lost / kSamples, energy > 0 ? offset / energy : 0};
}

using Table = std::array<std::array<float, kSide>, kSide>;

struct Place {
    std::size_t i;
    float f;
};
Place place_of(float x) { // of x in [0, 1] among kSide entries
    const float at = clamp(x, 0.0f, 1.0f) * (kSide - 1);
    const int i = std::min(static_cast<int>(at), kSide - 2);
    return {static_cast<std::size_t>(i), at - static_cast<float>(i)};
}
Place row_of(float alpha) { return place_of((std::sqrt(alpha) - kSmoothest) / (kRoughest - kSmoothest)); }

float look_up(const Table& table, Place row, Place column) {
    const auto &low = table[row.i], &high = table[row.i + 1];
    return lerp(lerp(low[column.i], low[column.i + 1], column.f), lerp(high[column.i], high[column.i + 1], column.f), row.f);
}

struct Tables {
    Table lost, share;
    std::array<GgxMeans, kSide> means;

    Tables() {
        parallel_for(kSide, 0, [&](std::size_t row) {
            const float alpha = alpha_of(static_cast<int>(row));
            for (std::size_t column = 0; column < kSide; ++column) {
                const float x = static_cast<float>(column) / (kSide - 1);
                lost[row][column] = static_cast<float>(integrate(alpha, clamp(cosine_of_steepness(alpha, x), 1e-7f, 1.0f)).lost);
                share[row][column] = static_cast<float>(integrate(alpha, std::max(x * x, 1e-7f)).share);
            }
        });
        for (std::size_t row = 0; row < kSide; ++row) means[row] = mean(alpha_of(static_cast<int>(row)));
    }

    GgxMeans mean(float alpha) const {
        constexpr int kSteps = 512;
        double sum_lost = 0, sum_share = 0;
        for (int i = 0; i < kSteps; ++i) {
            const float x = (static_cast<float>(i) + 0.5f) / kSteps, cosine = x * x; // closer near the horizon
            const double step = 4.0 * static_cast<double>(x * cosine) / kSteps;      // 2μ dμ
            const float gone = lost_at(alpha, cosine);
            sum_lost += step * static_cast<double>(gone);
            sum_share += step * static_cast<double>((1 - gone) * share_at(alpha, cosine));
        }
        return {static_cast<float>(sum_lost), static_cast<float>(sum_share)};
    }
    float lost_at(float alpha, float cosine) const {
        alpha = clamp(alpha, sqr(kSmoothest), 1.0f);
        return look_up(lost, row_of(alpha), place_of(steepness(alpha, cosine)));
    }
    float share_at(float alpha, float cosine) const { return look_up(share, row_of(alpha), place_of(height(cosine))); }
};

const Tables& tables() {
    static const Tables all;
    return all;
}

} // namespace

GgxAlbedo ggx_albedo(float alpha, float cosine) {
    return {1 - tables().lost_at(alpha, cosine), tables().share_at(alpha, cosine)};
}

float ggx_lost(float alpha, float cosine) { return tables().lost_at(alpha, cosine); }

GgxMeans ggx_means(float alpha) {
    const Place row = row_of(clamp(alpha, 0.0f, 1.0f));
    const GgxMeans &low = tables().means[row.i], &high = tables().means[row.i + 1];
    return {lerp(low.lost, high.lost, row.f), lerp(low.share, high.share, row.f)};
}

Rgb ggx_multiple(Rgb average_fresnel, float mean_lost) {
    const Rgb f = average_fresnel;
    const auto channel = [&](float x) { return x * x * (1 - mean_lost) / (1 - x * mean_lost); };
    return Rgb(channel(f.r), channel(f.g), channel(f.b)) * (kInvPi / max(mean_lost, 1e-7f));
}

} // namespace duet
