// This header declares the state that all passes of a rendering share.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/output/statistics.h"
#include "raster/raster_scene.h"
#include "raster/shader/shader_program.h"

namespace duet::raster {

/// Holds the state that all passes of a rendering share.
struct FrameContext {
    const RasterSceneData& data;
    const RasterSettings& settings;
    const ShaderProgram* program; ///< null for Shading::kLit
    TileGrid grid;
    Geometry& geometry;
    Geometry* layers; ///< alpha-masked and alpha-blended surfaces; null if there are none
    StatisticsCollector& collector;
    Progress& progress;
    Control& control;

    /// Returns whether alpha-masked or alpha-blended surfaces overlap the tile.
    bool has_layers_in(std::size_t tile) const { return layers != nullptr && layers->overlaps_tile(tile); }
    /// Returns whether each primitive is shaded once per pixel. Transparent layers are sorted per sample, so with them
    /// each sample is shaded.
    bool is_multisampled() const {
        return settings.multisamples > 0 && !settings.shades_each_sample() && layers == nullptr;
    }
};

} // namespace duet::raster
