// This file measures one row of `compare frames`: it times frames of Duet and of the peer in turns, and checks that
// they show the same.
#pragma once

#include "compare/frames/frame_scene.h"
#include "compare/frames/llvmpipe.h"
#include "compare/timing.h"
#include "raster/render.h"

#include <atomic>
#include <optional>

namespace duet::compare {

/// Holds the difference between the rasterizer's image and the peer's.
struct FrameDifference {
    double coverage = 0; ///< fraction of the pixels that exactly one of the two images leaves empty
    double mean = 0;     ///< Phong: mean |difference| of encoded values, in [0, 1]; depth: mean |ours/theirs − 1|
    double flip = 0;     ///< Phong: mean FLIP; depth: 0
    bool same() const;   ///< whether both images count as the same
};

/// Holds one row of the table: one kind of work in one view, with a number of threads.
struct FrameRow {
    FrameWork work = FrameWork::kPhong;
    FrameView view = FrameView::kWhole;
    int threads = 1;
    double covered = 0;             ///< fraction of the pixels that the mesh covers
    double ours = 0;                ///< median seconds per frame
    double peer = 0;                ///< median seconds per frame; 0: no peer
    MedianRange ratio;              ///< peer's seconds / ours over the repeats: above 1, Duet is faster
    std::optional<FrameDifference> difference;
    std::string peer_name;
    ImageRgb image, peer_image; ///< Phong only, sRGB-encoded values
};

/// Says how frames are measured.
struct FrameSettings {
    ImageSize size{1920, 1080};
    int repeats = 9;
    double burst_seconds = 0.03; ///< minimum duration in seconds of each renderer's frames in a repeat
    bool processor_time = false; ///< measure CPU time over all processors instead of wall-clock time
    bool no_peer = false;        ///< measure Duet alone
    const std::atomic<bool>* stop = nullptr;
};

/// Measures the rows of one mesh, view and thread count, one for each element of `works`. `prepared` must be prepared
/// from `scene`. Makes fewer repeats if `stop` is set.
std::vector<FrameRow> measure_frames(const Scene& scene, const raster::RasterScene& prepared, FrameView view,
                                     int threads, const std::vector<FrameWork>& works, const FrameSettings& settings);

} // namespace duet::compare
