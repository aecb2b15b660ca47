// This header declares the fit of linearly transformed cosines to the GGX reflection lobe, by roughness and angle. The
// table is derived only from common/material/ggx.h.
#pragma once

#include "raster/lighting/lobe_matrix.h"

#include <array>
#include <cstddef>

namespace duet::raster {

/// Stores a table of Side × Side entries with N numbers each.
template <std::size_t N, int Side> struct GgxTable {
    std::array<std::array<float, N>, std::size_t{Side} * Side> entries;

    std::array<float, N>& operator()(int row, int column) {
        return entries[static_cast<std::size_t>(row * Side + column)];
    }
    const std::array<float, N>& operator()(int row, int column) const {
        return entries[static_cast<std::size_t>(row * Side + column)];
    }
};

inline constexpr int kLobeSide = 16; // number of entries by roughness, and by angle
inline constexpr float kSmoothest = 0.05f, kRoughest = 1; // roughness is √alpha

/// Computes the whole table in parallel. This takes half a second and runs when the project is built
/// (raster/lighting/ggx_table_main.cpp).
GgxTable<5, kLobeSide> compute_lobe_table();

/// Returns ∫ |f − t| dw over the hemisphere, for the normalized lobe f and the transformed cosine t. It is 0 where
/// they are equal and 2 where they do not overlap.
double lobe_distance(float alpha, float cosine, const LobeMatrix& lobe);

} // namespace duet::raster
