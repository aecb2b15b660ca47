// This file measures the rows of `compare frames` for scene files: whole lit frames and their stages, without a peer.
#pragma once

#include "compare/frames/measure_frames.h"

#include <filesystem>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace duet::compare {

/// Holds medians over the repeats, in seconds.
struct LitRow {
    int threads = 1;
    double frame = 0; ///< seconds, by the clock that FrameSettings selects
    /// These are the wall-clock times of the stages, in the order of the frame. "other" is the rest of the frame.
    std::vector<std::pair<std::string, double>> stages;
};
/// Holds the frames of one scene, one row per thread count.
struct LitScene {
    std::string name;
    double prepare = 0; ///< seconds, once per scene, with the last row's threads
    std::vector<LitRow> rows;
    ImageRgb image; ///< sRGB-encoded values
};

/// Renders frames of a scene from its own camera, one sample per pixel, and encodes them to 8-bit sRGB in memory. The
/// first frame of each row is not counted. Makes fewer repeats if `settings.stop` is set. Throws Error as load_scene
/// does.
LitScene measure_lit_frames(const std::filesystem::path& scene, const std::vector<int>& threads,
                            const FrameSettings& settings);

/// Prints a table of frames, and one of the stages of the last row of each scene.
void print_lit_frames(std::ostream& out, const std::vector<LitScene>& scenes, const FrameSettings& settings);
/// Returns a JSON object with `scene`, `prepare_seconds` and `rows`, whose members are `threads`, `frame_seconds` and
/// `stages`, the seconds of each.
nlohmann::json lit_json(const LitScene& scene);

} // namespace duet::compare
