// What metal mirrors of what the picture shows.
#pragma once

#include "raster/light/direct.h"
#include "raster/screen/surroundings.h"

#include "common/material/material.h"

#include <optional>

namespace duet::raster {

/// Whether a material, somewhere, mirrors what the picture shows.
bool may_mirror(const Material& material);
/// Whether that is all that one of it shows: a first look at the picture knows of it but the environment.
bool is_mirror(const Material& material);

/// What a smooth or not too rough metal mirrors, in directions of its lobe: the same few for every point, each as wide
/// as the part of the lobe that it stands for.
class Mirrored {
public:
    static constexpr int kRays = 8; ///< of a pixel of rough metal

    /// `screen` has radiance. Refers to all.
    Mirrored(const PreparedData& data, const Settings& settings, const Screen& screen, const ShadingPoint& point, const MetalBsdf& bsdf);

    /// Of rough metal the lobe's mean, as the few rays find it, times all that the metal reflects: so that what they miss of
    /// the lobe, and what rays lose that come out beneath its horizon, is not lost. A part of the taps asks for a part of the
    /// rays: the mean of all parts is the whole. Empty where no ray comes out above the horizon.
    std::optional<Rgb> operator()(TapRange taps) const;

private:
    struct Sample {
        Vec3 way;
        float pdf = 0;
        Rgb weight;
    };
    Sample sample(Vec2 u) const;
    Rgb seen(const Sample& ray, int rays) const;

    Surroundings around_;
    const ShadingPoint& point_;
    const MetalBsdf& bsdf_;
    Vec3 p_;
    float width_ = 0, spread_ = 0; ///< of a pixel; radians between its mirrored ray and the next one's
};

} // namespace duet::raster
