// How far apart the rays of neighbouring samples are.
#pragma once

#include "common/camera/camera.h"
#include "common/geometry/footprint.h"

#include <algorithm>
#include <cmath>

namespace duet {

/// Of a view whose pixels take a number of samples each: every one stands for its share of the pixel's area, so steps
/// are those of pixels over √samples.
class PixelFootprint {
public:
    PixelFootprint(const Pinhole& view, int samples_per_pixel)
        : forward_(view.forward), scale_(static_cast<float>(1 / std::sqrt(std::max(samples_per_pixel, 1)))),
          origin_dx_(Vec3(view.origin_dx) * scale_), origin_dy_(Vec3(view.origin_dy) * scale_),
          direction_dx_(Vec3(view.direction_dx) * scale_), direction_dy_(Vec3(view.direction_dy) * scale_) {}

    /// At distance t along a camera ray of unit direction.
    RayFootprint at(const Ray& ray, float t) const {
        const float depth = t * dot(ray.direction, forward_);
        return {origin_dx_ + direction_dx_ * depth, origin_dy_ + direction_dy_ * depth};
    }
    /// 1/√samples.
    float scale() const { return scale_; }

private:
    Vec3 forward_;
    float scale_;
    Vec3 origin_dx_, origin_dy_, direction_dx_, direction_dy_;
};

} // namespace duet
