// `compare frames`: the rasterizer's frames a second, beside Mesa's llvmpipe.
#pragma once

#include "compare/frames/measure_frames.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

struct FramesOptions {
    std::vector<std::filesystem::path> meshes;
    std::filesystem::path texture; ///< base colour of all meshes; empty: grey. The peer knows none
    std::vector<FrameView> views{FrameView::kWhole, FrameView::kClose};
    std::vector<FrameWork> works{FrameWork::kPhong, FrameWork::kDepth};
    std::vector<int> threads; ///< empty: 1, and all processors
    FrameSettings settings;
    std::filesystem::path folder; ///< for the pictures of both; empty: none
    std::string stats;            ///< a file for the rows as JSON, "-" for standard output, empty: none
    bool quiet = false;           ///< no table, no progress bar
};

/// Prints a table of rows. Returns 1 where our picture and the peer's differ, 130 where a signal came. Throws Error for
/// a mesh that cannot be used, and where a peer is asked for (settings.peer) and built but cannot run.
int frames(const FramesOptions& options);

} // namespace duet::compare
