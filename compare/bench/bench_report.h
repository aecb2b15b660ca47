// This file declares the output of the bench's results as JSON, CSV, text and a page.
#pragma once

#include "common/image/plot.h"
#include "compare/bench/baseline.h"
#include "compare/bench/bench_options.h"
#include "compare/bench/scene_result.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace duet::compare {

/// Returns report.json. For each scene, `scenes` has its reference, its bias check and `rows`; a row is a technique, a
/// sampler and a sample count. An estimate is {value, low, high, relative_error, dof}, where low and high are the ends
/// of its 95 % confidence band. Infinite or unknown values are null. `baseline` is present if one was given.
nlohmann::json bench_json(const BenchOptions& options, const std::vector<SceneResult>& results,
                          const std::optional<BaselineComparison>& baseline);

/// Returns bench.csv, made from bench_json's report: a header, then one line per row of all scenes.
std::string bench_csv(const nlohmann::json& report);

/// Prints a scene's table and its bias check. With `with_rest`, the table also has the errors without the excluded
/// rectangles.
void print_scene(std::ostream& out, const SceneResult& result, bool with_rest);
/// Prints the findings of the baseline comparison, one per line.
void print_baseline(std::ostream& out, const BaselineComparison& comparison);

/// Returns a plot of the relMSE over the time of each technique and sampler (the first Plot::kMaxSeries of them).
/// Without any positive error it has no series.
Plot bench_plot(const SceneResult& result);

/// Returns index.html.
std::string bench_page(const nlohmann::json& report);

} // namespace duet::compare
