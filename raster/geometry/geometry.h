// Implements the geometry stages of the pipeline for one pass: transform → cull → clip → set up → bin.
#pragma once

#include "raster/geometry/assemble.h"
#include "raster/geometry/bin.h"
#include "raster/geometry/samples.h"
#include "raster/prepare.h"

#include <memory>
#include <mutex>

namespace duet::raster {

class Screen; // raster/screen/screen.h

/// Represents one view of the scene: a point on the lens, a time, and the sample positions in the pixel.
struct PassView {
    Pinhole pinhole;
    float time = 0;
    Viewport viewport;
    const std::vector<SampleOffset>& samples;
    const Screen* screen = nullptr; ///< the depths that a screen-space effect reads; null if there is none
};

/// Stores the primitives of a pass, ready to be rasterized tile by tile. They are rebuilt for each pass in the same
/// memory.
struct Geometry {
    Triangles triangles;
    std::vector<Batch> batches; ///< one per run
    TileLists outlines, patches, fragments;
    std::vector<DrawSphere> spheres;
    Bins sphere_bins;
    CullCounts culled;
    double transform_seconds = 0, setup_seconds = 0, bin_seconds = 0;
    std::vector<Assembler> assemblers; ///< assemblers not in use; each thread takes one

    std::size_t memory_bytes() const;
};

/// Processes all objects without alpha mask or alpha blending. The result is the same for any number of threads.
/// Throws Error if there are more triangles in view than ids (2^31).
void process_geometry(const PreparedData& data, const TileGrid& grid, const PassView& view, const Settings& settings,
                      Geometry& result);
/// Processes the objects of process_geometry() except those listed, in order.
void process_without(const PreparedData& data, const std::vector<std::uint32_t>& excluded, const TileGrid& grid,
                     const PassView& view, const Settings& settings, Geometry& result);
/// Processes those objects of process_geometry() that are listed, in order.
void process_only(const PreparedData& data, const std::vector<std::uint32_t>& objects, const TileGrid& grid,
                  const PassView& view, const Settings& settings, Geometry& result);
/// Processes the objects of process_geometry() except PreparedData::glass.
void process_without_glass(const PreparedData& data, const TileGrid& grid, const PassView& view,
                           const Settings& settings, Geometry& result);
/// Processes only PreparedData::glass, without coverage masks (Patch).
void process_glass(const PreparedData& data, const TileGrid& grid, const PassView& view, const Settings& settings,
                   Geometry& result);
/// Processes only the back faces of closed objects, which include the far sides of spheres. PreparedData::glass is
/// included if `glass` is true.
void process_backs(const PreparedData& data, const TileGrid& grid, const PassView& view, const Settings& settings,
                   bool glass, Geometry& result);
/// Processes only the back faces of the meshes and quads of PreparedData::glass. `patches` allows coverage masks
/// (Patch).
void process_backs_of_glass(const PreparedData& data, const TileGrid& grid, const PassView& view,
                            const Settings& settings, bool patches, Geometry& result);
/// Processes only the objects with alpha mask or alpha blending (PreparedData::open_polygonal and open_spheres).
void process_layers(const PreparedData& data, const TileGrid& grid, const PassView& view, const Settings& settings,
                    Geometry& result);

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
class GeometryLoan {
public:
    explicit GeometryLoan(GeometryPool& pool) : pool_(pool), geometry_(pool.take()) {}
    ~GeometryLoan() { pool_.give_back(std::move(geometry_)); }
    GeometryLoan(const GeometryLoan&) = delete;
    GeometryLoan& operator=(const GeometryLoan&) = delete;
    Geometry& operator*() { return *geometry_; }

private:
    GeometryPool& pool_;
    std::unique_ptr<Geometry> geometry_;
};

} // namespace duet::raster
