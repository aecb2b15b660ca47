// The bench's figures as JSON, as CSV, as text and as a page.
#pragma once

#include "compare/bench/baseline.h"
#include "compare/bench/bench.h"
#include "compare/bench/scene_result.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace duet::compare {

/// report.json. `scenes`: for each scene its reference, its bias check, and `rows`, a row being a technique, a sampler
/// and a number of samples; an estimate is {value, low, high, relative_error, dof}, low and high its 95 % band; null
/// stands for what is infinite or unknown. `baseline` where one was given.
nlohmann::json bench_json(const BenchOptions& options, const std::vector<SceneResult>& results,
                          const std::optional<BaselineComparison>& baseline);

/// bench.csv: a header, then a line a row of all scenes. Made from bench_json's.
std::string bench_csv(const nlohmann::json& report);

/// A table for each scene, with its bias check.
void print_scene(std::ostream& out, const SceneResult& result, bool with_rest);
/// What the baseline found, in a line a finding.
void print_baseline(std::ostream& out, const BaselineComparison& comparison);

/// index.html.
std::string bench_page(const nlohmann::json& report);

} // namespace duet::compare
