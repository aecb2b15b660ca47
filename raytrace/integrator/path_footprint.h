// How much of what a path meets its sample stands for: a cone about the path (Akenine-Möller et al. 2021, «Improved
// Shader and Texture Level of Detail Using Ray Cones»).
#pragma once

#include "raytrace/integrator/vertex.h"

#include <cmath>

namespace duet::raytrace {

/// The width of a path's cone, from vertex to vertex; nothing at all in scenes where no texture is filtered. At the first
/// hit it is the camera's own footprint. Mirrors and glass leave the cone's angle as it is, whatever their curvature.
/// Any other direction, drawn with some density, stands for the solid angle 1/density, which the pixel's samples share;
/// so that textures seen by way of other surfaces blur less with every sample, and not at all in the end.
class PathFootprint {
public:
    explicit PathFootprint(const RenderPlan& plan) : pixel_(plan.pixel ? &*plan.pixel : nullptr) {}

    /// The footprint of the ray at a hit at distance t, or null: not needed. Once for each ray of the path, in order.
    const RayFootprint* arrive(const Ray& ray, float t) {
        if (pixel_ == nullptr) return nullptr;
        if (first_)
            begin(ray, t);
        else
            widen(ray, t);
        return &footprint_;
    }
    /// The path goes on from there in a direction drawn with a density by solid angle, or in the only one.
    void scatter(float pdf, bool specular) {
        if (pixel_ == nullptr || specular) return;
        constexpr float kWidest = 0.5f; // radians: what is seen by way of diffuse surfaces keeps some of its detail
        const float angle = 2 * std::sqrt(kInvPi / max(pdf, 1e-6f)) * pixel_->scale();
        spread_ = max(spread_, min(angle, kWidest));
    }

private:
    void begin(const Ray& ray, float t) {
        first_ = false;
        footprint_ = pixel_->at(ray, t);
        width_ = std::sqrt(length(footprint_.dx) * length(footprint_.dy));
        // Straight rays widen in proportion to their length, but for an orthographic camera's, which don't.
        const RayFootprint farther = pixel_->at(ray, 2 * t);
        spread_ = (std::sqrt(length(farther.dx) * length(farther.dy)) - width_) / t;
    }
    void widen(const Ray& ray, float t) {
        width_ += spread_ * t;
        const Frame frame = frame_from_normal(ray.direction);
        footprint_ = {frame.to_world({width_, 0, 0}), frame.to_world({0, width_, 0})};
    }

    const PixelFootprint* pixel_;
    RayFootprint footprint_;
    bool first_ = true;
    float width_ = 0, spread_ = 0;
};

} // namespace duet::raytrace
