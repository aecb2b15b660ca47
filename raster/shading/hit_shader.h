// Deferred shading of hits that the caller has found, along its own rays.
#pragma once

#include "raster/settings.h"
#include "raster/shading/deferred.h"

#include "common/scene/scene.h"

namespace duet::raster {

/// Shades one hit per pixel as Shading::kLit shades the surfaces that it rasterizes. The rays may differ from pixel to
/// pixel in their position on the pixel, the lens and the time. Effects in screen space take the lens center of the
/// view as the viewer of all of them, at the time the shutter opens. Media are left out.
class HitShader {
public:
    /// `prepared` must outlive this object. All pixels are background until they are set.
    HitShader(const RasterSceneData& data, const View& view, const RasterSettings& settings);

    /// Sets the surface that a pixel's ray meets. Its direction must be unit. Different pixels may be set concurrently.
    void set(int x, int y, const Ray& ray, const SurfacePoint& point, const Bsdf& bsdf);
    /// Does the same for a hit, whose surface point and BSDF it computes. A miss shows the background. `footprint` is
    /// that of the ray at the hit; if it is null, textures are not filtered.
    void set(int x, int y, const Ray& ray, const Hit& hit, const RayFootprint* footprint);

    /// Returns the light towards the viewer, by component. What RasterSettings::indirect_light adds to the light of the
    /// environment is the component `indirect`, which may be negative where it replaces too bright an estimate. The
    /// surfaces must be set again afterwards.
    LightComponentImages shade();

private:
    const RasterSceneData& data_;
    RasterSettings settings_;
    ScreenProjection projection_;
    float time_;
    DeferredFrame frame_;
};

} // namespace duet::raster
