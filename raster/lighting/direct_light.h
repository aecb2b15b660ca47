// Direct light: what the scene's lights send to the viewer by the diffuse and specular lobes of the visible
// surfaces. Area lights are integrated in closed form (raster/lighting/polygon_light.h, sphere_light.h), so there is no
// noise.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/raster_scene.h"
#include "raster/shadows/shadow_lookup.h"

#include <limits>

namespace duet::raster {

/// Holds radiance towards the viewer, for each pixel.
struct DirectLight {
    Planes3 exact; ///< from lights without shadows, and lights whose shadows are not noisy
    /// From lights with noisy shadows; empty if there are none. The quotient is the visible fraction of these lights
    /// together, which may be filtered without blurring the surfaces (Heitz, Hill and McGuire 2018, "Combining Analytic
    /// Direct Illumination and Stochastic Shadows").
    Planes3 unshadowed, shadowed;
};

/// Computes the direct light of all pixels; it is 0 for the background. Lobes whose alpha is below
/// MetalBsdf::kSmoothAlpha are mirrors, which the reflections show. `shadows` may be null. If a cluster of pixels has
/// more than `most_lights` near lights, about so many stand for all (LightSet::choose).
inline constexpr std::size_t kAllLights = std::numeric_limits<std::size_t>::max();
DirectLight direct_light(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                         const ShadowLookup* shadows, std::size_t most_lights = kAllLights);

} // namespace duet::raster
