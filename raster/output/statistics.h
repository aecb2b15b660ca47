// Collects the statistics of a rendering: times, memory, culled primitives and approximations.
#pragma once

#include "raster/geometry/geometry.h"

#include <atomic>
#include <mutex>
#include <string>
#include <vector>

namespace duet {
struct Control;
}

namespace duet::raster {

struct DeferredFrame; // raster/shading/deferred.h

/// Accumulates the statistics during a rendering. Several threads may add to the atomic members.
struct StatisticsCollector {
    std::vector<std::pair<std::string, double>> stages; ///< wall-clock seconds of deferred shading, in order
    double transform = 0, setup = 0, bin = 0, tiles = 0, resolve = 0; ///< seconds of wall-clock time
    std::atomic<std::int64_t> coverage_work{0}, shade_work{0}; ///< nanoseconds, summed over threads
    std::atomic<std::size_t> tiles_done{0};                           ///< number of tiles of all passes
    CullCounts culled;                                                ///< sums over all passes
    std::size_t geometry_bytes = 0;                                   ///< maximum over the passes
    std::size_t gbuffer_bytes = 0;                                    ///< size of deferred shading's images
    std::size_t framebuffer_bytes = 0;

    /// Adds the times, the culled primitives and the memory of a pass.
    void add(const Geometry& geometry);
    /// Adds to the seconds of a stage of deferred shading.
    void add_stage(std::string_view stage, double seconds);
    /// Adds a G-buffer and the memory that its pass returned to the pool.
    void add(const DeferredFrame& frame);
    /// Returns the wall-clock seconds by stage. Coverage and shading alternate in each tile, so the time of the
    /// tile loop is divided between them in proportion to their work.
    std::vector<std::pair<std::string, double>> seconds() const;
};

/// Implements approximations() of raster/render.h.
std::vector<std::string> approximations(const RasterSceneData& data, const RasterSettings& settings);
/// Fills in all statistics but the number of invalid samples, which the Framebuffer counts.
void fill_statistics(RenderStatistics& statistics, const RasterSceneData& data, const RasterSettings& settings,
                     const StatisticsCollector& collector, const std::vector<Pass>& passes, const TileGrid& grid);

/// Reports completed steps to a Control in order, one call at a time.
class Progress {
public:
    Progress(const Control& control, std::size_t steps) : control_(control), steps_(steps) {}
    /// Counts a step. Any thread may call it.
    void step();

private:
    const Control& control_;
    std::size_t done_ = 0, steps_;
    std::mutex mutex_;
};

} // namespace duet::raster
