// What a rendering took, what it left out and what it only approximated: its statistics.
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

/// The running account of a rendering.
struct Account {
    double transform = 0, setup = 0, bin = 0, prepass = 0, tiles = 0, resolve = 0; ///< seconds of wall-clock time
    std::atomic<std::int64_t> cover_work{0}, shade_work{0};           ///< nanoseconds, summed over threads
    std::atomic<std::size_t> tiles_done{0};                           ///< over all passes
    CullCounts culled;                                                ///< over all passes
    std::size_t geometry_bytes = 0;                                   ///< of the pass that needed most
    std::size_t look_bytes = 0;                                       ///< of the pass that needed most: its look at the whole picture
    std::size_t picture_bytes = 0;

    void add(const Geometry& geometry);
    /// A look at the whole picture, and the memory it has given back to the pool, which that keeps.
    void add(const Screen& screen, GeometryPool& pool);
    /// By stage. Covering and shading take turns in each tile: each gets its share of the loop's time by its work.
    std::vector<std::pair<std::string, double>> seconds() const;
};

/// All statistics but the number of invalid samples, which the picture knows.
void fill_statistics(RenderStatistics& statistics, const PreparedData& data, const Settings& settings,
                     const Account& account, const std::vector<Pass>& passes, const TileGrid& grid);

/// Reports to a Control the steps done, in order, one call at a time.
class Progress {
public:
    Progress(const Control& control, std::size_t steps) : control_(control), steps_(steps) {}
    void step();

private:
    const Control& control_;
    std::size_t done_ = 0, steps_;
    std::mutex mutex_;
};

} // namespace duet::raster
