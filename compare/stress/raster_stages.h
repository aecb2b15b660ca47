// This header declares access to single stages of the rasterizer, for one triangle or one mesh at a time.
#pragma once

#include "compare/stress/exact_coverage.h"
#include "raster/visibility/hit_tile.h"
#include "raster/visibility/rasterize_tile.h"

#include <memory>
#include <vector>

namespace duet::compare {

/// A Window is a small tile of an image with one sample per pixel. Its small size keeps a trial cheap.
struct Window {
    raster::PixelRect rect;
    raster::SampleOffset offset;

    int size() const { return (rect.x1 - rect.x0) * (rect.y1 - rect.y0); }
    /// Calls visit(x, y) for each pixel.
    template <typename Visit> void for_each(const Visit& visit) const {
        for (int y = rect.y0; y < rect.y1; ++y)
            for (int x = rect.x0; x < rect.x1; ++x) visit(x, y);
    }
    /// Returns a pixel's sample position in grid points.
    std::int64_t grid_x(int x) const { return std::int64_t{x} * raster::kSubpixels + offset.x; }
    std::int64_t grid_y(int y) const { return std::int64_t{y} * raster::kSubpixels + offset.y; }
};

/// Determines which samples the rasterizer covers for each of many triangles. It runs the assembly stage, which
/// resolves small triangles, and the tile, which rasterizes the others. All triangles go into one tile, each nearer
/// than the previous ones, so that a sample shows the last triangle that covers it.
class CoverageProbe {
public:
    /// The window has at most TileGrid::kTileSize pixels per side.
    explicit CoverageProbe(const Window& window);

    /// Renders one more triangle of either winding; a triangle without area covers nothing.
    void draw(GridTriangle triangle);
    /// Returns whether the last triangle covers the pixel's sample.
    bool covers(int x, int y) const;

private:
    raster::AssemblyPlan plan_;
    Scene scene_; ///< one mesh of one triangle
    raster::Triangles triangles_;
    raster::Assembler assembler_;
    raster::DepthTile tile_;
    std::uint32_t count_ = 0;
};

/// Holds setup triangles and the unclipped triangles that they were made from, numbered from 0.
struct SetupTriangles : raster::UnclippedTriangles {
    std::vector<raster::UnclippedTriangle> source_triangles;
    std::vector<raster::DrawTriangle> triangles;

    raster::UnclippedTriangle unclipped(std::uint32_t id) const override { return source_triangles[id]; }
    /// Appends the other setup's triangles and numbers them after these.
    void append(const SetupTriangles& other);
};

/// Returns what the rasterizer draws for a mesh in world space with samples at `offset`: transformed, clipped and set
/// up, including back faces.
SetupTriangles set_up_triangles(const Mesh& mesh, const View& view, raster::SampleOffset offset);

/// Renders the listed triangles of a setup into the window, in the given order.
std::unique_ptr<raster::DepthTile> draw(const SetupTriangles& setup, const std::vector<raster::DrawTriangle>& triangles,
                                        const View& view, const Window& window);
inline std::unique_ptr<raster::DepthTile> draw(const SetupTriangles& setup, const View& view, const Window& window) {
    return draw(setup, setup.triangles, view, window);
}

/// Runs the rasterizer's whole pipeline on a mesh and returns the hits in the window, including back faces.
raster::HitTile draw(const Mesh& mesh, const View& view, const Window& window);

} // namespace duet::compare
