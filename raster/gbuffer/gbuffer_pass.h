// Declares the G-buffer pass, which rasterizes one sample per pixel and stores the visible surfaces' attributes.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/geometry/geometry.h"
#include "raster/geometry/tiles.h"

namespace duet {
struct Control;
}

namespace duet::raster {

/// Fills the G-buffer of a view whose samples lie at `offset` in their pixels. `emission` receives the radiance that
/// the visible surfaces emit toward the viewer, 0 elsewhere. Every pixel is written, unless `control` stops the pass:
/// then the remaining tiles keep their old contents.
void fill_gbuffer(const RasterSceneData& data, const RasterSettings& settings, const Geometry& geometry,
                  const PassView& view, const TileGrid& grid, SampleOffset offset, const Control& control,
                  GBuffer& gbuffer, Planes3& emission);

/// Describes a visible surface, evaluated by the functions that both pipelines share.
struct VisibleSurface {
    const SurfacePoint& point;
    const Bsdf& bsdf;
    Vec3 to_viewer;       ///< unit, in world space
    float reversed_depth; ///< near / depth, in (0, 1]
};
/// Stores one surface in a pixel.
void store_surface(const Scene& scene, const VisibleSurface& surface, bool emits, int x, int y, GBuffer& gbuffer,
                   Planes3& emission);
/// Marks all pixels as background.
void clear(GBuffer& gbuffer, Planes3& emission);

/// Returns whether any material has a clear coat, which requires additional planes in the G-buffer.
bool any_clear_coat(const Scene& scene);

} // namespace duet::raster
