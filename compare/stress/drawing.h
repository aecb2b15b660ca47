// The rasterizer's own stages, called one triangle or one mesh at a time, for the tests to judge.
#pragma once

#include "compare/stress/exact_coverage.h"
#include "raster/visibility/cover.h"

#include <memory>
#include <vector>

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

/// Tells which samples the rasterizer has each of many triangles cover, from its stage of assembly on: small ones are
/// decided at once there, others drawn by the tile. All are drawn into one tile, each nearer than those before, so that
/// a sample shows the last triangle that covers it.
class CoverageProbe {
public:
    /// At most TileGrid::kTileSize pixels a side.
    explicit CoverageProbe(const Window& window);

    /// Draws one more, of any winding; nothing where it has no area.
    void draw(GridTriangle triangle);
    /// Whether the triangle drawn last covers the pixel's sample.
    bool covers(int x, int y) const;

private:
    raster::AssemblyPlan plan_;
    Scene scene_; ///< of one mesh of one triangle
    raster::Triangles triangles_;
    raster::Assembler assembler_;
    raster::DepthTile tile_;
    std::uint32_t count_ = 0;
};

/// Outlines and the triangles they were made of, numbered from 0.
struct Pile : raster::WholeTriangles {
    std::vector<raster::WholeTriangle> wholes;
    std::vector<raster::DrawTriangle> outlines;

    raster::WholeTriangle whole(std::uint32_t id) const override { return wholes[id]; }
    /// Numbers the other's triangles after these.
    void append(const Pile& other);
};

/// What the rasterizer draws of a mesh in world space for samples at `offset`: transformed, clipped and set up, back
/// faces included.
Pile set_up(const Mesh& mesh, const View& view, raster::SampleOffset offset);

/// Draws outlines of a pile into the window, in their order.
std::unique_ptr<raster::DepthTile> draw(const Pile& pile, const std::vector<raster::DrawTriangle>& outlines,
                                        const View& view, const Window& window);
inline std::unique_ptr<raster::DepthTile> draw(const Pile& pile, const View& view, const Window& window) {
    return draw(pile, pile.outlines, view, window);
}

/// What the rasterizer's whole pipeline sees of a mesh in the window, back faces included.
raster::HitTile draw(const Mesh& mesh, const View& view, const Window& window);

} // namespace duet::compare
