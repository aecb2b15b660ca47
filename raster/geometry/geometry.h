// The front half of the pipeline: transform → cull → clip → set up → bin, for one pass.
#pragma once

#include "raster/geometry/assemble.h"
#include "raster/geometry/bin.h"
#include "raster/geometry/samples.h"
#include "raster/prepare.h"

#include <memory>
#include <mutex>

namespace duet::raster {

class Screen; // raster/screen/screen.h

/// One view of the scene: a point of the lens, a moment, and the samples that see it.
struct PassView {
    Pinhole pinhole;
    float time = 0;
    Viewport viewport;
    const std::vector<SampleOffset>& samples;
    const Screen* screen = nullptr; ///< its depths, where an effect asks for them
};

/// A pass's primitives, ready to be drawn tile by tile. Made anew for each pass in the same memory.
struct Geometry {
    Triangles triangles;
    std::vector<Batch> batches; ///< a run each
    TileLists outlines, patches, fragments;
    std::vector<DrawSphere> spheres;
    Bins sphere_bins;
    CullCounts culled;
    double transform_seconds = 0, setup_seconds = 0, bin_seconds = 0;
    std::vector<Assembler> assemblers; ///< of threads at work, each taken by one at a time

    std::size_t memory_bytes() const;
};

/// The same for any number of threads. Throws Error for more triangles in view than can be numbered (2^31).
void process_geometry(const PreparedData& data, const TileGrid& grid, const PassView& view, const Settings& settings,
                      Geometry& result);
/// The same without PreparedData::glass.
void process_without_glass(const PreparedData& data, const TileGrid& grid, const PassView& view, const Settings& settings,
                           Geometry& result);
/// The same of PreparedData::glass alone, each surface as whole triangles.
void process_glass(const PreparedData& data, const TileGrid& grid, const PassView& view, const Settings& settings,
                   Geometry& result);
/// The same of the back faces of closed objects, far sides of spheres among them, with and without PreparedData::glass.
void process_backs(const PreparedData& data, const TileGrid& grid, const PassView& view, const Settings& settings, bool glass,
                   Geometry& result);
/// The same of the back faces of PreparedData::glass, spheres apart, alone; patches: not as whole triangles.
void process_backs_of_glass(const PreparedData& data, const TileGrid& grid, const PassView& view, const Settings& settings,
                            bool patches, Geometry& result);
/// The same of the surfaces that may be seen through.
void process_layers(const PreparedData& data, const TileGrid& grid, const PassView& view, const Settings& settings,
                    Geometry& result);

/// Memory of geometries, kept from frame to frame: one for each rendering that runs at a time.
class GeometryPool {
public:
    std::unique_ptr<Geometry> take();
    void give_back(std::unique_ptr<Geometry> geometry);
    std::size_t memory_bytes(); ///< of those that nobody has

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<Geometry>> free_;
};

/// A geometry of the pool, given back at the end.
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
