// This file uses Blender as a renderer of the bench: Cycles, its path tracer, or EEVEE, its rasterizer, renders the
// same scene in a subprocess.
#pragma once

#include "compare/bench/bench_renderer.h"
#include "compare/peers/export_scene.h"

#include <memory>

namespace duet::compare {

enum class BlenderEngine { kCycles, kEevee };

/// Throws Error unless the required programs are in PATH. These are blender and, for EEVEE, xvfb-run: EEVEE draws by
/// OpenGL and so needs a display, a virtual one.
void check_blender(BlenderEngine engine);

/// A BlenderPeer is one Blender process with one scene. Its renders run one at a time, and never at the same time as
/// Duet's.
class BlenderPeer {
public:
    /// Exports the scene to a temporary folder and starts Blender with it (see check_blender). EEVEE draws with Mesa's
    /// llvmpipe, on the CPU. Throws Error if the scene cannot be exported (see export_scene), which for EEVEE includes
    /// scenes with media.
    BlenderPeer(BlenderEngine engine, const Scene& scene, const View& view, const ExportSettings& settings);
    ~BlenderPeer();
    BlenderPeer(const BlenderPeer&) = delete;
    BlenderPeer& operator=(const BlenderPeer&) = delete;

    struct Job {
        int spp = 1;
        std::uint64_t seed = 0; ///< unused by EEVEE
        bool adaptive = false; ///< Cycles' own adaptive sampling, at its default threshold; spp is then the maximum
    };
    /// Renders one image. The returned `seconds` is what Cycles logs as "render time (without synchronization)", or how
    /// long EEVEE's render command takes, which may transfer the scene. It excludes start-up, scene loading, the BVH
    /// build, light probes, the compilation of shaders, and file output. Throws Error (exit code 1) with Blender's last
    /// lines if Blender fails. Returns an empty image if `control` was stopped; the process cannot be used afterwards.
    TimedImage render(const Job& job, Control& control);

    /// Renders an image without a small bias of Cycles. Cycles takes the first sample of each pixel through the
    /// pixel center. Edges are therefore wrong by a fraction 1/spp: 2.5 % of a thin bright light at 16 samples,
    /// 0.3 % at 128. This function renders that first sample separately, subtracts it, and returns the mean of
    /// the other samples. Requires spp ≥ 2. Returns an empty image if `control` was stopped.
    ImageRgb unbiased_image(int spp, std::uint64_t seed, Control& control);

    BlenderEngine engine() const { return engine_; }
    const ExportNotes& notes() const;

    /// Returns Blender's name and version, such as "Blender 3.4.1", once it has built the scene. Returns an
    /// empty string if `control` was stopped.
    std::string program(const Control& control);

private:
    class Process;
    BlenderEngine engine_;
    std::unique_ptr<Process> process_;
    bool wait_until_ready(const Control& control);
    bool ready_ = false; ///< whether Blender has built the scene
};

/// This is the version of the export and of the settings that determine what Cycles converges to, like
/// raytrace::kEstimatorVersion for Duet. The cache key of reference images contains it.
inline constexpr int kCyclesExportVersion = 5;

/// Returns the renderers of the peer, which they share: Cycles with and without adaptive sampling, or EEVEE.
std::vector<BenchRenderer> blender_renderers(const std::shared_ptr<BlenderPeer>& peer, const std::vector<int>& spps);

} // namespace duet::compare
