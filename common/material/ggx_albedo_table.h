// The tables of ggx_albedo.h: where their entries lie, and how they are looked up. Written when the project is built, by
// ggx_albedo_main.cpp.
#pragma once

#include "common/vec/vec.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet {

struct GgxAlbedoTables {
    static constexpr int kSide = 32;
    static constexpr float kSmoothest = 0.01f, kRoughest = 1; // roughness is √alpha
    using Table = std::array<std::array<float, kSide>, kSide>; // by roughness in equal steps, and by angle

    Table lost, share;
    std::array<float, kSide> mean_lost, mean_share;

    static float roughness_of(int row) { return lerp(kSmoothest, kRoughest, static_cast<float>(row) / (kSide - 1)); }
    // What is lost changes with the cosine over alpha: columns at equal steps of this, from 0 at the horizon to 1.
    static float steepness(float alpha, float cosine) { return (1 + alpha) * cosine / (cosine + alpha); }
    static float cosine_of_steepness(float alpha, float x) { return clamp(x * alpha / (1 + alpha - x), 1e-7f, 1.0f); }
    // Schlick's share changes with the cosine, most near the horizon.
    static float height(float cosine) { return std::sqrt(cosine); }

    struct Place {
        std::size_t i;
        float f;
    };
    static Place place_of(float x, int entries = kSide) { // of x in [0, 1] among so many entries
        const float at = clamp(x, 0.0f, 1.0f) * static_cast<float>(entries - 1);
        const int i = std::min(static_cast<int>(at), entries - 2);
        return {static_cast<std::size_t>(i), at - static_cast<float>(i)};
    }
    static Place row_of(float alpha) { return place_of((std::sqrt(alpha) - kSmoothest) / (kRoughest - kSmoothest)); }

    static float look_up(const Table& table, Place row, Place column) {
        const auto &low = table[row.i], &high = table[row.i + 1];
        return lerp(lerp(low[column.i], low[column.i + 1], column.f), lerp(high[column.i], high[column.i + 1], column.f),
                    row.f);
    }
    static float look_up(const std::array<float, kSide>& table, Place row) {
        return lerp(table[row.i], table[row.i + 1], row.f);
    }

    float lost_at(float alpha, float cosine) const {
        alpha = clamp(alpha, sqr(kSmoothest), 1.0f);
        return look_up(lost, row_of(alpha), place_of(steepness(alpha, cosine)));
    }
    float share_at(float alpha, float cosine) const { return look_up(share, row_of(alpha), place_of(height(cosine))); }
};

} // namespace duet
