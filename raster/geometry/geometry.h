// Implements the geometry stages of the pipeline for one pass: transform → cull → clip → set up → bin.
#pragma once

#include "raster/geometry/assemble.h"
#include "raster/geometry/bin.h"
#include "raster/geometry/sample_positions.h"
#include "raster/geometry/sphere.h"
#include "raster/raster_scene.h"

#include <functional>
#include <vector>

namespace duet::raster {

/// Represents one view of the scene: a point on the lens, a time, and the sample positions in the pixel.
struct PassView {
    Pinhole pinhole;
    float time = 0;
    Viewport viewport;
    const std::vector<SampleOffset>& samples;
    int samples_per_pixel = 1; ///< shaded samples of all passes together, which determine a sample's footprint
};

/// Returns the view through the center of the lens when the shutter opens, with one sample at each pixel's center.
PassView center_view(const View& view);

/// Stores the primitives of a pass, ready to be rasterized tile by tile. They are rebuilt for each pass in the same
/// memory.
struct Geometry {
    Triangles triangles;
    std::vector<Batch> batches; ///< one per run
    TileLists triangle_lists, mask_lists, fragment_lists;
    std::vector<DrawSphere> spheres;
    ItemsByTile<std::uint32_t> sphere_bins; ///< indices of `spheres`
    CullCounts culled;
    double transform_seconds = 0, setup_seconds = 0, bin_seconds = 0;
    ObjectPool<Assembler> assemblers; ///< each thread takes one

    /// Identifies a primitive of the scene.
    struct Primitive {
        std::uint32_t object, primitive; ///< as in a Hit
    };
    /// Returns which primitive an id of a run stands for.
    Primitive primitive(const Run& run, std::uint32_t id) const;
    /// Returns whether any primitive may overlap a tile.
    bool overlaps_tile(std::size_t tile) const {
        return !triangle_lists.tile(tile).empty() || !mask_lists.tile(tile).empty() ||
               !fragment_lists.tile(tile).empty() || !sphere_bins.tile(tile).empty();
    }
    std::size_t memory_bytes() const;
};

/// Returns whether an object, given by its index, is drawn; empty if all are.
using ObjectFilter = std::function<bool(std::uint32_t)>;
/// Processes the objects without alpha mask or alpha blending. The result is the same for any number of threads.
/// Throws Error if there are more triangles in view than ids (2^31).
void process_geometry(const RasterSceneData& data, const TileGrid& grid, const PassView& view,
                      const RasterSettings& settings, Geometry& result, const ObjectFilter& includes = {});
/// Processes only objects with alpha mask or alpha blending (RasterSceneData::alpha_polygonal and alpha_spheres).
void process_layers(const RasterSceneData& data, const TileGrid& grid, const PassView& view,
                    const RasterSettings& settings, Geometry& result, const ObjectFilter& includes = {});

} // namespace duet::raster
