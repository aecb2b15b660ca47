// The rasterizer's own stages, called one triangle or one mesh at a time, for the tests to judge.
#pragma once

#include "compare/stress/exact_coverage.h"
#include "raster/cover.h"

namespace duet::compare {

/// Some pixels of a picture, one sample each: a tile as the rasterizer draws it, small so that a trial is cheap.
struct Window {
    raster::PixelRect rect;
    raster::SampleOffset offset;

    int size() const { return (rect.x1 - rect.x0) * (rect.y1 - rect.y0); }
    /// Calls visit(x, y) for each pixel.
    template <typename Visit> void for_each(const Visit& visit) const {
        for (int y = rect.y0; y < rect.y1; ++y)
            for (int x = rect.x0; x < rect.x1; ++x) visit(x, y);
    }
    /// A pixel's sample in grid points.
    std::int64_t grid_x(int x) const { return std::int64_t{x} * raster::kSubPixels + offset.x; }
    std::int64_t grid_y(int y) const { return std::int64_t{y} * raster::kSubPixels + offset.y; }
};

/// Tells which samples the rasterizer has each of many triangles cover. All are drawn into one tile, each nearer than
/// those before, so that a sample shows the last triangle that covers it.
class CoverageProbe {
public:
    explicit CoverageProbe(const Window& window);

    /// Draws one more, of any winding; nothing where it has no area.
    void draw(GridTriangle triangle);
    /// Whether the triangle drawn last covers the pixel's sample.
    bool covers(int x, int y) const;

private:
    raster::HitTile tile_;
    std::uint32_t count_ = 0;
};

/// What the rasterizer draws of a mesh in world space for samples at `offset`: transformed, clipped and set up, back
/// faces included.
std::vector<raster::SetupTriangle> set_up(const Mesh& mesh, const View& view, raster::SampleOffset offset);

/// Draws the triangles into the window, as the view's picture has them.
raster::HitTile draw(const std::vector<raster::SetupTriangle>& triangles, const View& view, const Window& window);

} // namespace duet::compare
