// How the table of raster/light/ggx_table.h is computed: nothing but common/material/ggx.h says what it holds.
#pragma once

#include "raster/light/ggx_table.h"

#include <array>
#include <cstddef>

namespace duet::raster {

/// N numbers an entry, Side × Side entries.
template <std::size_t N, int Side> struct GgxTable {
    std::array<std::array<float, N>, std::size_t{Side} * Side> entries;

    std::array<float, N>& operator()(int row, int column) { return entries[static_cast<std::size_t>(row * Side + column)]; }
    const std::array<float, N>& operator()(int row, int column) const {
        return entries[static_cast<std::size_t>(row * Side + column)];
    }
};

inline constexpr int kLobeSide = 16; // entries by roughness and by angle
inline constexpr float kSmoothest = 0.05f, kRoughest = 1; // roughness is √alpha

/// All of it, in parallel: half a second of work, which is done when the project is built (raster/light/ggx_table_main.cpp).
GgxTable<5, kLobeSide> compute_lobe_table();

/// The lobe of one entry, by fitting; `start` is where the search begins.
LobeMatrix fit_lobe(float alpha, float cosine, const LobeMatrix& start);
/// ∫ |f − t| dw over the hemisphere, of the normalized lobe f and the transformed cosine t: 0 where they are the same,
/// 2 where they have nothing in common.
double lobe_distance(float alpha, float cosine, const LobeMatrix& lobe);

} // namespace duet::raster
