// Russian roulette decides by expected contribution: estimate_survival_factor estimates below which throughput it may
// end a path.
#pragma once

#include "common/camera/camera.h"

namespace duet::raytrace {

struct PathTracerSceneData;
struct PathTracerSettings;

/// This is the default if nothing is known of the scene: a path with a throughput of at least 1/4 continues for
/// certain.
inline constexpr float kDefaultSurvivalFactor = 4;

/// Returns the roulette survival factor: a path survives with a probability of its throughput × this factor, where
/// that is below 1 (see survival). The factor minimizes error × cost of the image. The error is half MSE and half
/// relMSE, each relative to its value without roulette, and the cost is the number of rays.
///
/// A path that continues costs its rays. A path that may end adds variance, because survivors are weighted up: the
/// squares of their light count. Both are summed over a few paths of the image, which are traced beforehand almost
/// without roulette and leave a record of each step. (Bolin and Meyer 1997, Vorba and Křivánek 2016 and Rath et al.
/// 2022 weigh the same two; here one number serves the whole image, and measurements.md says what more would gain.) A
/// few paths are a noisy estimate: another factor than kDefaultSurvivalFactor must be better by two standard errors.
///
/// At most 2,048 paths are traced, and at most one for every 8 pixels. Images too small for 512 paths get
/// kDefaultSurvivalFactor. The paths have a seed of their own and do not depend on samples, threads or skips, so that
/// shards and continued films have the same factor. The factor is in [1, 16]; with 1, a survivor's throughput is at
/// most that of a camera path.
float estimate_survival_factor(const PathTracerSceneData& prepared, const View& view,
                               const PathTracerSettings& settings);

} // namespace duet::raytrace
