// Stage 7b: surfaces with holes, and those that stop a part of the light only, in order of depth over the opaque picture.
#pragma once

#include "raster/shade.h"

#include <vector>

namespace duet::raster {

/// The layers of a tile, one sample a pixel. Of each pixel's list of Hits nearer than what it sees (raster/visibility/hit_lists.h)
/// holes are left out, the first whole surface becomes what the sample sees, and what is partly there before it is blended:
/// its opacity times its own light, the rest of what lies behind it (Porter and Duff 1984, «over»).
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
    struct Pixel {
        Hit stopping;             ///< the first of its layers that stops the sample's ray
        Shaded front{{}, {}, {}}; ///< the sum of them
        float through = 1;        ///< the part of what lies behind that is seen
    };

    bool add(int x, int y, const Hit& hit);
    Pixel& pixel(int x, int y) {
        const PixelRect& r = tile_.rect();
        return pixels_[static_cast<std::size_t>(y - r.y0) * static_cast<std::size_t>(r.width()) + static_cast<std::size_t>(x - r.x0)];
    }

    const PreparedData& data_;
    const Settings& settings_;
    const Program* program_;
    const PassView& view_;
    SampleOffset offset_;
    HitTile& tile_;
    std::vector<Pixel> pixels_; ///< empty where no layer touches the tile
};

} // namespace duet::raster
