// This file writes the statistics of a rendering as JSON, with the same keys for both programs.
#pragma once

#include "common/rendering.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace duet {

/// A RenderContext holds facts about a rendering that the renderer itself does not know.
struct RenderContext {
    std::string program, scene;
    int width = 0, height = 0, threads = 0;
    std::uint64_t seed = 0;
    double load_seconds = 0, prepare_seconds = 0, render_seconds = 0, write_seconds = 0;
};

/// Returns the statistics as JSON with the keys of common/README.md: program, version, scene, width, height, threads,
/// samples_per_pixel, passes, seed, seconds (load, prepare, render, write, total), stages, rays, triangles,
/// memory_bytes, peak_memory_bytes, bvh (nodes, references, or null), estimated_relmse (null where unknown),
/// invalid_samples, first_invalid (x, y, sample, or null), approximations, skipped, interrupted.
nlohmann::json statistics_json(const RenderContext& context, const RenderStatistics& statistics);

/// Throws Error where write_json could not write to `path`, because its folder does not exist. Programs call this
/// before a long run. "" and "-" are always accepted.
void check_json_path(const std::string& path);
/// Writes pretty-printed JSON to standard output for "-", and else to a file. The file is written completely or not
/// at all.
void write_json(const std::filesystem::path& path, const nlohmann::json& json);

} // namespace duet
