// Declares the rasterizer's shading for hits found by the caller. The light is split into parts, for analysis.
#pragma once

#include "common/scene/scene.h"
#include "raster/render.h"

namespace duet::raster {

class ScreenGBuffer; // raster/gbuffer/screen_gbuffer.h

/// Holds the radiance towards the viewer as Shading::kLit approximates it. The parts sum to the color of the image. A
/// part that RasterSettings::components turns off is black.
struct LightComponents {
    Rgb emission;    ///< directly visible emissive surfaces, and the environment as the background
    Rgb direct;      ///< from Scene::lights, reflected by diffuse surfaces and rough metal
    /// This part is light from the environment that diffuse surfaces reflect. Its occlusion is estimated if a
    /// G-buffer is given.
    Rgb environment;
    Rgb reflection;  ///< from metal and glass: area lights, the environment, and the image if there is a G-buffer
    Rgb shadowed;    ///< not included in the sum: the direct light that the shadow maps block

    Rgb sum() const { return emission + direct + environment + reflection; }
};

/// Shades the hit of `ray`, whose direction must be unit. A miss gives the background. `footprint` is that of the ray
/// at the hit. If it is null, textures are not filtered.
LightComponents shade_hit(const RasterScene& prepared, const RasterSettings& settings, const Ray& ray, const Hit& hit,
                          const RayFootprint* footprint = nullptr, const ScreenGBuffer* gbuffer = nullptr);
/// Shades a surface point with a BSDF that the caller has computed. `to_viewer` is unit, in world space.
LightComponents shade_surface(const RasterScene& prepared, const RasterSettings& settings, const SurfacePoint& surface,
                              const Bsdf& bsdf, Vec3 to_viewer, const ScreenGBuffer* gbuffer = nullptr);

/// Returns the G-buffer of a view, from the lens center at the time the shutter opens, for screen-space effects.
/// Returns null if these settings need none.
std::shared_ptr<const ScreenGBuffer> make_screen_gbuffer(const RasterScene& prepared, const View& view,
                                                         const RasterSettings& settings);

} // namespace duet::raster
