// This header declares the reflection and refraction of the environment at a surface.
#pragma once

#include "raster/gbuffer/screen_gbuffer.h"
#include "raster/lighting/direct_lighting.h"
#include "raster/lighting/prefiltered_environment.h"
#include "raster/raster_scene.h"

#include <optional>

namespace duet::raster {

/// Returns whether the settings show the scene's environment.
bool shows_environment(const RasterSceneData& data, const RasterSettings& settings);
/// Returns the radiance of pixels without geometry if it is the same in every direction.
std::optional<Rgb> constant_background(const RasterSceneData& data, const RasterSettings& settings);

/// Computes the light reflected from the environment, with ambient occlusion where `gbuffer` provides it.
class EnvironmentLight {
public:
    EnvironmentLight(const RasterSceneData& data, const RasterSettings& settings, const ShadingPoint& point,
                     const ScreenGBuffer* gbuffer)
        : data_(data), settings_(settings),
          prefiltered_(settings.prefiltered_environment ? data.prefiltered.get() : nullptr), point_(point),
          gbuffer_(gbuffer) {}

    Rgb operator()(const DiffuseBsdf& bsdf) const;
    /// Rough metal uses the split sum; without a prefiltered environment it is treated as smooth.
    Rgb operator()(const MetalBsdf& bsdf) const;
    Rgb operator()(const RoughDiffuseBsdf& bsdf) const;
    /// Returns the mirror reflection and the transmission through this interface alone: refracted once, tinted as by
    /// two crossings, and weighted by the Fresnel equations.
    Rgb operator()(const DielectricBsdf& bsdf) const;
    /// A rough dielectric uses the smooth one's directions with the prefiltered environment.
    Rgb operator()(const RoughDielectricBsdf& bsdf) const;
    /// Returns the mirror reflection and the undeviated transmission.
    Rgb operator()(const ThinDielectricBsdf& bsdf) const;
    Rgb operator()(const LayeredBsdf&) const { return {}; } // each layer is shaded separately

private:
    Rgb incident_irradiance() const; ///< irradiance at a diffuse surface
    Vec3 mirror_direction() const;
    template <typename BsdfType> Rgb sample_environment(const BsdfType& bsdf, bool transmitted, float alpha = 0) const;

    const RasterSceneData& data_;
    const RasterSettings& settings_;
    const Prefiltered* prefiltered_;
    const ShadingPoint& point_;
    const ScreenGBuffer* gbuffer_;
};

} // namespace duet::raster
