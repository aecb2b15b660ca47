#include "compare/report/report_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

json hit_json(const Scene& scene, std::uint32_t object, std::uint32_t primitive, double t) {
    if (object == kNoObject) return {{"object", nullptr}};
    return {{"object", object}, {"name", scene.objects[object].name}, {"primitive", primitive}, {"t", number_json(t)}};
}

void add_flip(json& result, const HdrFlip& flip) {
    result["flip"] = number_json(flip.mean);
    result["flip_weighted_median"] = number_json(flip.weighted_median);
    result["flip_first_quartile"] = number_json(flip.first_quartile);
    result["flip_third_quartile"] = number_json(flip.third_quartile);
    result["flip_min"] = number_json(flip.min);
    result["flip_max"] = number_json(flip.max);
    if (flip.exposures == 0) return;
    result["flip_start_exposure"] = number_json(flip.start_exposure);
    result["flip_stop_exposure"] = number_json(flip.stop_exposure);
    result["flip_exposures"] = flip.exposures;
}

json z_test_json(const ZTest& z) {
    return {
        {"pixels", z.pixels},
        {"over_2", number_json(z.over_2)},
        {"over_3", number_json(z.over_3)},
        {"mean_square", number_json(z.mean_square)},
        {"largest", number_json(z.largest)},
        {"largest_pixel", {z.largest_x, z.largest_y}},
        {"mean_z", channels_json(z.mean_z)},
        {"detectable", channels_json(z.detectable)},
        {"tests", z.tests},
        {"p", number_json(z.p)},
        {"most_unlikely", {{"x", z.x}, {"y", z.y}, {"width", z.width}, {"height", z.height}, {"channel", z.channel}}}};
}

} // namespace

json number_json(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json channels_json(Rgbd c) { return {number_json(c.r), number_json(c.g), number_json(c.b)}; }

json metrics_json(const ImageMetrics& metrics, const std::string& name_a, const std::string& name_b) {
    const ErrorMetrics& m = metrics.errors;
    json result = {{"mse", number_json(m.mse)},
                   {"rmse", number_json(m.rmse)},
                   {"mae", number_json(m.mae)},
                   {"psnr", number_json(m.psnr)},
                   {"relmse", number_json(m.relmse)},
                   {"relmse_trimmed", number_json(m.relmse_trimmed)},
                   {"smape", number_json(m.smape)},
                   {"mean_signed_error", channels_json(m.mean_signed_error)},
                   {"worst", number_json(m.worst)},
                   {"ssim", number_json(metrics.ssim)},
                   {"pixels", m.pixels},
                   {"nan", {{name_a, m.nan_a}, {name_b, m.nan_b}}},
                   {"infinite", {{name_a, m.infinite_a}, {name_b, m.infinite_b}}},
                   {"non_finite", {{name_a, m.non_finite_a}, {name_b, m.non_finite_b}}}};
    result["worst_pixel"] = m.pixels > 0 ? json{m.worst_x, m.worst_y} : json(nullptr);
    add_flip(result, metrics.flip);
    if (metrics.z) result["z_test"] = z_test_json(*metrics.z);
    return result;
}

json hits_json(const HitAgreement& agreement, const Scene& scene) {
    json listed = json::array();
    for (const UnexplainedPixel& p : agreement.listed)
        listed.push_back({{"pixel", {p.x, p.y}},
                          {"raster", hit_json(scene, p.raster.object, p.raster.primitive, p.raster.t)},
                          {"raytrace", hit_json(scene, p.raytrace.object, p.raytrace.primitive, p.raytrace.t)},
                          {"exact", hit_json(scene, p.exact.object, p.exact.primitive, p.exact.t)}});
    return {{"pixels", agreement.pixels},
            {"same", agreement.same},
            {"edge", agreement.edge},
            {"depth_tie", agreement.depth_tie},
            {"unexplained", agreement.unexplained},
            {"distance",
             {{"worst", number_json(agreement.worst_distance)},
              {"bound", kDepthTolerance},
              {"violations", agreement.distance_violations},
              {"pixel", {agreement.worst_x, agreement.worst_y}}}},
            {"unexplained_pixels", listed}};
}

} // namespace duet::compare
