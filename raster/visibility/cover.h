// Stage 7: the image of Hits of a tile.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/visibility/depth_tile.h"
#include "raster/visibility/multisample.h"

#include "common/camera/pixel_footprint.h"
#include "common/geometry/hit.h"

#include <vector>

namespace duet::raster {

/// The ray in float.
Ray rounded(const Rayd& exact, float time);

/// Draws all that may be seen of a tile of the picture: its depths, and the number of what each sample sees. draw_tile() leaves
/// the samples of blocks that nothing was drawn to undefined.
void draw_tile(const Geometry& geometry, const PassView& view, SampleOffset offset, const PixelRect& rect, std::size_t index,
               DepthTile& tile);
void cover(const Geometry& geometry, const PassView& view, SampleOffset offset, const PixelRect& rect,
           std::size_t index, DepthTile& tile);

/// What a sample sees of a triangle: the naive way, one at a time, that all others are held to. `pixel` is the sample's
/// place, distance_per_depth the length of its ray for each metre of depth.
Hit hit_triangle(const WholeTriangle& whole, std::uint32_t object, std::uint32_t primitive, Vec2d pixel,
                 double distance_per_depth, double near);

/// The same of anything that has a number. A sphere that the ray misses is hit where it passes nearest.
Hit find_hit(const Geometry& geometry, const PassView& view, std::uint32_t id, Vec2d pixel);

/// One sample a pixel of a tile: the camera rays through the samples, and the visibility buffer: an image of Hits.
class HitTile {
public:
    /// Looks up what was drawn into `tile`.
    HitTile(const DepthTile& tile, const Geometry& geometry, const PassView& view);
    /// What is in one layer of the samples of `tile`; no other pixel has a ray.
    HitTile(const LayeredTile& tile, std::size_t layer, const Geometry& geometry, const PassView& view);

    const PixelRect& rect() const { return rect_; }
    const Screen* screen() const { return screen_; }
    const Hit& hit(int x, int y) const { return hits_[index(x, y)]; }
    const Ray& ray(int x, int y) const { return rays_[index(x, y)]; }
    double distance_per_depth(int x, int y) const { return distance_per_depth_[index(x, y)]; }
    /// Lets a sample see something else; what it saw.
    Hit exchange(int x, int y, const Hit& hit);
    /// Camera-space −z of what the sample sees, in metres; infinity where that is nothing.
    double depth(int x, int y) const { return static_cast<double>(hit(x, y).t) / distance_per_depth_[index(x, y)]; }
    /// Of a sample that sees something, where a pixel takes a number of them.
    RayFootprint footprint(int x, int y, int samples_per_pixel) const {
        return PixelFootprint(pinhole_, samples_per_pixel).at(ray(x, y), hit(x, y).t);
    }
    /// The quadrant of its pixel in which each sample lies, 0 to 3; of whole pixels 0.
    int quadrant() const { return quadrant_; }
    /// near / depth; 0 where nothing is seen.
    float nearness(int x, int y) const { return nearness_[index(x, y)]; }

private:
    class Filler;
    void make_room();
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - rect_.y0) * static_cast<std::size_t>(rect_.width()) +
               static_cast<std::size_t>(x - rect_.x0);
    }

    PixelRect rect_;
    Pinhole pinhole_;
    const Screen* screen_;
    int quadrant_ = 0;
    std::vector<Ray> rays_;
    std::vector<double> distance_per_depth_;
    std::vector<float> nearness_;
    std::vector<Hit> hits_;
};

} // namespace duet::raster
