// This file defines the layout and the interpolation of rough_glass_energy.h's tables. rough_glass_table_main.cpp
// generates their contents when the project is built.
#pragma once

#include "common/material/ggx_albedo_table.h"

namespace duet {

/// Holds tables of rough glass's energy, and maps index of refraction, roughness and angle to their rows and columns.
struct RoughGlassTables {
    static constexpr int kIndices = 20, kAlphas = 20, kAngles = 48;
    using Curve = std::array<float, kAngles>; // one value per angle
    using Surface = std::array<std::array<Curve, kAlphas>, kIndices>;
    using Means = std::array<std::array<float, kAlphas>, kIndices>;

    Surface gain, energy_loss_thin, energy_loss_dense;
    Means mean_energy_loss_thin, mean_energy_loss_dense;

    using TableIndex = GgxAlbedoTables::TableIndex;

    // Rows are equal steps of the square root of Fresnel's amplitude at normal incidence, (index − 1)/(index + 1).
    // They range from an index that hardly refracts to 4. The tables vary fastest near index 1, as the cosine of the
    // critical angle does.
    static constexpr float kMinRootAmplitude = 0.0223f, kMaxRootAmplitude = 0.7746f;
    static float index_of(int row) {
        const float amplitude =
            sqr(lerp(kMinRootAmplitude, kMaxRootAmplitude, static_cast<float>(row) / (kIndices - 1)));
        return (1 + amplitude) / (1 - amplitude);
    }
    static TableIndex ior_index(float index) {
        return GgxAlbedoTables::table_index((std::sqrt((index - 1) / (index + 1)) - kMinRootAmplitude) /
                                                (kMaxRootAmplitude - kMinRootAmplitude),
                                            kIndices);
    }
    // As in GgxAlbedoTables, rows are equal steps of roughness. Columns are equal steps of the square root of
    // GgxAlbedoTables::steepness, which makes them denser at grazing angles.
    static constexpr float kSmoothest = GgxAlbedoTables::kSmoothest;
    static float alpha_of(int row) { return sqr(lerp(kSmoothest, 1.0f, static_cast<float>(row) / (kAlphas - 1))); }
    static TableIndex alpha_index(float alpha) {
        return GgxAlbedoTables::table_index((std::sqrt(alpha) - kSmoothest) / (1 - kSmoothest), kAlphas);
    }
    static float cosine_of(int column, float alpha) {
        return GgxAlbedoTables::cosine_of_steepness(alpha, sqr(static_cast<float>(column) / (kAngles - 1)));
    }
    static TableIndex cosine_index(float cosine, float alpha) {
        return GgxAlbedoTables::table_index(std::sqrt(GgxAlbedoTables::steepness(alpha, cosine)), kAngles);
    }

    static float look_up(const Curve& curve, TableIndex at) { return lerp(curve[at.i], curve[at.i + 1], at.f); }
    static float look_up(const Surface& surface, TableIndex index, TableIndex alpha, TableIndex angle) {
        const auto row = [&](std::size_t i) {
            return lerp(look_up(surface[i][alpha.i], angle), look_up(surface[i][alpha.i + 1], angle), alpha.f);
        };
        return lerp(row(index.i), row(index.i + 1), index.f);
    }
    static float look_up(const Means& means, TableIndex index, TableIndex alpha) {
        const auto row = [&](std::size_t i) { return lerp(means[i][alpha.i], means[i][alpha.i + 1], alpha.f); };
        return lerp(row(index.i), row(index.i + 1), index.f);
    }
};

} // namespace duet
