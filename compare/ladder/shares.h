// This file attributes the difference between the pipelines to causes: each rung, and noise.
#pragma once

#include "compare/ladder/evaluate_ladder.h"

namespace duet::compare {

/// The causes are one per rung, in the order of the rungs, and then the path tracer's noise.
inline constexpr std::size_t kNoise = kRungCount, kCauseCount = kRungCount + 1;
using Causes = std::array<double, kCauseCount>;

/// Holds the shares of the causes in the difference. Let D = I₀ − I₇ be the whole difference, Δ_k = I_{k−1} − I_k the
/// change at rung k, both from the halves A and B of the samples, and ⟨,⟩ the sum of products over all pixels
/// and channels. The share of rung k is
///
///   ½ (⟨Δ_kᴬ, Dᴮ⟩ + ⟨Δ_kᴮ, Dᴬ⟩) / ⟨D, D⟩,   D = (Dᴬ + Dᴮ)/2,
///
/// which is free of the noise that Δ_k and D have in common if they use the same samples. The share of noise is
/// ‖(Dᴬ − Dᴮ)/2‖² / ⟨D, D⟩. The Δ_k add up to D, and ⟨D, D⟩ = ⟨Dᴬ, Dᴮ⟩ + ‖(Dᴬ −
/// Dᴮ)/2‖², so all shares add up to 1 without normalization. A share is negative if its change compensates for
/// that of another rung: two approximations whose errors cancel.
struct Shares {
    Causes share{};
    double sum = 0; ///< sum of all shares: 1 up to rounding
    double rms = 0; ///< RMS of D over pixels and channels
    /// This is true if D, the difference I₀ − I₇, is no more than rounding error: 10⁻⁵ of the image's root mean square.
    /// Then there is nothing to attribute, and all shares are 0.
    bool negligible = false;
};
/// Returns the shares of the causes in the difference of the images.
Shares shares(const LadderImages& images);

/// Returns, for one pixel, the numerators of the shares in Shares. They add up to |D|² at that pixel.
Causes pixel_causes(const LadderImages& images, std::size_t pixel);

/// A CauseMap shows visible differences and their main causes. The causes of a single pixel are noisy, so the main
/// cause is the largest sum over the pixel and its eight neighbors.
struct CauseMap {
    Image<std::uint8_t> cause; ///< index of the main cause
    Image<std::uint8_t> steps; ///< |I₀ − I₇| in 8-bit sRGB steps, maximum over the channels
    std::array<double, kCauseCount> pixels{}; ///< per cause: fraction of the visible pixels; all 0 if none is visible
    double visible = 0;                       ///< fraction of all pixels that differ by kVisibleSteps or more
};
inline constexpr int kVisibleSteps = 3;
/// Returns the map of the visible differences.
CauseMap map_causes(const LadderImages& images);

/// Returns the color of a cause (sRGB-encoded, 0 to 255), from Okabe and Ito's palette for all kinds of color vision.
std::array<int, 3> cause_color(std::size_t cause);
/// Returns the map as a linear image. Each pixel has the color of its cause; smaller differences are darker.
ImageRgb cause_image(const CauseMap& map);

} // namespace duet::compare
