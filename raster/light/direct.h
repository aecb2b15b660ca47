// Light that comes straight from the scene's lights.
#pragma once

#include "common/geometry/surface_point.h"
#include "common/light/light.h"
#include "common/material/diffuse.h"
#include "common/material/metal.h"
#include "common/vec/frame.h"
#include "raster/taps.h"

#include <span>

namespace duet::raster {

/// A point on a surface as its viewer sees it. The side that is seen is the geometric one.
struct ShadingPoint {
    const SurfacePoint& surface;
    Vec3 ng;     ///< geometric normal, on the viewer's side: light from its other side doesn't arrive
    Vec3 horizon; ///< SurfacePoint::horizon, on the viewer's side
    Vec3 ns;     ///< shading normal, in the hemisphere of ng
    Frame frame; ///< about the surface's own shading normal (+z is the outside), in which materials work
    Vec3 wo;     ///< to the viewer, unit, in that frame; always on the side that is seen

    /// to_viewer: unit, in the world.
    ShadingPoint(const SurfacePoint& point, Vec3 to_viewer);
    /// Whether light from w (in the world) arrives on the side of the surface that is seen: above its horizon.
    bool receives(Vec3 w) const { return dot(horizon, w) > 0; }
};

/// Irradiance from a surface light at a shading point, in closed form: over the directions above the horizons of both
/// normals. 0 on the light's own primitive.
Rgb irradiance(const SurfaceLight& light, const ShadingPoint& point);

class Shadows; // raster/shadow/shadows.h

/// Light towards the viewer, and what shadows keep from it.
struct Direct {
    Rgb arriving, shadowed;

    /// Light of which a part is visible.
    void add(Rgb light, float visible) {
        arriving += light * visible;
        shadowed += light * (1 - visible);
    }
};

/// Tells of each light how much of it arrives.
struct Visibility {
    const Shadows* shadows = nullptr; ///< null: all of all
    TapRange taps{};

    float operator()(std::size_t light, const ShadingPoint& point) const;
};

/// Radiance towards the viewer. Diffuse: exact for every light. Rough metal: exact for point, spot and sun; a surface
/// light by transformed cosines (raster/light/area_specular.h), or, without, as a distant one of the same irradiance at its
/// centre. Smooth metal: none.
Direct direct_light(std::span<const Light> lights, const DiffuseBsdf& bsdf, const ShadingPoint& point,
                    const Visibility& visibility);
/// Rough diffuse: exact for point, spot and sun; a surface light by its irradiance, reflected as from its centre.
Direct direct_light(std::span<const Light> lights, const RoughDiffuseBsdf& bsdf, const ShadingPoint& point,
                    const Visibility& visibility);
Direct direct_light(std::span<const Light> lights, const MetalBsdf& bsdf, const ShadingPoint& point,
                    const Visibility& visibility, bool transformed_cosines);

/// A surface light as a distant one in its centre's direction, and its irradiance at p on a surface facing that way;
/// black in the centre itself.
template <typename T> struct IncidentT;
IncidentT<float> as_distant(const SurfaceLight& light, Vec3 p);

} // namespace duet::raster
