// Implements stage 7, which builds the visibility buffer of a tile, an image of Hits.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/visibility/depth_tile.h"
#include "raster/visibility/multisample.h"

#include "common/camera/pixel_footprint.h"
#include "common/geometry/hit.h"

#include <vector>

namespace duet::raster {

/// Rounds a ray to float.
Ray rounded(const Rayd& exact, float time);

/// Returns the hit of a triangle at one sample. This is the scalar reference that all faster paths must match.
/// `pixel` is the sample position in pixels, `distance_per_depth` the ray length per meter of depth, `near` the
/// distance of the near plane in meters.
Hit hit_triangle(const UnclippedTriangle& whole, Geometry::Primitive primitive, Vec2d pixel, double distance_per_depth,
                 double near);

/// Returns the hit of any primitive by its id, at one sample. If the ray misses a sphere, the hit is the point of
/// closest approach.
Hit find_hit(const Geometry& geometry, const PassView& view, std::uint32_t id, Vec2d pixel);

/// Holds the camera rays and the visibility buffer (an image of Hits) of a tile, with one sample per pixel.
class HitTile {
public:
    /// Computes the rays of all samples and the hits of the primitives drawn into `tile`.
    HitTile(const DepthTile& tile, const Geometry& geometry, const PassView& view);
    /// Computes the rays and hits of one layer of a multisampled tile. Pixels that are not in the layer have no
    /// ray.
    HitTile(const LayeredTile& tile, std::size_t layer, const Geometry& geometry, const PassView& view);

    const PixelRect& rect() const { return rect_; }
    const Hit& hit(int x, int y) const { return hits_[index(x, y)]; }
    const Ray& ray(int x, int y) const { return rays_[index(x, y)]; }
    double distance_per_depth(int x, int y) const { return distance_per_depth_[index(x, y)]; }
    /// Replaces the hit of a sample and its reversed depth. Returns the previous hit.
    Hit exchange(int x, int y, const Hit& hit);
    /// Returns the camera-space −z of the visible surface, in meters; infinity on a miss.
    double depth(int x, int y) const { return static_cast<double>(hit(x, y).t) / distance_per_depth_[index(x, y)]; }
    /// Returns the footprint of a sample that has a hit.
    RayFootprint footprint(int x, int y) const {
        return PixelFootprint(pinhole_, samples_per_pixel_).at(ray(x, y), hit(x, y).t);
    }
    /// Returns the reversed depth, near / depth; 0 on a miss.
    float reversed_depth(int x, int y) const { return reversed_depth_[index(x, y)]; }

private:
    class Filler;
    void allocate();
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - rect_.y0) * static_cast<std::size_t>(rect_.width()) +
               static_cast<std::size_t>(x - rect_.x0);
    }

    PixelRect rect_;
    Pinhole pinhole_;
    int samples_per_pixel_;
    std::vector<Ray> rays_;
    std::vector<double> distance_per_depth_;
    std::vector<float> reversed_depth_;
    std::vector<Hit> hits_;
};

} // namespace duet::raster
