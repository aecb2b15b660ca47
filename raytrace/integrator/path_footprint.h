// How much of what a path meets its sample stands for: a cone about the path (Akenine-Möller et al. 2021, «Improved
// Shader and Texture Level of Detail Using Ray Cones»).
#pragma once

#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

/// The width of a path's cone, from vertex to vertex; nothing at all in scenes where no texture is filtered. At the first
/// hit it is the camera's own footprint. Mirrors and glass leave the cone's angle as it is, whatever their curvature.
/// Any other direction, drawn with some density, stands for the solid angle 1/density, which the pixel's samples share;
/// so that textures seen by way of other surfaces blur less with every sample, and not at all in the end.
class PathFootprint {
public:
    /// Of the path of a pixel's `sample`.
    PathFootprint(const RenderPlan& plan, std::uint32_t sample)
        : pixel_(plan.pixel ? &*plan.pixel : nullptr), part_(pixel_ ? footprint_width(sample) : 0) {}

    /// The footprint of the ray at a hit at distance t, or null: not needed. Once for each ray of the path, in order.
    const RayFootprint* arrive(const Ray& ray, float t) { return pixel_ == nullptr ? nullptr : widen(ray, t); }
    /// The path goes on from there in a direction drawn with a density by solid angle, or in the only one.
    void scatter(float pdf, bool specular) {
        if (pixel_ != nullptr && !specular) spread(pdf);
    }

private:
    // Not inlined: the path's loop is for scenes without, too.
    const RayFootprint* widen(const Ray& ray, float t);
    void spread(float pdf);

    const PixelFootprint* pixel_;
    float part_; ///< of the pixel's width
    RayFootprint footprint_;
    bool first_ = true;
    float width_ = 0, spread_ = 0; ///< of the cone at the last vertex, metres; its growth a metre
};

} // namespace duet::raytrace
