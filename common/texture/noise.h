// This file implements gradient noise and its sums over octaves.
#pragma once

#include "common/vec/vec.h"

#include <cstdint>

namespace duet {

/// Returns gradient noise in [−1, 1], of mean 0, for any finite p. The noise is 0 at each point of the integer
/// lattice, where its gradient has one of twelve directions. In between it is twice continuously differentiable. It
/// repeats after 2^32. Each seed gives a different noise. The source is Perlin 2002, "Improving Noise". Unlike there,
/// gradients come from a hash of the lattice point, because Perlin's table of 256 entries repeats. The value is
/// divided by its maximum of 1.0364, so that it stays within the bounds.
double gradient_noise(Vec3d p, std::uint32_t seed = 0);

/// Returns the fractal sum Σ 2^−i · noise(2^i p) for i from 0 to octaves − 1, within ±2 (1 − 2^−octaves)
/// and of mean 0. Each octave has its own seed and is shifted, so that the lattices, where each octave is 0, do not
/// coincide.
double fractal_noise(Vec3d p, int octaves);

} // namespace duet
