// This file defines the layout and the interpolation of ggx_albedo.h's tables. ggx_albedo_main.cpp generates their
// contents when the project is built.
#pragma once

#include "common/vec/vec.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet {

/// Holds tables of GGX's directional albedo, and maps roughness and angle to their rows and columns.
struct GgxAlbedoTables {
    static constexpr int kSize = 32;
    static constexpr float kSmoothest = 0.01f, kRoughest = 1; // range of roughness = √alpha
    using Table = std::array<std::array<float, kSize>, kSize>; // rows: equal steps of roughness; columns: angle

    Table energy_loss, schlick_weight;
    std::array<float, kSize> mean_energy_loss, mean_schlick_weight;

    static float roughness_of(int row) { return lerp(kSmoothest, kRoughest, static_cast<float>(row) / (kSize - 1)); }
    // The lost fraction varies with the ratio of cosine to alpha. The columns of `energy_loss` are therefore equal
    // steps of this "steepness", from 0 at grazing angles to 1 at normal incidence.
    template <typename T> static T steepness(T alpha, T cosine) {
        return (T(1) + alpha) * cosine / (cosine + alpha);
    }
    static float cosine_of_steepness(float alpha, float x) { return clamp(x * alpha / (1 + alpha - x), 1e-7f, 1.0f); }
    // The Schlick weight varies with the cosine, fastest at grazing angles, so its columns are equal steps of the
    // square root of the cosine.
    static float height(float cosine) { return std::sqrt(cosine); }

    struct TableIndex {
        std::size_t i;
        float f;
    };
    static TableIndex table_index(float x, int entries = kSize) { // maps x in [0, 1] to a table index and a fraction
        const float at = clamp(x, 0.0f, 1.0f) * static_cast<float>(entries - 1);
        const int i = std::min(static_cast<int>(at), entries - 2);
        return {static_cast<std::size_t>(i), at - static_cast<float>(i)};
    }
    static TableIndex roughness_index(float alpha) {
        return table_index((std::sqrt(alpha) - kSmoothest) / (kRoughest - kSmoothest));
    }

    static float look_up(const Table& table, TableIndex row, TableIndex column) {
        const auto &low = table[row.i], &high = table[row.i + 1];
        return lerp(lerp(low[column.i], low[column.i + 1], column.f),
                    lerp(high[column.i], high[column.i + 1], column.f), row.f);
    }
    static float look_up(const std::array<float, kSize>& table, TableIndex row) {
        return lerp(table[row.i], table[row.i + 1], row.f);
    }

    float energy_loss_at(float alpha, float cosine) const {
        alpha = clamp(alpha, sqr(kSmoothest), 1.0f);
        return look_up(energy_loss, roughness_index(alpha), table_index(steepness(alpha, cosine)));
    }
    float schlick_weight_at(float alpha, float cosine) const {
        return look_up(schlick_weight, roughness_index(alpha), table_index(height(cosine)));
    }
};

} // namespace duet
