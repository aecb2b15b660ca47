// Gradient noise and its sums over octaves.
#pragma once

#include "common/vec/vec.h"

#include <cstdint>

namespace duet {

/// Gradient noise: 0 at each point of the integer lattice, with a gradient there of one of twelve directions, in
/// between twice continuously differentiable, within [−1, 1], of mean 0; it repeats after 2^32. Each seed is another
/// noise. Any finite p. Source: Perlin 2002, «Improving Noise», with gradients by a hash of the lattice point (his
/// table of 256 repeats), and divided by its largest value, 1.0364, so that it keeps within the bounds.
double gradient_noise(Vec3d p, std::uint32_t seed = 0);

/// Σ 2^−i · noise(2^i p), i from 0 to octaves − 1, each octave with a noise of its own, shifted so that their lattices,
/// where each is 0, don't meet. Within ±2 (1 − 2^−octaves), of mean 0.
double fractal_noise(Vec3d p, int octaves);

} // namespace duet
