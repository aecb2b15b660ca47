#include "common/program/statistics.h"

#include "common/system/file.h"
#include "common/system/memory.h"

#include <nlohmann/json.hpp>

#include <iostream>

namespace duet {

nlohmann::json statistics_json(const RenderContext& context, const RenderStatistics& statistics) {
    nlohmann::json skipped = nlohmann::json::object();
    for (const SkippedWork& s : statistics.skipped) {
        if (s.count >= 0)
            skipped[s.what] = s.count;
        else
            skipped[s.what] = s.why;
    }
    nlohmann::json stages = nlohmann::json::object();
    for (const auto& [stage, seconds] : statistics.seconds) stages[stage] = seconds;
    const double total =
        context.load_seconds + context.prepare_seconds + context.render_seconds + context.write_seconds;
    nlohmann::json relmse; // null where unknown
    if (statistics.estimated_relmse >= 0) relmse = statistics.estimated_relmse;
    nlohmann::json first_invalid; // null where there is none
    if (const auto& first = statistics.first_invalid)
        first_invalid = {{"x", first->x}, {"y", first->y}, {"sample", first->sample}};
    nlohmann::json bvh; // null where there is none
    if (const BvhStatistics& h = statistics.bvh; h.nodes > 0 || h.references > 0)
        bvh = {{"nodes", h.nodes}, {"references", h.references}};
    return {
        {"program", context.program},
        {"version", DUET_VERSION},
        {"scene", context.scene},
        {"width", context.width},
        {"height", context.height},
        {"threads", context.threads},
        {"samples_per_pixel", statistics.samples_per_pixel},
        {"passes", statistics.passes},
        {"seed", context.seed},
        {"seconds",
         {{"load", context.load_seconds},
          {"prepare", context.prepare_seconds},
          {"render", context.render_seconds},
          {"write", context.write_seconds},
          {"total", total}}},
        {"stages", stages},
        {"rays",
         {{"camera", statistics.camera_rays},
          {"indirect", statistics.indirect_rays},
          {"shadow", statistics.shadow_rays}}},
        {"triangles", statistics.triangles},
        {"memory_bytes", statistics.memory_bytes},
        {"peak_memory_bytes", peak_memory_bytes()},
        {"bvh", bvh},
        {"estimated_relmse", relmse},
        {"invalid_samples", statistics.invalid_samples},
        {"first_invalid", first_invalid},
        {"approximations", statistics.approximations},
        {"skipped", skipped},
        {"interrupted", statistics.interrupted},
    };
}

void check_json_path(const std::string& path) {
    if (path.empty() || path == "-") return;
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    if (!std::filesystem::is_directory(folder)) throw Error(message("--stats: no folder ", folder.string()));
}

void write_json(const std::filesystem::path& path, const nlohmann::json& json) {
    // The error handler replaces invalid bytes, because names may not be UTF-8.
    const std::string text = json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    if (path == "-")
        std::cout << text;
    else
        write_file(path, text);
}

} // namespace duet
