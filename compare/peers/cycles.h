// Blender's Cycles as a contender: the same scene, rendered by a Blender that runs beside us.
#pragma once

#include "compare/bench/contender.h"
#include "compare/peers/export_scene.h"

#include <memory>

namespace duet::compare {

/// One Blender process with one scene. Its renders do not overlap with each other's or with ours.
class CyclesPeer {
public:
    /// Exports the scene into a temporary folder and starts Blender, found in PATH, with it. Throws Error where Blender
    /// is not installed or the scene cannot be exported (export_scene says when).
    CyclesPeer(const Scene& scene, const View& view, const ExportSettings& settings);
    ~CyclesPeer();
    CyclesPeer(const CyclesPeer&) = delete;
    CyclesPeer& operator=(const CyclesPeer&) = delete;

    struct Job {
        int spp = 1;
        std::uint64_t seed = 0;
        bool adaptive = false; ///< Cycles' own adaptive sampling, at its default threshold; spp is then the limit
    };
    /// `seconds` is what Cycles logs as «render time (without synchronization)»: no start-up, no scene, no hierarchy,
    /// no file. Throws Error (exit code 1), with Blender's last lines, where it fails. Returns an empty picture where
    /// `control` was stopped; the process is of no use afterwards.
    Trial render(const Job& job, Control& control);

    /// A picture without Cycles' own small bias: it takes each pixel's first sample through the pixel's centre, so that
    /// edges are wrong by a share 1/spp (2.5 % of a thin bright lamp at 16 samples, 0.3 % at 128). With that sample,
    /// rendered by itself, taken away, the mean of the others is left. spp ≥ 2. Empty where `control` was stopped.
    ImageRgb unbiased_picture(int spp, std::uint64_t seed, Control& control);

    const ExportNotes& notes() const;

    /// "Blender 3.4.1": waits until it has built the scene. Empty where `control` was stopped.
    std::string program(const Control& control);

private:
    class Process;
    std::unique_ptr<Process> process_;
    bool wait_until_ready(const Control& control);
    bool ready_ = false; ///< Blender has built the scene
};

/// The version of what the export and the settings make Cycles converge to, as raytrace::kEstimatorVersion is ours.
inline constexpr int kCyclesExportVersion = 3;

/// Cycles with adaptive sampling and without; they share the peer.
std::vector<Contender> cycles_contenders(const std::shared_ptr<CyclesPeer>& peer, const std::vector<int>& spps);

} // namespace duet::compare
