// Declares the G-buffer pass, which rasterizes one sample per pixel and stores the visible surfaces' attributes.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/geometry/geometry.h"
#include "raster/geometry/tiles.h"

#include <functional>

namespace duet {
struct Control;
}

namespace duet::raster {

class HitLists; // raster/visibility/hit_lists.h
class HitTile;  // raster/visibility/hit_tile.h

/// Describes one sample per pixel of a view. All functions that fill a G-buffer take it.
struct SampleView {
    const RasterSceneData& data;
    const RasterSettings& settings;
    const Geometry& geometry; ///< geometry of the opaque surfaces
    const Geometry* layers;   ///< geometry of the surfaces with alpha; null if there are none
    const PassView& view;
    const TileGrid& grid;
    SampleOffset offset; ///< position of the samples in their pixels
    const Control& control;
};

/// Receives the surfaces with alpha in a tile: its index, its visible surfaces, and the lists of those in front.
using VisitLayers = std::function<void(std::size_t tile_index, HitTile& tile, HitLists& lists)>;
/// Fills the G-buffer with the opaque surfaces. `emission` receives the radiance that the visible surfaces emit toward
/// the viewer, 0 elsewhere. Every pixel is written, unless the control stops the pass: then the remaining tiles keep
/// their old contents. Once a tile is filled, `visit_layers` may add its surfaces with alpha by store_hit().
void fill_gbuffer(const SampleView& sample, GBuffer& gbuffer, Planes3& emission, const VisitLayers& visit_layers = {});
/// Stores a hit in a pixel.
void store_hit(const SampleView& sample, int x, int y, const Hit& hit, float reversed_depth, GBuffer& gbuffer,
               Planes3& emission);

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

/// Returns the planes that the scene's materials need.
OptionalPlanes optional_planes(const Scene& scene);

} // namespace duet::raster
