// This file writes the results of a comparison as JSON, for report.json and the tables of the page.
#pragma once

#include "common/scene/scene.h"
#include "compare/hits/hit_agreement.h"
#include "compare/metrics/image_metrics.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace duet::compare {

/// Returns the number, or null for infinity and NaN, which JSON does not have.
nlohmann::json number_json(double value);
/// Returns the three channels as an array of numbers, each as number_json does.
nlohmann::json channels_json(Rgbd color);

/// Returns the metrics by name; a value that is infinite or NaN becomes null. Keys: mse, rmse, mae, psnr (null
/// for equal images), relmse, relmse_trimmed, smape, mean_signed_error [r, g, b], worst, worst_pixel [x, y],
/// ssim; flip (the mean), flip_… (weighted_median, first_quartile, third_quartile, min, max; for linear images
/// also start_exposure, stop_exposure, exposures); pixels; nan, infinite and non_finite (either), each with the
/// two names as keys; z_test if one was made.
nlohmann::json metrics_json(const ImageMetrics& metrics, const std::string& name_a, const std::string& name_b);

/// Returns the hit agreement. Keys: pixels, same, edge, depth_tie, unexplained; distance (worst, bound,
/// violations, pixel); unexplained_pixels, for up to 100 of them the pixel and the hits raster, raytrace and
/// exact (object, name, primitive, t; object is null for a miss).
nlohmann::json hits_json(const HitAgreement& agreement, const Scene& scene);

} // namespace duet::compare
