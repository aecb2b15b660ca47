// Russian roulette ends paths that carry little light, and weights the others up, so that the mean stays (Arvo and Kirk
// 1990, "Particle Transport and Image Synthesis").
#pragma once

#include "raytrace/integrator/path_state.h"

namespace duet::raytrace {

/// The probability with which Russian roulette lets a path continue, over the path's throughput. Factors that suit a
/// scene of models/ best, from 1 to 14, gain more than a tenth in one of them alone.
inline constexpr float kSurvivalFactor = 4;

/// Holds the outcome of Russian roulette.
template <typename T> struct RouletteT {
    T probability; ///< of survival; may exceed 1
    MaskOf<T> survives;
};
/// Decides by Russian roulette with the random number u whether the path continues, and weights survivors up for the
/// paths that end. The throughput is taken without the factor of refraction. A path with a throughput of at least
/// 1 / kSurvivalFactor continues for certain.
template <typename T> inline RouletteT<T> russian_roulette(T u, PathThroughputT<T>& path) {
    const T probability = max_component(path.throughput) * T(kSurvivalFactor) / path.refraction;
    const MaskOf<T> certain = !(probability < T(1)); // NaN survives, too, so that it is counted as invalid
    if (all(certain)) return {probability, certain};
    path.throughput *= select(certain, T(1), T(1) / probability);
    const MaskOf<T> lucky = u < probability;
    return {probability, MaskOf<T>(certain | lucky)};
}

} // namespace duet::raytrace
