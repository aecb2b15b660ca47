// Implements Russian roulette. It ends paths that carry little light, and increases the weight of the others, so that
// the mean is preserved (Arvo and Kirk 1990, "Particle Transport and Image Synthesis").
#pragma once

#include "raytrace/integrator/path_state.h"

namespace duet::raytrace {

/// The probability with which Russian roulette lets a path continue, over the path's throughput. Factors that suit a
/// scene of models/ best, from 1 to 14, gain more than a tenth in one of them alone.
inline constexpr float kSurvivalFactor = 4;

/// Holds the outcome of Russian roulette.
template <typename T> struct RouletteT {
    T probability; ///< survival probability; may exceed 1
    MaskOf<T> survives;
};
/// Decides by the random number u whether the path continues, and divides the throughput of survivors by the survival
/// probability. That probability ignores the factor of refraction. A path with a throughput of at least 1 /
/// kSurvivalFactor always continues.
template <typename T> inline RouletteT<T> russian_roulette(T u, PathThroughputT<T>& path) {
    const T probability = max_component(path.throughput) * T(kSurvivalFactor) / path.refraction;
    const MaskOf<T> certain = !(probability < T(1)); // NaN survives, too, and is then counted as invalid
    if (all(certain)) return {probability, certain};
    path.throughput *= select(certain, T(1), T(1) / probability);
    const MaskOf<T> lucky = u < probability;
    return {probability, MaskOf<T>(certain | lucky)};
}

} // namespace duet::raytrace
