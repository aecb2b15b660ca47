// The statistics of a rendering as JSON: the same keys for both programs.
#pragma once

#include "common/film/rendering.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace duet {

/// A rendering's circumstances that the renderer itself does not know.
struct RenderContext {
    std::string program, scene;
    int width = 0, height = 0, threads = 0;
    std::uint64_t seed = 0;
    double load_seconds = 0, prepare_seconds = 0, render_seconds = 0, write_seconds = 0;
};

/// Keys as in the README: program, version, scene, width, height, threads, samples_per_pixel, passes, seed, seconds
/// (load, prepare, render, write, total), stages, rays, triangles, memory_bytes, estimated_relmse (null where unknown),
/// invalid_samples, first_invalid (x, y, sample, or null), approximations, skipped, interrupted.
nlohmann::json statistics_json(const RenderContext& context, const RenderStatistics& statistics);

/// Throws Error where write_json could not write, for want of a folder: called before a long run. "" and "-" can be.
void check_json_path(const std::string& path);
/// Pretty-printed to a file, whole or absent, or to standard output for "-".
void write_json(const std::filesystem::path& path, const nlohmann::json& json);

} // namespace duet
