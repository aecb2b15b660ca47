// Stage 6: the samples of a tile, and what each of them sees.
#pragma once

#include "raster/geometry.h"

#include <vector>

namespace duet::raster {

/// One sample a pixel of a tile: the camera rays through the samples, and the visibility buffer: an image of Hits, with
/// the nearness of each for the depth test.
///
/// Nearness is reversed depth, near / depth, in (0, 1], as a float: its relative error is 2^-24 at any depth, as that
/// of Hit::t itself, and nothing is lost to a far plane. Of equal nearness the lower (object, primitive) wins, so that
/// the result does not depend on the order of drawing.
class HitTile {
public:
    HitTile(const PixelRect& rect, const Pinhole& pinhole, SampleOffset offset, float time);

    void draw(const SetupTriangle& triangle);
    void draw(const DrawSphere& sphere);

    const PixelRect& rect() const { return rect_; }
    const Hit& hit(int x, int y) const { return hits_[index(x, y)]; }
    const Ray& ray(int x, int y) const { return rays_[index(x, y)]; }
    /// Camera-space −z of what the sample sees, in metres; infinity where that is nothing.
    double depth(int x, int y) const { return static_cast<double>(hit(x, y).t) / distance_per_depth_[index(x, y)]; }
    /// near / depth; 0 where nothing is seen.
    float nearness(int x, int y) const { return nearness_[index(x, y)]; }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - rect_.y0) * static_cast<std::size_t>(rect_.x1 - rect_.x0) +
               static_cast<std::size_t>(x - rect_.x0);
    }
    void cover(const SetupTriangle& triangle, int x, int y);
    bool wins(std::size_t i, float nearness, std::uint32_t object, std::uint32_t primitive) const;

    PixelRect rect_;
    double near_;
    SampleOffset offset_;
    std::vector<Ray> rays_;
    std::vector<double> distance_per_depth_;
    std::vector<float> nearness_;
    std::vector<Hit> hits_;
};

/// A fresh tile, drawn: one sample a pixel of tile `index` of the picture, whose pixels are `rect`.
HitTile cover(const PixelRect& rect, const PassView& view, SampleOffset offset, const Geometry& geometry,
              std::size_t index);

} // namespace duet::raster
