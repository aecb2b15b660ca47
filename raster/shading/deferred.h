// Implements stage 8 of Shading::kLit, deferred shading. Each of its own stages is a function over the whole G-buffer,
// and adds one effect.
#pragma once

#include "raster/fog/fog_grid.h"
#include "raster/gbuffer/gbuffer.h"
#include "raster/geometry/geometry.h"
#include "raster/geometry/tiles.h"
#include "raster/lighting/direct_light.h"
#include "raster/screen_space/gtao.h"
#include "raster/shading/blended_layers.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace duet::raster {

/// Holds the radiance towards the viewer, split by its source. The components sum to the color of the image.
struct LightComponentImages {
    Planes3 emission;    ///< of visible emissive surfaces, and the environment as the background
    Planes3 direct;      ///< from Scene::lights
    Planes3 environment; ///< diffuse light from the environment and, with RasterSettings::indirect_light, from surfaces
    Planes3 indirect;    ///< diffuse light from surfaces, if HitShader has taken it out of `environment`
    Planes3 reflection;  ///< mirrored and refracted light of everything but Scene::lights on rough surfaces
    Planes3 shadowed;    ///< not included in the sum: the direct light that shadows remove
};

/// Holds the images of a frame. Rendering frame after frame into the same one keeps their memory.
struct DeferredFrame {
    std::optional<GBuffer> gbuffer;
    Planes3 radiance;
    DirectLight direct;
    Planes3 solid_light; ///< diffuse light of solids with subsurface scattering; empty if there are none
    GtaoImage occlusion;
    FogGrid fog;
    std::vector<std::pair<std::string, double>> seconds; ///< wall-clock time of each stage, in order

    /// Sets the size and the projection. The contents are undefined.
    void start(const Scene& scene, const ScreenProjection& projection, int width, int height);
    std::size_t memory_bytes() const {
        return (gbuffer ? gbuffer->memory_bytes() : 0) + radiance.memory_bytes() + direct.memory_bytes() +
               solid_light.memory_bytes() + occlusion.memory_bytes() + fog.memory_bytes();
    }
};

/// Holds the settings of shade_gbuffer.
struct ShadeOptions {
    float time = 0;         ///< of the shadows
    bool background = true; ///< else pixels without a surface stay black
    const FogGrid* fog = nullptr; ///< of the same view, or null to compute one
    LightComponentImages* components = nullptr; ///< without fog: receives the parts of the radiance, if any
};
/// Shades the surfaces in frame.gbuffer. frame.radiance holds what they emit, and receives the radiance towards the
/// viewer.
void shade_gbuffer(const RasterSceneData& data, const RasterSettings& settings, const ShadeOptions& options,
                   DeferredFrame& frame);

/// Computes the radiance of one sample per pixel: fills the G-buffer, shades it, and composites the blended surfaces
/// in front of it.
void shade_deferred(const SampleView& sample, DeferredFrame& frame);

} // namespace duet::raster
