// One row of `compare frames`: our frames and the peer's, in turns, and whether they show the same.
#pragma once

#include "compare/frames/frame_scene.h"
#include "compare/frames/peer.h"
#include "raster/render.h"

#include <atomic>
#include <optional>

namespace duet::compare {

/// How our picture differs from the peer's.
struct FrameDifference {
    double coverage = 0; ///< the share of pixels that one of the two leaves empty
    double mean = 0;     ///< Phong: mean absolute difference of encoded values, in [0, 1]; depth: mean |ours/theirs − 1|
    double flip = 0;     ///< Phong: mean FLIP; depth: 0
    bool same() const;   ///< whether both can pass for one picture
};

struct FrameRatio {
    double min = 0, median = 0, max = 0; ///< peer's seconds / ours: above 1 we are ahead
};

struct FrameRow {
    FrameWork work = FrameWork::kPhong;
    FrameView view = FrameView::kWhole;
    int threads = 1;
    double covered = 0;             ///< share of the pixels
    double ours = 0;                ///< median seconds a frame
    double peer = 0;                ///< likewise; 0: there is none
    FrameRatio ratio;               ///< of one repeat each
    std::optional<FrameDifference> difference;
    std::string peer_name;
    ImageRgb picture, peer_picture; ///< of Phong, sRGB-encoded values
};

struct FrameSettings {
    int width = 1920, height = 1080;
    int repeats = 9;
    double burst = 0.03;   ///< seconds at least that a repeat's frames of each kind last
    bool processor_time = false; ///< seconds of all processors instead of the clock's
    bool peer = true;      ///< measure it, where it is built
    const std::atomic<bool>* stop = nullptr;
};

/// The rows of one mesh, view and number of threads: Phong and depth. `prepared` is of `scene`. Fewer repeats where
/// `stop` was set.
std::vector<FrameRow> measure_frames(const Scene& scene, const raster::Prepared& prepared, FrameView view, int threads,
                                     const std::vector<FrameWork>& works, const FrameSettings& settings);

} // namespace duet::compare
