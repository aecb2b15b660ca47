// This file defines the layout and the interpolation of rough_glass_energy.h's tables. rough_glass_table_main.cpp
// generates their contents when the project is built.
#pragma once

#include "common/material/ggx_albedo_table.h"

namespace duet {

struct RoughGlassTables {
    static constexpr int kIndices = 20, kAlphas = 20, kAngles = 48;
    using Curve = std::array<float, kAngles>; // one value per angle
    using Surface = std::array<std::array<Curve, kAlphas>, kIndices>;
    using Means = std::array<std::array<float, kAlphas>, kIndices>;

    Surface gain, lost_thin, lost_dense;
    Means mean_lost_thin, mean_lost_dense;

    using Place = GgxAlbedoTables::Place;

    // Rows are equal steps of the square root of Fresnel's amplitude at normal incidence, (index − 1)/(index + 1).
    // They range from an index that hardly refracts to 4. The tables vary fastest near index 1, as the cosine of the
    // critical angle does.
    static constexpr float kLeast = 0.0223f, kMost = 0.7746f;
    static float index_of(int row) {
        const float amplitude = sqr(lerp(kLeast, kMost, static_cast<float>(row) / (kIndices - 1)));
        return (1 + amplitude) / (1 - amplitude);
    }
    static Place place_of_index(float index) {
        return GgxAlbedoTables::place_of((std::sqrt((index - 1) / (index + 1)) - kLeast) / (kMost - kLeast), kIndices);
    }
    // As in GgxAlbedoTables, rows are equal steps of roughness. Columns are equal steps of the square root of
    // GgxAlbedoTables::steepness, which makes them denser at grazing angles.
    static constexpr float kSmoothest = GgxAlbedoTables::kSmoothest;
    static float alpha_of(int row) { return sqr(lerp(kSmoothest, 1.0f, static_cast<float>(row) / (kAlphas - 1))); }
    static Place place_of_alpha(float alpha) {
        return GgxAlbedoTables::place_of((std::sqrt(alpha) - kSmoothest) / (1 - kSmoothest), kAlphas);
    }
    static float cosine_of(int column, float alpha) {
        return GgxAlbedoTables::cosine_of_steepness(alpha, sqr(static_cast<float>(column) / (kAngles - 1)));
    }
    static Place place_of_cosine(float cosine, float alpha) {
        return GgxAlbedoTables::place_of(std::sqrt(GgxAlbedoTables::steepness(alpha, cosine)), kAngles);
    }

    static float look_up(const Curve& curve, Place at) { return lerp(curve[at.i], curve[at.i + 1], at.f); }
    static float look_up(const Surface& surface, Place index, Place alpha, Place angle) {
        const auto row = [&](std::size_t i) {
            return lerp(look_up(surface[i][alpha.i], angle), look_up(surface[i][alpha.i + 1], angle), alpha.f);
        };
        return lerp(row(index.i), row(index.i + 1), index.f);
    }
    static float look_up(const Means& means, Place index, Place alpha) {
        const auto row = [&](std::size_t i) { return lerp(means[i][alpha.i], means[i][alpha.i + 1], alpha.f); };
        return lerp(row(index.i), row(index.i + 1), index.f);
    }
};

} // namespace duet
