// A pixel footprint measures the spacing of the rays of neighboring samples.
#pragma once

#include "common/camera/camera.h"
#include "common/geometry/footprint.h"

#include <algorithm>
#include <cmath>

namespace duet {

/// With n samples per pixel, each sample represents 1/n of the pixel's area. The spacing of samples is therefore the
/// spacing of pixels divided by √n.
class PixelFootprint {
public:
    PixelFootprint(const Pinhole& view, int samples_per_pixel)
        : forward_(view.forward), scale_(static_cast<float>(1 / std::sqrt(std::max(samples_per_pixel, 1)))),
          origin_dx_(Vec3(view.origin_dx) * scale_), origin_dy_(Vec3(view.origin_dy) * scale_),
          direction_dx_(Vec3(view.direction_dx) * scale_), direction_dy_(Vec3(view.direction_dy) * scale_) {}

    /// Returns the footprint at distance t along a camera ray, whose direction must have unit length.
    RayFootprint at(const Ray& ray, float t) const {
        const float depth = t * dot(ray.direction, forward_);
        return {origin_dx_ + direction_dx_ * depth, origin_dy_ + direction_dy_ * depth};
    }
    /// Returns 1/√n, where n is the number of samples per pixel.
    float scale() const { return scale_; }

private:
    Vec3 forward_;
    float scale_;
    Vec3 origin_dx_, origin_dy_, direction_dx_, direction_dy_;
};

} // namespace duet
