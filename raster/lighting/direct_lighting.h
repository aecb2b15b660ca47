// This header declares direct lighting from the scene's lights.
#pragma once

#include "common/geometry/surface_point.h"
#include "common/light/light.h"
#include "common/material/diffuse.h"
#include "common/material/metal.h"
#include "common/vec/frame.h"
#include "raster/lighting/tap_range.h"

#include <span>

namespace duet::raster {

/// A shading point is a surface point together with its viewer. The visible side is that of the geometric normal.
struct ShadingPoint {
    const SurfacePoint& surface;
    Vec3 ng; ///< geometric normal, on the viewer's side; light from the other side does not arrive
    Vec3 terminator_normal; ///< SurfacePoint::terminator_normal (the normal of the shading-terminator fix), on the
                            ///< viewer's side
    Vec3 ns; ///< shading normal, in the hemisphere of ng
    Frame frame; ///< about the surface's own shading normal (+z is outside), in which BSDFs are evaluated
    Vec3 wo; ///< direction to the viewer, unit, in `frame`; always on the visible side

    /// `to_viewer` is a unit vector in world space.
    ShadingPoint(const SurfacePoint& point, Vec3 to_viewer);
    /// Returns whether light from the world-space direction w arrives on the visible side: above the plane of
    /// `terminator_normal`.
    bool receives(Vec3 w) const { return dot(terminator_normal, w) > 0; }
};

/// Returns the unoccluded irradiance from a surface light at a shading point, in closed form. It covers the
/// directions above the planes of both `terminator_normal` and the shading normal, and is 0 on the light's own
/// primitive.
Rgb irradiance(const SurfaceLight& light, const ShadingPoint& point);

class Shadows; // raster/shadows/shadows.h

/// DirectRadiance light toward the viewer is split into the visible and the shadowed fraction.
struct DirectRadiance {
    Rgb unshadowed, shadowed;

    /// Adds light of which the fraction `visible`, in [0, 1], is unshadowed.
    void add(Rgb light, float visible) {
        unshadowed += light * visible;
        shadowed += light * (1 - visible);
    }
};

/// Returns the visible fraction of each light, in [0, 1].
struct LightVisibility {
    const Shadows* shadows = nullptr; ///< null: every light is fully visible
    TapRange taps{};

    float operator()(std::size_t light, const ShadingPoint& point) const;
};

/// Returns the radiance toward the viewer. A diffuse BSDF is exact for every light. Rough metal is exact for point,
/// spot and sun lights. For a surface light it uses linearly transformed cosines (raster/lighting/area_specular.h) or,
/// without `transformed_cosines`, a distant light of the same irradiance in the direction of the light's center.
/// Smooth metal reflects none.
DirectRadiance direct_light(std::span<const Light> lights, const DiffuseBsdf& bsdf, const ShadingPoint& point,
                            const LightVisibility& visibility);
/// Rough diffuse is exact for point, spot and sun lights. A surface light contributes its irradiance, reflected as if
/// all of it came from the light's center.
DirectRadiance direct_light(std::span<const Light> lights, const RoughDiffuseBsdf& bsdf, const ShadingPoint& point,
                            const LightVisibility& visibility);
DirectRadiance direct_light(std::span<const Light> lights, const MetalBsdf& bsdf, const ShadingPoint& point,
                            const LightVisibility& visibility, bool transformed_cosines);

/// Approximates a surface light by a distant light in the direction of its center. The irradiance is that at p on a
/// surface facing this direction. The result is black if p is the center itself.
template <typename T> struct IncidentT;
IncidentT<float> as_distant(const SurfaceLight& light, Vec3 p);

} // namespace duet::raster
