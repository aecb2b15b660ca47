#include "common/material/ggx_albedo.h"

#include "common/material/ggx_albedo_table.h"

namespace duet {

extern const GgxAlbedoTables kGgxAlbedoTables; // written by ggx_albedo_main.cpp

GgxAlbedo ggx_albedo(float alpha, float cosine) {
    return {1 - kGgxAlbedoTables.lost_at(alpha, cosine), kGgxAlbedoTables.share_at(alpha, cosine)};
}

float ggx_lost(float alpha, float cosine) { return kGgxAlbedoTables.lost_at(alpha, cosine); }

GgxMeans ggx_means(float alpha) {
    const auto row = GgxAlbedoTables::row_of(clamp(alpha, 0.0f, 1.0f));
    return {GgxAlbedoTables::look_up(kGgxAlbedoTables.mean_lost, row), GgxAlbedoTables::look_up(kGgxAlbedoTables.mean_share, row)};
}

Rgb ggx_multiple(Rgb average_fresnel, float mean_lost) {
    // Narrow lobes (alpha below 0.03) lose light at grazing angles alone: to find it there would be noise, not energy.
    constexpr float kLeast = 0.004f;
    if (mean_lost < kLeast) return {};
    const Rgb f = average_fresnel;
    const auto channel = [&](float x) { return x * x * (1 - mean_lost) / (1 - x * mean_lost); };
    return Rgb(channel(f.r), channel(f.g), channel(f.b)) * (kInvPi / mean_lost);
}

} // namespace duet
