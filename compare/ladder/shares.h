// Where the difference comes from: the share of each rung, and of noise.
#pragma once

#include "compare/ladder/climb.h"

namespace duet::compare {

/// The causes: one a rung, in the order of the rungs, then the path tracer's noise.
inline constexpr std::size_t kNoise = kRungCount, kCauseCount = kRungCount + 1;
using Causes = std::array<double, kCauseCount>;

/// Let D = I₀ − I₇ be the whole difference, Δ_k = I_{k−1} − I_k what rung k changes, each of both halves A and B of the
/// samples, and ⟨,⟩ the sum of products over all pixels and channels. The share of rung k is
///
///   ½ (⟨Δ_kᴬ, Dᴮ⟩ + ⟨Δ_kᴮ, Dᴬ⟩) / ⟨D, D⟩,   D = (Dᴬ + Dᴮ)/2,
///
/// free of the noise that Δ_k and D of the same samples have in common; that of noise ‖(Dᴬ − Dᴮ)/2‖² / ⟨D, D⟩. Since
/// the Δ_k add up to D and ⟨D, D⟩ = ⟨Dᴬ, Dᴮ⟩ + ‖(Dᴬ − Dᴮ)/2‖², all shares add up to 1, without being made to. A
/// share is negative where its change makes up for another's: two approximations that cancel.
struct Shares {
    Causes share{};
    double sum = 0; ///< of all shares: 1 but for rounding
    double rms = 0; ///< of D, over pixels and channels
    /// Whether D is no more than rounding, 10⁻⁵ of the picture's root mean square: then there is nothing to share out,
    /// and all shares are 0.
    bool none = false;
};
Shares shares(const LadderPictures& pictures);

/// The same products of one pixel alone, not divided: they add up to |D|² there.
Causes pixel_causes(const LadderPictures& pictures, std::size_t pixel);

/// Where something is to be seen, and what causes most of it. A single pixel's causes are noisy: the largest is that
/// of the pixel and its neighbours, nine together.
struct CauseMap {
    Image<std::uint8_t> cause; ///< its index
    Image<std::uint8_t> steps; ///< |I₀ − I₇| in steps of the 8-bit sRGB pictures, largest over the channels
    std::array<double, kCauseCount> pixels{}; ///< by cause: part of the visible pixels; all 0 where none is visible
    double visible = 0;                       ///< part of all pixels that differ by kVisibleSteps or more
};
inline constexpr int kVisibleSteps = 3;
CauseMap map_causes(const LadderPictures& pictures);

/// The colour of a cause (sRGB-encoded, 0 to 255): Okabe and Ito's palette, told apart by all kinds of colour vision.
std::array<int, 3> cause_color(std::size_t cause);
/// The map as a picture, linear: each pixel in the colour of its cause, the darker the less is to be seen there.
ImageRgb cause_picture(const CauseMap& map);

} // namespace duet::compare
