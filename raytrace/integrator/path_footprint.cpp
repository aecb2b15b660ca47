#include "raytrace/integrator/path_footprint.h"

#include "common/vec/frame.h"

#include <cmath>

namespace duet::raytrace {

namespace {

float mean_width(const RayFootprint& footprint) { return std::sqrt(length(footprint.dx) * length(footprint.dy)); }

} // namespace

const RayFootprint* PathFootprint::widen(const Ray& ray, float t) {
    if (first_) {
        first_ = false;
        footprint_ = pixel_->at(ray, t) * fraction_;
        width_ = mean_width(footprint_);
        // The footprint of a perspective camera's ray widens in proportion to its length. That of an orthographic
        // camera is constant.
        spread_ = (mean_width(pixel_->at(ray, 2 * t) * fraction_) - width_) / t;
        return &footprint_;
    }
    width_ += spread_ * t;
    const Frame frame = frame_from_normal(ray.direction);
    footprint_ = {frame.to_world({width_, 0, 0}), frame.to_world({0, width_, 0})};
    return &footprint_;
}

void PathFootprint::spread(float pdf) {
    constexpr float kWidest = 0.5f; // radians; textures after diffuse bounces keep some detail
    const float angle = 2 * std::sqrt(kInvPi / max(pdf, 1e-6f)) * fraction_;
    spread_ = max(spread_, min(angle, kWidest));
}

} // namespace duet::raytrace
