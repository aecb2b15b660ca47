// This file writes the results of `compare ladder` as JSON, as a table and as a page.
#pragma once

#include "common/scene/scene.h"
#include "compare/ladder/measure_rungs.h"
#include "compare/ladder/shares.h"
#include "compare/metrics/image_metrics.h"

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace duet::compare {

/// Holds all results for one scene.
struct LadderResult {
    const Scene& scene;
    View view;
    ComparisonSettings settings;
    std::array<RungPlan, kRungCount> plan;
    std::array<MeasuredRung, kRungCount> rungs;
    LadderImages images;
    Shares shares;
    CauseMap map;
    ImageMetrics metrics; ///< of the rasterizer's image against the path tracer's
    double seconds = 0;   ///< total time, without loading the scene
};

/// Returns report.json: scene, version, width, height, threads, seed, max_depth, samples_per_pixel (raster,
/// raytrace), seconds, metrics; `shares`: eight of {cause, title, share, largest_in: fraction of the visible
/// pixels}; shares_sum, difference_rms, nothing_to_explain, visible_pixels (fraction of all); `rungs`: seven of
/// {rung, id, title, note, ways, quantities: [{name, seconds, samples_per_pixel, metrics (rmse, mae, relmse,
/// mean_signed_error) or hits}], code: {raster, raytrace, both: {lines, files}}}; frame: the code that belongs
/// to no rung; invalid_samples.
nlohmann::json ladder_json(const LadderResult& result);

/// Prints the table for the terminal.
void print_ladder(std::ostream& out, const LadderResult& result);

/// Returns the page as one self-contained file. It shows images wider than 640 pixels at reduced size.
std::string ladder_page(const LadderResult& result, const nlohmann::json& report);

} // namespace duet::compare
