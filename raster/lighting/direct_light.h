// Direct light: what the scene's lights send to the viewer by the diffuse and specular lobes of the visible
// surfaces. Area lights are integrated in closed form (raster/lighting/polygon_light.h, sphere_light.h), so there is no
// noise.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"
#include "raster/shadows/shadow_lookup.h"

namespace duet::raster {

/// Holds radiance towards the viewer, for each pixel. Its quotient is the visible fraction of all lights together,
/// which may be filtered without blurring the surfaces (Heitz, Hill and McGuire 2018, "Combining Analytic
/// Direct Illumination and Stochastic Shadows").
struct DirectLight {
    Planes3 unshadowed;
    Planes3 shadowed; ///< empty without a shadow lookup

    const Planes3& arriving() const { return shadowed.empty() ? unshadowed : shadowed; }
};

/// Computes the direct light of all pixels; it is 0 for the background. Lobes whose alpha is below
/// MetalBsdf::kSmoothAlpha are mirrors, which the reflections show. `shadows` may be null.
DirectLight direct_light(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                         const ShadowLookup* shadows);

/// Adds the direct light that arrives to the radiance.
void add(const DirectLight& light, int threads, Planes3& radiance);

} // namespace duet::raster
