// Implements stage 7b, which composites alpha-masked and alpha-blended surfaces over the opaque image, sorted by
// depth.
#pragma once

#include "raster/shading/sample_attributes.h"

#include "common/image/image.h"

namespace duet::raster {

class ShaderProgram; // raster/shader/packet_shader.h

/// Holds the transparent layers of a tile, one sample per pixel. Each pixel has a list of Hits in front of its
/// visible surface (raster/visibility/hit_lists.h). Hits of zero opacity are skipped. The first fully opaque hit
/// becomes the visible surface. Those in front of it are blended with the "over" operator (Porter and Duff 1984).
class Layers {
public:
    /// Shades the layers. It changes the visible surface in `tile` where an opaque hit lies in front. `geometry`
    /// comes from process_layers, `offset` is that of the tile's samples, `program` is the shading program. If it is
    /// null, radiance is not computed, because deferred shading computes it (raster/shading/blended_layers.h).
    Layers(const RasterSceneData& data, const RasterSettings& settings, const ShaderProgram* program,
           const Geometry& geometry, const PassView& view, SampleOffset offset, std::size_t tile_index, HitTile& tile);

    /// Returns the pixel with its layers composited over `behind`. The tile's hit becomes the surface that stops
    /// the ray (common/scene/alpha_mask.h), which is the hit that a ray tracer reports.
    ShadedSample over(int x, int y, const ShadedSample& behind);

private:
    struct Pixel {
        Hit blocking_hit;               ///< the first layer that stops the sample's ray
        ShadedSample front{{}, {}, {}}; ///< the sum of the layers, weighted by visibility
        float transmittance = 1;        ///< transmittance of all layers of the pixel
    };

    bool add(int x, int y, const Hit& hit);
    Pixel& pixel(int x, int y) { return pixels_(x - tile_.rect().x0, y - tile_.rect().y0); }

    const RasterSceneData& data_;
    const RasterSettings& settings_;
    const ShaderProgram* program_;
    const PassView& view_;
    SampleOffset offset_;
    HitTile& tile_;
    Image<Pixel> pixels_; ///< empty if no layer overlaps the tile
};

} // namespace duet::raster
