// Gradient noise.
#pragma once

#include "common/vec/vec.h"

namespace duet {

/// Gradient noise at p, in [−1, 1]: 0 at lattice points, twice continuously differentiable (Perlin 2002, «Improving
/// Noise»), with gradients chosen by a hash of the lattice point, with a period of
/// 2^32. Finite for every finite p.
double gradient_noise(Vec3d p);

/// Σ noise(2^i p) / 2^i over the octaves: fractional Brownian motion; within ±2.
double fractal_noise(Vec3d p, int octaves);
/// Σ |noise(2^i p)| / 2^i: Perlin's turbulence, ≥ 0.
double turbulence(Vec3d p, int octaves);

} // namespace duet
