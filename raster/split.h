// The rasterizer's shading, for hits that its caller has found: its light split into parts, for those who ask where
// light comes from.
#pragma once

#include "common/scene/scene.h"
#include "raster/render.h"

namespace duet::raster {

class Screen; // raster/screen/screen.h

/// Radiance towards the viewer, as Shading::kLit approximates it: the parts add up to what a picture shows. A part that
/// Settings::parts leaves out is black.
struct LightParts {
    Rgb emission;    ///< seen directly: emissive surfaces, and the environment behind all
    Rgb direct;      ///< from Scene::lights by diffuse surfaces and rough metal
    Rgb environment; ///< from the environment by diffuse surfaces, its occlusion guessed where there is a screen
    Rgb reflection;  ///< by way of metal and glass: of what the picture shows where there is a screen, of lamps, of the environment
    Rgb shadowed;    ///< no part of the sum: what `direct` lacks by the shadow maps

    Rgb sum() const { return emission + direct + environment + reflection; }
};

/// How a picture of these settings would show what `ray`, of unit direction, hits; the background where that is
/// nothing. `footprint`: of the ray at the hit; null: textures are not filtered.
LightParts shade_hit(const Prepared& prepared, const Settings& settings, const Ray& ray, const Hit& hit,
                     const RayFootprint* footprint = nullptr, const Screen* screen = nullptr);
/// The same of a surface point whose BSDF the caller has worked out. to_viewer: unit, in the world.
LightParts shade_surface(const Prepared& prepared, const Settings& settings, const SurfacePoint& surface,
                         const Bsdf& bsdf, Vec3 to_viewer, const Screen* screen = nullptr);

/// The depths that a view shows through the lens's centre as the shutter opens: what effects in screen space look at.
/// Null where these settings have none.
std::shared_ptr<const Screen> screen_of(const Prepared& prepared, const View& view, const Settings& settings);

} // namespace duet::raster
