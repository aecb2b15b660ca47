// The figures of a comparison as JSON: what report.json and the page's tables hold.
#pragma once

#include "common/scene/scene.h"
#include "compare/hits/hit_agreement.h"
#include "compare/metrics/error_metrics.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace duet::compare {

/// mse, rmse, mae, psnr (null: infinite, the pictures are equal), relmse, mean_signed_error [r, g, b] (null: no pixel
/// is finite in both pictures), worst, worst_pixel [x, y], pixels, and non_finite, whose keys are the two names.
nlohmann::json metrics_json(const ErrorMetrics& metrics, const std::string& name_a, const std::string& name_b);

/// pixels, same, edge, depth_tie, unexplained; distance (worst, bound, violations, pixel); unexplained_pixels: for up
/// to 100 of them pixel and the hits raster, raytrace and exact (object, name, primitive, t; object null: nothing).
nlohmann::json hits_json(const HitAgreement& agreement, const Scene& scene);

} // namespace duet::compare
