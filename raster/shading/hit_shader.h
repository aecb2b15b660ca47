// Applies deferred shading to hits that the caller has found along its own rays.
#pragma once

#include "raster/settings.h"
#include "raster/shading/deferred.h"

namespace duet::raster {

/// Shades one hit per pixel in the same way as Shading::kLit shades the surfaces that it rasterizes. The rays may
/// differ from pixel to pixel in their position on the pixel, the lens and the time. Screen-space effects assume that
/// all rays start at the lens center when the shutter opens. Media are left out.
class HitShader {
public:
    /// `prepared` must outlive this object. All pixels are background until they are set.
    HitShader(const RasterSceneData& data, const View& view, const RasterSettings& settings);

    /// Sets the surface that a pixel's ray hits. The ray's direction must be unit. Different pixels may be set
    /// concurrently.
    void set(int x, int y, const Ray& ray, const SurfacePoint& point, const Bsdf& bsdf);
    /// Sets the surface at a hit, whose surface point and BSDF it computes. A miss shows the background. `footprint` is
    /// that of the ray at the hit; if it is null, textures are not filtered.
    void set(int x, int y, const Ray& ray, const Hit& hit, const RayFootprint* footprint);

    /// Returns the light toward the viewer, by component. The component `indirect` is the change of the environment's
    /// light by RasterSettings::indirect_light. It may be negative, where the probes replace an estimate that was too
    /// bright. The surfaces must be set again before the next call.
    LightComponentImages shade();

private:
    const RasterSceneData& data_;
    RasterSettings settings_;
    ScreenProjection projection_;
    float time_;
    DeferredFrame frame_;
};

} // namespace duet::raster
