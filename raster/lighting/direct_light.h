// Computes direct light: the radiance that the diffuse and specular lobes of the visible surfaces reflect from the
// scene's lights. Area lights are integrated in closed form (raster/lighting/polygon_light.h, sphere_light.h), so there
// is no noise.
#pragma once

#include "raster/gbuffer/gbuffer.h"
#include "raster/lighting/frame_lights.h"
#include "raster/shadows/light_visibility.h"

#include <limits>
#include <span>

namespace duet::raster {

/// Holds the radiance toward the viewer for each pixel; 0 for the background.
struct DirectLight {
    Planes3 exact; ///< from lights without shadows, and lights whose shadows are not noisy
    /// This is the radiance from lights with noisy shadows, as if nothing shaded them. It is empty if there are none.
    Planes3 unshadowed;
    /// This is the fraction of `unshadowed` that arrives, in [0, 1]; kNoLight where `unshadowed` is black. It may be
    /// filtered without blurring the surfaces.
    Planes3 lit;
    static constexpr float kNoLight = -1;

    std::size_t memory_bytes() const { return exact.memory_bytes() + unshadowed.memory_bytes() + lit.memory_bytes(); }
};

/// Limits the number of near lights per cluster of pixels, in scenes of more than LightSet::kFewLights. If a cluster
/// has more than `most`, about `most` of them are chosen at random (LightSet::choose). Images that are averaged should
/// differ in `random`, a number in [0, 1).
struct ChosenLights {
    static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
    std::size_t most = kAll;
    float random = 0;
};

/// Computes the light that all pixels receive from the given lights. Lobes whose alpha is below
/// MetalBsdf::kSmoothAlpha are mirrors, which the reflections show. `shadows` may be null. `light` may be that of an
/// earlier frame, whose memory is then reused.
void compute_direct_light(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                          std::span<const FrameLight> lights, const LightVisibility* shadows, DirectLight& light,
                          const ChosenLights& chosen = {});

} // namespace duet::raster
