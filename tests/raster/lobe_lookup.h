// This header looks up the table of lobes one by one, as a reference for the lookup in lanes.
#pragma once

#include "common/vec/scalar.h"
#include "raster/lighting/ggx_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet::raster {

extern const GgxTable<5, kLobeSide> kLobeTable; // written by raster/lighting/ggx_table_main.cpp

/// Interpolates bilinearly between the four nearest entries.
template <std::size_t N, int Side>
std::array<float, N> look_up(const GgxTable<N, Side>& table, float alpha, float cosine) {
    const float roughness = (std::sqrt(alpha) - kSmoothest) / (kRoughest - kSmoothest);
    const float y = clamp(roughness, 0.0f, 1.0f) * (Side - 1),
                x = std::sqrt(clamp(1 - cosine, 0.0f, 1.0f)) * (Side - 1);
    const int row = std::min(static_cast<int>(y), Side - 2), column = std::min(static_cast<int>(x), Side - 2);
    const float fy = y - static_cast<float>(row), fx = x - static_cast<float>(column);
    std::array<float, N> result;
    for (std::size_t k = 0; k < N; ++k)
        result[k] = lerp(lerp(table(row, column)[k], table(row, column + 1)[k], fx),
                         lerp(table(row + 1, column)[k], table(row + 1, column + 1)[k], fx), fy);
    return result;
}

/// alpha is in (0, 1]; values below (1/20)² are clamped to that. `cosine`, between normal and viewer, is in (0, 1].
inline LobeMatrix ggx_lobe(float alpha, float cosine) {
    const auto m = look_up(kLobeTable, alpha, cosine);
    return {m[0], m[1], m[2], m[3], m[4]};
}

} // namespace duet::raster
