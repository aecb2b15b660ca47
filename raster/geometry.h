// The front half of the pipeline: transform → cull → clip → set up → bin, for one pass.
#pragma once

#include "raster/bin.h"
#include "raster/prepare.h"
#include "raster/samples.h"

namespace duet::raster {

/// One view of the scene: a point of the lens, a moment, and the samples that see it.
struct PassView {
    Pinhole pinhole;
    float time = 0;
    Viewport viewport;
    const std::vector<SampleOffset>& samples;
};

/// A pass's primitives, ready to be drawn tile by tile.
struct Geometry {
    DrawList list;
    std::vector<DrawSphere> spheres;
    Bins triangle_bins, sphere_bins;
    double transform_seconds = 0, setup_seconds = 0, bin_seconds = 0;
    std::size_t memory_bytes = 0;
};

/// The same for any number of threads.
Geometry process_geometry(const PreparedData& data, const TileGrid& grid, const PassView& view,
                          const Settings& settings);

} // namespace duet::raster
