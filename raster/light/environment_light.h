// This header declares the reflection and refraction of the environment at a surface.
#pragma once

#include "raster/light/direct.h"
#include "raster/light/prefiltered.h"
#include "raster/prepare.h"
#include "raster/screen/screen.h"

#include <optional>

namespace duet::raster {

/// Returns whether the settings show the scene's environment.
bool shows_environment(const PreparedData& data, const Settings& settings);
/// Returns the radiance of pixels without geometry if it is the same in every direction.
std::optional<Rgb> constant_background(const PreparedData& data, const Settings& settings);

/// Computes the light reflected from the environment, with ambient occlusion where `screen` provides it.
class EnvironmentLight {
public:
    EnvironmentLight(const PreparedData& data, const Settings& settings, const ShadingPoint& point,
                     const Screen* screen)
        : data_(data), settings_(settings),
          prefiltered_(settings.prefiltered_environment ? data.prefiltered.get() : nullptr),
          point_(point), screen_(screen) {}

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
    Rgb received() const; ///< irradiance at a diffuse surface
    Vec3 mirrored() const;
    template <typename BsdfType> Rgb look_up(const BsdfType& bsdf, bool transmitted, float alpha = 0) const;

    const PreparedData& data_;
    const Settings& settings_;
    const Prefiltered* prefiltered_;
    const ShadingPoint& point_;
    const Screen* screen_;
};

} // namespace duet::raster
