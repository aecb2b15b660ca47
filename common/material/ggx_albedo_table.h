// This file defines the layout and the interpolation of ggx_albedo.h's tables. ggx_albedo_main.cpp generates their
// contents when the project is built.
#pragma once

#include "common/vec/vec.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet {

struct GgxAlbedoTables {
    static constexpr int kSide = 32;
    static constexpr float kSmoothest = 0.01f, kRoughest = 1; // range of roughness = √alpha
    using Table = std::array<std::array<float, kSide>, kSide>; // rows: equal steps of roughness; columns: angle

    Table lost, share;
    std::array<float, kSide> mean_lost, mean_share;

    static float roughness_of(int row) { return lerp(kSmoothest, kRoughest, static_cast<float>(row) / (kSide - 1)); }
    // The lost fraction varies with the ratio of cosine to alpha. The columns of `lost` are therefore equal steps of
    // this "steepness", from 0 at grazing angles to 1 at normal incidence.
    template <typename T> static T steepness(T alpha, T cosine) {
        return (T(1) + alpha) * cosine / (cosine + alpha);
    }
    static float cosine_of_steepness(float alpha, float x) { return clamp(x * alpha / (1 + alpha - x), 1e-7f, 1.0f); }
    // Schlick's share varies with the cosine, fastest at grazing angles, so its columns are equal steps of the root.
    static float height(float cosine) { return std::sqrt(cosine); }

    struct Place {
        std::size_t i;
        float f;
    };
    static Place place_of(float x, int entries = kSide) { // maps x in [0, 1] to a table index and a fraction
        const float at = clamp(x, 0.0f, 1.0f) * static_cast<float>(entries - 1);
        const int i = std::min(static_cast<int>(at), entries - 2);
        return {static_cast<std::size_t>(i), at - static_cast<float>(i)};
    }
    static Place row_of(float alpha) { return place_of((std::sqrt(alpha) - kSmoothest) / (kRoughest - kSmoothest)); }

    static float look_up(const Table& table, Place row, Place column) {
        const auto &low = table[row.i], &high = table[row.i + 1];
        return lerp(lerp(low[column.i], low[column.i + 1], column.f),
                    lerp(high[column.i], high[column.i + 1], column.f), row.f);
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
