// This file compares two runs of the bench: it finds the rows that became slower or less accurate.
#pragma once

#include "compare/bench/estimate.h"
#include "compare/bench/scene_result.h"

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace duet::compare {

/// Holds one row of this run, compared with the same row of the baseline.
struct BaselineRow {
    std::string scene, technique, sampler;
    int spp = 0;
    Estimate mse_ratio, seconds_ratio;    ///< this run / baseline: above 1 is worse
    double share_now = 1, share_then = 1; ///< processor_share of both runs
    bool less_accurate = false, slower = false, more_accurate = false, faster = false;
};

/// Compares the rows of two runs.
struct BaselineComparison {
    std::vector<BaselineRow> rows;
    std::vector<std::string> unmatched; ///< rows of this run that are not in the baseline
    double drift = 0;

    /// This is the probability of any false finding among all rows if errors are equal and times differ by at most the
    /// drift.
    static constexpr double kSignificance = 0.01;
    bool flagged() const;
};

/// Holds the settings that must be equal for rows to be comparable, besides scene, files, size, technique, sampler and
/// sample count.
struct BenchConditions {
    int depth = 0, threads = 0;
    int reference_spp = 0;            ///< matters because a measured error includes the reference's own
    std::string reference_by{"path"}; ///< the integrator of the reference
};

/// Throws Error if `earlier` is not a report of the bench or was made with other settings. Call it before a long run.
void check_baseline(const nlohmann::json& earlier, const BenchConditions& now);

/// Compares by Student's t-test on logarithms (p_value_above_one), with the significance divided among all tests. A
/// time difference is a finding only if it significantly exceeds a factor of 1 + drift, because a CPU's speed changes
/// between runs. It must also exceed what other programs on the CPU explain: "slower" is tested on this run's time ×
/// processor_share (the CPU time that the threads received), and "faster" on the earlier run's. Throws Error if
/// `earlier` is not a report of the bench or has no row in common.
BaselineComparison compare_with_baseline(const std::vector<SceneResult>& results, const nlohmann::json& earlier,
                                         double drift);

} // namespace duet::compare
