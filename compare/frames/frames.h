// `compare frames`: compares the rasterizer's frame rate with that of Mesa's llvmpipe.
#pragma once

#include "compare/frames/measure_frames.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet::compare {

/// Holds the options of `compare frames`.
struct FramesOptions {
    std::vector<std::filesystem::path> files; ///< meshes, and scene files (.json) for lit frames
    std::filesystem::path texture; ///< base color of all meshes; empty: gray. The peer does not support it
    std::vector<FrameView> views{FrameView::kWhole, FrameView::kClose};
    std::vector<FrameWork> works{FrameWork::kPhong, FrameWork::kDepth};
    std::vector<int> threads; ///< thread counts; empty: 1 and all processors
    FrameSettings settings;
    std::filesystem::path folder; ///< output folder for all images; empty: none
    std::string stats;            ///< file for the rows as JSON; "-" for standard output; empty: none
    bool quiet = false;           ///< no table, no progress bar
};

/// Prints a table of the meshes' rows, and one of the scenes'. Returns 1 if the rasterizer's image and the peer's
/// differ, 130 after an interrupt signal. Throws Error for a file that cannot be used, and if the peer is built and
/// requested (unless settings.no_peer) but cannot run.
int frames(const FramesOptions& options);

} // namespace duet::compare
