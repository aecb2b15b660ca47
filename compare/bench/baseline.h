// Two runs of the bench: what got slower or less accurate?
#pragma once

#include "compare/bench/estimate.h"
#include "compare/bench/scene_result.h"

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace duet::compare {

/// One row now against the same row then.
struct BaselineRow {
    std::string scene, technique, sampler;
    int spp = 0;
    Estimate mse_ratio, seconds_ratio;    ///< now / then: above 1 is worse
    double share_now = 1, share_then = 1; ///< processor_share of both runs
    bool less_accurate = false, slower = false, more_accurate = false, faster = false;
};

struct BaselineComparison {
    std::vector<BaselineRow> rows;
    std::vector<std::string> unmatched; ///< rows of this run that the baseline does not have
    double drift = 0;

    /// The odds of any false finding among all, if errors and times were equal but for a drift within bounds.
    static constexpr double kSignificance = 0.01;
    bool flagged() const;
};

/// The circumstances that rows must share to be compared, besides scene, files, size, technique, sampler and samples.
struct BenchCircumstances {
    int depth = 0, threads = 0;
    int reference_spp = 0; ///< an error holds the reference's own
};

/// Throws Error where `earlier` is no report of the bench or was made under other circumstances: known before a long
/// run.
void check_baseline(const nlohmann::json& earlier, const BenchCircumstances& now);

/// Compares by Student's t on logarithms (equality_p_value), the significance shared among all tests. A time is a
/// finding only where it is significantly beyond a factor of 1 + drift either way, machines do not keep
/// their pace, and beyond what a busy machine explains: «slower» of the time that the threads really got (time ×
/// processor_share), «faster» likewise of the earlier run's.
/// Throws Error where `earlier` is no report of the bench or has no row in common.
BaselineComparison compare_with_baseline(const std::vector<SceneResult>& results, const nlohmann::json& earlier,
                                         double drift);

} // namespace duet::compare
