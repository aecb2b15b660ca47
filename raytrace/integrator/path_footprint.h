// Declares the footprint of a path, the area of a surface that one sample covers. It is tracked as a cone around the
// path (Akenine-Möller et al. 2021, "Improved Shader and Texture Level of Detail Using Ray Cones").
#pragma once

#include "raytrace/integrator/vertex.h"

namespace duet::raytrace {

/// Tracks the width of a path's cone from vertex to vertex. It does nothing in scenes where no texture is filtered. At
/// the first hit the footprint is the camera's own. Mirrors and glass do not change the cone's angle, whatever their
/// curvature. A direction drawn with some density covers the solid angle 1/density, which the pixel's samples share.
/// Textures seen through other surfaces thus blur less with every sample, and in the limit not at all.
class PathFootprint {
public:
    /// Starts the cone of the path of sample `sample` of a pixel.
    PathFootprint(const RenderPlan& plan, std::uint32_t sample)
        : pixel_(plan.pixel_footprint ? &*plan.pixel_footprint : nullptr),
          fraction_(pixel_ ? footprint_width(sample) : 0) {}

    /// Returns the footprint of the ray at a hit at distance t, or null if none is needed. It must be called once
    /// for each ray of the path, in order.
    const RayFootprint* at_hit(const Ray& ray, float t) { return pixel_ == nullptr ? nullptr : widen(ray, t); }
    /// Continues the path in a direction that was drawn with density `pdf` by solid angle, or that is specular.
    void scatter(float pdf, bool specular) {
        if (pixel_ != nullptr && !specular) spread(pdf);
    }

private:
    // These functions are not inlined, because scenes without filtered textures run the same path loop.
    const RayFootprint* widen(const Ray& ray, float t);
    void spread(float pdf);

    const PixelFootprint* pixel_;
    float fraction_; ///< fraction of the pixel's width
    RayFootprint footprint_;
    bool first_ = true;
    float width_ = 0, spread_ = 0; ///< cone width at the last vertex in meters, and its growth per meter
};

} // namespace duet::raytrace
