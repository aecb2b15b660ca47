// This file declares the bench's results for one scene.
#pragma once

#include "compare/bench/bias_check.h"
#include "compare/bench/equal_time.h"
#include "compare/bench/measure.h"
#include "compare/bench/render_reference.h"

#include <string>
#include <vector>

namespace duet::compare {

/// Holds the comparison of the reference with another estimator's.
struct IndependentCheck {
    CachedReference other;
    BiasCheck check;
    std::vector<std::string> approximations; ///< of the other estimator; with any, a disagreement is no failure

    bool failed() const { return !check.consistent() && approximations.empty(); }
};

/// Holds all rows of one scene, and the reference that they are compared with.
struct SceneResult {
    std::string scene;      ///< file name as given
    std::string scene_hash; ///< hash_scene_files
    int width = 0, height = 0;
    CachedReference reference;
    std::vector<IndependentCheck> checks; ///< one per independent estimator
    std::string no_naive;                 ///< why `naive` is not among the checks; empty if it is
    std::vector<Measurement> rows;
    std::vector<EqualTimeRow> equal_times;
    double processor_share = 1; ///< processor_share() of the rows (measure.h)
};

} // namespace duet::compare
