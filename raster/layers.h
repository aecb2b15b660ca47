// Stage 7b: surfaces with holes, and those that stop a part of the light only, in order of depth over the opaque picture.
#pragma once

#include "raster/shade.h"

#include <array>
#include <vector>

namespace duet::raster {

/// The layers of a tile, one sample a pixel. Each pixel's list of Hits nearer than what it sees is sorted from the front
/// (Carpenter 1984, «The A-buffer, an Antialiased Hidden Surface Method»); holes are left out, the first whole surface
/// becomes what the sample sees, and what is partly there before it is blended: its opacity times its own light, the rest
/// of what lies behind it (Porter and Duff 1984, «over»). Lists hold the kKept nearest; where there are more, the tile is
/// drawn again for those behind them. So memory does not grow with the number of layers.
class Layers {
public:
    /// Changes what the tile's samples see. `geometry`: of process_layers. `offset`: the tile's.
    /// `program`: of the shading; null for Shading::kLit.
    Layers(const PreparedData& data, const Settings& settings, const Program* program, const Geometry& geometry, const PassView& view,
           SampleOffset offset, std::size_t tile_index, HitTile& tile);

    /// A pixel with its layers over what it sees. What it sees becomes, of the layers and that, what stops its ray
    /// (common/scene/holes.h): the hit that a ray tracer reports.
    Shaded over(int x, int y, const Shaded& behind);

private:
    static constexpr std::size_t kKept = 8;
    struct Pixel {
        std::array<Hit, kKept> nearest;
        std::uint32_t count = 0;
        bool more = false, done = false;
        Hit last{.t = -1};       ///< all nearer ones, and it, are dealt with
        Hit stopping;            ///< the first among them that stops the sample's ray
        Shaded front{{}, {}, {}}; ///< the sum of what is dealt with
        float through = 1;       ///< the part of what lies behind that is seen
    };

    void draw_outlines();
    void draw_outline(const DrawTriangle& triangle);
    void draw_fragments();
    void draw_spheres();
    void add_triangle(std::uint32_t id, int x, int y);
    void add(int x, int y, const Hit& hit);
    void resolve(int x, int y);
    Pixel& pixel(int x, int y) { return pixels_[place(x, y)]; }
    std::size_t place(int x, int y) const {
        const PixelRect& r = tile_.rect();
        return static_cast<std::size_t>(y - r.y0) * static_cast<std::size_t>(r.width()) + static_cast<std::size_t>(x - r.x0);
    }

    const PreparedData& data_;
    const Settings& settings_;
    const Program* program_;
    const Geometry& geometry_;
    const PassView& view_;
    SampleOffset offset_;
    std::size_t tile_index_;
    HitTile& tile_;
    std::vector<Pixel> pixels_; ///< empty where no layer touches the tile
};

} // namespace duet::raster
