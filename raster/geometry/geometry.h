// Implements the geometry stages of the pipeline for one pass: transform → cull → clip → set up → bin.
#pragma once

#include "raster/geometry/assemble.h"
#include "raster/geometry/bin.h"
#include "raster/geometry/sample_positions.h"
#include "raster/raster_scene.h"

#include <memory>
#include <mutex>

namespace duet::raster {

/// Represents one view of the scene: a point on the lens, a time, and the sample positions in the pixel.
struct PassView {
    Pinhole pinhole;
    float time = 0;
    Viewport viewport;
    const std::vector<SampleOffset>& samples;
    int samples_per_pixel = 1; ///< shaded samples of all passes together, which determine a sample's footprint
};

/// Stores the primitives of a pass, ready to be rasterized tile by tile. They are rebuilt for each pass in the same
/// memory.
struct Geometry {
    Triangles triangles;
    std::vector<Batch> batches; ///< one per run
    TileLists triangle_lists, mask_lists, fragment_lists;
    std::vector<DrawSphere> spheres;
    Bins sphere_bins;
    CullCounts culled;
    double transform_seconds = 0, setup_seconds = 0, bin_seconds = 0;
    std::vector<Assembler> assemblers; ///< assemblers not in use; each thread takes one

    std::size_t memory_bytes() const;
};

/// Processes all objects without alpha mask or alpha blending. The result is the same for any number of threads.
/// Throws Error if there are more triangles in view than ids (2^31).
void process_geometry(const RasterSceneData& data, const TileGrid& grid, const PassView& view,
                      const RasterSettings& settings, Geometry& result);
/// Processes the objects of process_geometry() except those listed, in order.
void process_without(const RasterSceneData& data, const std::vector<std::uint32_t>& excluded, const TileGrid& grid,
                     const PassView& view, const RasterSettings& settings, Geometry& result);
/// Processes those objects of process_geometry() that are listed, in order.
void process_only(const RasterSceneData& data, const std::vector<std::uint32_t>& objects, const TileGrid& grid,
                  const PassView& view, const RasterSettings& settings, Geometry& result);
/// Processes only the objects with alpha mask or alpha blending (RasterSceneData::alpha_polygonal and alpha_spheres).
void process_layers(const RasterSceneData& data, const TileGrid& grid, const PassView& view,
                    const RasterSettings& settings, Geometry& result);

/// Provides a pool of geometries whose memory is reused from frame to frame. There is one for each rendering that
/// runs at the same time.
class GeometryPool {
public:
    std::unique_ptr<Geometry> take();
    void give_back(std::unique_ptr<Geometry> geometry);
    std::size_t memory_bytes(); ///< of the geometries that are not in use

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<Geometry>> free_;
};

/// Holds a geometry taken from a pool and returned to it by the destructor.
class PooledGeometry {
public:
    explicit PooledGeometry(GeometryPool& pool) : pool_(pool), geometry_(pool.take()) {}
    ~PooledGeometry() { pool_.give_back(std::move(geometry_)); }
    PooledGeometry(const PooledGeometry&) = delete;
    PooledGeometry& operator=(const PooledGeometry&) = delete;
    Geometry& operator*() { return *geometry_; }

private:
    GeometryPool& pool_;
    std::unique_ptr<Geometry> geometry_;
};

} // namespace duet::raster
