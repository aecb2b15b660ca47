#include "compare/report/report_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

// JSON has neither infinity nor NaN: they become null.
json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json hit_json(const Scene& scene, std::uint32_t object, std::uint32_t primitive, double t) {
    if (object == kNoObject) return {{"object", nullptr}};
    return {{"object", object}, {"name", scene.objects[object].name}, {"primitive", primitive}, {"t", number(t)}};
}

} // namespace

json metrics_json(const ErrorMetrics& m, const std::string& name_a, const std::string& name_b) {
    json result = {{"mse", number(m.mse)},
                   {"rmse", number(m.rmse)},
                   {"mae", number(m.mae)},
                   {"psnr", number(m.psnr)},
                   {"relmse", number(m.relmse)},
                   {"mean_signed_error",
                    {number(m.mean_signed_error.r), number(m.mean_signed_error.g), number(m.mean_signed_error.b)}},
                   {"worst", number(m.worst)},
                   {"pixels", m.pixels},
                   {"non_finite", {{name_a, m.non_finite_a}, {name_b, m.non_finite_b}}}};
    result["worst_pixel"] = m.pixels > 0 ? json{m.worst_x, m.worst_y} : json(nullptr);
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
             {{"worst", number(agreement.worst_distance)},
              {"bound", kDepthTolerance},
              {"violations", agreement.distance_violations},
              {"pixel", {agreement.worst_x, agreement.worst_y}}}},
            {"unexplained_pixels", listed}};
}

} // namespace duet::compare
