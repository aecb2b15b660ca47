// Metals by name, from published measurements of their complex index of refraction.
#pragma once

#include "common/image/rgb.h"

#include <optional>
#include <span>
#include <string_view>

namespace duet {

/// What the three channels of a picture see of a metal. Its reflectance by wavelength is carried over to linear Rec. 709
/// (daylight D65, so that a perfect mirror is white); n and k are, channel by channel, those whose Fresnel curve goes
/// exactly through that reflectance at normal incidence and as near as possible to it at all other angles.
struct Conductor {
    Rgb n, k;    ///< complex index n + ik; n = 0: none
    Rgb normal;  ///< reflectance at normal incidence, in [0, 1]
    Rgb average; ///< of light from everywhere: 2∫ F(μ) μ dμ

    bool exists() const { return n.r > 0; }
};

/// The names that are known, in alphabetical order: "aluminium", "chromium" …
std::span<const std::string_view> conductor_names();
/// One of them; nothing for any other name.
std::optional<Conductor> find_conductor(std::string_view name);

/// The reflectance by the measured spectrum itself, as linear Rec. 709, of a known metal at an angle of incidence's
/// cosine in [0, 1]: what Conductor's curve stands for. For tests, and to see how near it is.
Rgbd spectral_reflectance(std::string_view name, double cosine);

} // namespace duet
