// This file defines clouds made of noise.
#pragma once

#include "common/medium/density_grid.h"

namespace duet {

/// Describes a cloud whose density is fractal noise that is raised in the middle of its box and lowered toward its
/// sides. Puffs form where the noise is above a threshold (Ebert et al. 2003, "Texturing and Modeling: A Procedural
/// Approach", ch. 9).
struct Cloud {
    float scale = 1;       ///< cycles of the noise per meter, > 0
    int octaves = 5;       ///< 1 to 16, as of NoiseTexture
    float coverage = 0.5f; ///< 0 to 1: how much of the box is filled
    float softness = 0.3f; ///< > 0: excess of the noise over the threshold at which the density becomes 1
    int resolution = 96;   ///< cells along the longest side of the box, ≥ 1
};
/// Returns the number of points along each axis of a grid of nearly cubic cells, `resolution` of them along the longest
/// side of a box with bounds.
std::array<int, 3> grid_size(const Box3& box, int resolution);
/// Returns the densities of a cloud in a box with bounds, in [0, 1]. It has no density on the sides of the box.
DensityGrid make_cloud(const Cloud& cloud, const Box3& box);

} // namespace duet
