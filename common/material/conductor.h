// This file provides metals by name, from published measurements of their complex index of refraction.
#pragma once

#include "common/image/rgb.h"

#include <optional>
#include <span>
#include <string_view>

namespace duet {

/// A Conductor is an RGB approximation of a metal. Its spectral reflectance is converted to linear Rec. 709 under
/// daylight D65, so that a perfect mirror is white. In each channel n and k are chosen so that the Fresnel curve
/// matches that reflectance exactly at normal incidence, and as closely as possible at all other angles.
struct Conductor {
    Rgb n, k;    ///< complex index n + ik; n = 0: no conductor
    Rgb f0;      ///< reflectance at normal incidence, in [0, 1]
    Rgb average_fresnel; ///< mean reflectance over the hemisphere: 2∫ F(μ) μ dμ

    bool valid() const { return n.r > 0; }
};

/// Returns the names of all known metals in alphabetical order: "aluminium", "chromium" and so on.
std::span<const std::string_view> conductor_names();
/// Returns the metal of that name, or nothing for an unknown name.
std::optional<Conductor> find_conductor(std::string_view name);

/// Returns the reflectance computed from the measured spectrum, as linear Rec. 709. `cosine` is that of the angle of
/// incidence, in [0, 1]. Returns black for an unknown name. Conductor approximates this function; tests measure the
/// difference.
Rgbd spectral_reflectance(std::string_view name, double cosine);

} // namespace duet
