// The figures of a comparison as JSON: what report.json and the page's tables hold.
#pragma once

#include "common/scene/scene.h"
#include "compare/hits/hit_agreement.h"
#include "compare/metrics/image_metrics.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace duet::compare {

/// The metrics by name, null where one is infinite or no number: mse, rmse, mae, psnr (null: equal pictures), relmse,
/// relmse_trimmed, smape, mean_signed_error [r, g, b], worst, worst_pixel [x, y], ssim; flip (the mean), flip_…
/// (weighted_median, first_quartile, third_quartile, min, max; of linear pictures start_exposure, stop_exposure,
/// exposures); pixels; nan, infinite and non_finite (either), whose keys are the two names; z_test where one was made.
nlohmann::json metrics_json(const ImageMetrics& metrics, const std::string& name_a, const std::string& name_b);

/// pixels, same, edge, depth_tie, unexplained; distance (worst, bound, violations, pixel); unexplained_pixels: for up
/// to 100 of them pixel and the hits raster, raytrace and exact (object, name, primitive, t; object null: nothing).
nlohmann::json hits_json(const HitAgreement& agreement, const Scene& scene);

} // namespace duet::compare
