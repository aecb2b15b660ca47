// What a surface reflects of the environment, and what glass shows of it alone.
#pragma once

#include "raster/light/direct.h"
#include "raster/light/prefiltered.h"
#include "raster/prepare.h"
#include "raster/screen/screen.h"

#include <optional>

namespace duet::raster {

/// Whether the settings show the scene's environment.
bool shows_environment(const PreparedData& data, const Settings& settings);
/// What is seen where nothing is, if it is the same everywhere.
std::optional<Rgb> constant_background(const PreparedData& data, const Settings& settings);

/// Light from the environment, occluded as far as that is known.
class EnvironmentLight {
public:
    EnvironmentLight(const PreparedData& data, const Settings& settings, const ShadingPoint& point, const Screen* screen)
        : data_(data), settings_(settings), prefiltered_(settings.prefiltered_environment ? data.prefiltered.get() : nullptr),
          point_(point), screen_(screen) {}

    Rgb operator()(const DiffuseBsdf& bsdf) const;
    /// Of a rough one by the split sum; else what a smooth metal reflects.
    Rgb operator()(const MetalBsdf& bsdf) const;
    Rgb operator()(const RoughDiffuseBsdf& bsdf) const;
    /// The mirror image, and what is seen through this side of the glass alone: refracted once, tinted as by two
    /// crossings; weighed by Fresnel's equations.
    Rgb operator()(const DielectricBsdf& bsdf) const;
    /// The same, blurred.
    Rgb operator()(const RoughDielectricBsdf& bsdf) const;
    /// The mirror image, and what is straight behind.
    Rgb operator()(const ThinDielectricBsdf& bsdf) const;
    Rgb operator()(const LayeredBsdf&) const { return {}; } // its layers are shaded each by itself

private:
    Rgb received() const; ///< What arrives at a diffuse surface.
    Vec3 mirrored() const;
    template <typename BsdfType> Rgb look_up(const BsdfType& bsdf, bool transmitted, float alpha = 0) const;

    const PreparedData& data_;
    const Settings& settings_;
    const Prefiltered* prefiltered_;
    const ShadingPoint& point_;
    const Screen* screen_;
};

} // namespace duet::raster
