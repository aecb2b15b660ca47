// What `compare ladder` tells: as JSON, as a table, as a page.
#pragma once

#include "common/scene/scene.h"
#include "compare/ladder/measure.h"
#include "compare/ladder/shares.h"
#include "compare/metrics/image_metrics.h"

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace duet::compare {

/// All that was found out about one scene.
struct LadderResult {
    const Scene& scene;
    View view;
    PipelineSettings settings;
    std::array<RungPlan, kRungCount> plan;
    std::array<MeasuredRung, kRungCount> rungs;
    LadderPictures pictures;
    Shares shares;
    CauseMap map;
    ImageMetrics metrics; ///< of the rasterizer's picture from the path tracer's
    double seconds = 0;   ///< of everything, from the loaded scene on
};

/// report.json: scene, version, width, height, threads, seed, max_depth, samples_per_pixel (raster, raytrace), seconds,
/// metrics; `shares`: eight of {cause, title, share, largest_in: part of the visible pixels}; shares_sum,
/// difference_rms, nothing_to_explain, visible_pixels (part of all); `rungs`: seven of {rung, id, title, note, ways,
/// quantities: [{name, seconds, samples_per_pixel, metrics (rmse, mae, relmse, mean_signed_error) or hits}], code:
/// {raster, raytrace, both: {lines, files}}}; frame: the code that is no rung's; invalid_samples.
nlohmann::json ladder_json(const LadderResult& result);

/// The table for the terminal.
void print_ladder(std::ostream& out, const LadderResult& result);

/// The page, one self-contained file. Pictures wider than 640 pixels are shown smaller there.
std::string ladder_page(const LadderResult& result, const nlohmann::json& report);

} // namespace duet::compare
