// Implements stage 8 of Shading::kLit, deferred shading. Each of its own stages is a function over the whole G-buffer,
// and adds one effect.
#pragma once

#include "raster/fog/fog_grid.h"
#include "raster/gbuffer/gbuffer_pass.h"
#include "raster/lighting/direct_light.h"
#include "raster/screen_space/gtao.h"

#include <optional>
#include <string>
#include <vector>

namespace duet::raster {

/// Holds the radiance toward the viewer, split by its source. The components sum to the color of the image.
struct LightComponentImages {
    Planes3 emission;    ///< from visible emissive surfaces, and from the environment as background
    Planes3 direct;      ///< reflected light of Scene::lights
    Planes3 environment; ///< diffuse light of the environment and, with indirect_light, of surfaces
    Planes3 indirect;    ///< diffuse light of surfaces, if HitShader has separated it from `environment`
    Planes3 reflection;  ///< mirrored and refracted light, except that of Scene::lights on rough surfaces
    Planes3 shadowed;    ///< direct light that shadows remove; not included in the sum
};

/// Holds the images of a frame. If successive frames are rendered into the same object, its memory is reused.
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
    float time = 0;         ///< time of the shadow maps
    bool background = true; ///< false: pixels without a surface stay black
    const FogGrid* fog = nullptr; ///< fog of the same view, or null to compute it
    LightComponentImages* components = nullptr; ///< receives the components without fog; may be null
};
/// Shades the surfaces in frame.gbuffer. On entry, frame.radiance holds the radiance that they emit; on return, the
/// radiance toward the viewer.
void shade_gbuffer(const RasterSceneData& data, const RasterSettings& settings, const ShadeOptions& options,
                   DeferredFrame& frame);

/// Computes the radiance of one sample per pixel: fills the G-buffer, shades it, and composites the blended surfaces
/// in front of it.
void shade_deferred(const SampleView& sample, DeferredFrame& frame);

} // namespace duet::raster
