// This header declares screen-space reflections on metal.
#pragma once

#include "raster/lighting/direct_lighting.h"
#include "raster/screen_space/screen_space_tracer.h"

#include "common/material/material.h"

#include <optional>

namespace duet::raster {

/// Returns whether a material may reflect the image somewhere.
bool may_reflect_image(const Material& material);
/// Returns whether such a reflection is all that the material shows. The color prepass then has only the environment
/// for it.
bool reflects_image_only(const Material& material);

/// Computes the reflection on a smooth or moderately rough metal, in a few directions of its lobe. They are the same
/// for every point, and each is as wide as the part of the lobe that it represents.
class ScreenSpaceReflection {
public:
    static constexpr int kRays = 8; ///< per pixel of rough metal

    /// `gbuffer` must have radiance. All arguments must outlive this object.
    ScreenSpaceReflection(const RasterSceneData& data, const RasterSettings& settings, const ScreenGBuffer& gbuffer,
                          const ShadingPoint& point, const MetalBsdf& bsdf);

    /// Returns the reflected radiance. For rough metal it is the weighted mean over the rays times the metal's
    /// albedo, so that no energy is lost to unsampled parts of the lobe or to rays below the horizon. A subset of the
    /// taps uses a subset of the rays, and the mean of all subsets is the full result. It is empty if no ray is above
    /// the horizon.
    std::optional<Rgb> operator()(TapRange taps) const;

private:
    struct Sample {
        Vec3 direction;
        float pdf = 0;
        Rgb weight;
    };
    Sample sample(Vec2 u) const;
    Rgb ray_radiance(const Sample& ray, int rays) const;

    ScreenSpaceTracer tracer_;
    const ShadingPoint& point_;
    const MetalBsdf& bsdf_;
    Vec3 p_;
    float width_ = 0,
          divergence_ = 0; ///< width of a pixel; angle in radians between its reflected ray and the neighbor's
};

} // namespace duet::raster
