// This file declares the images of the ladder. They lead from the rasterizer's image to the path tracer's by replacing
// one approximation after the other with the traced quantity.
#pragma once

#include "compare/ladder/rungs.h"

namespace duet::compare {

/// These are the images of all ladder stages. I₀ is the rasterizer's image. I_k is the same image with its first k
/// approximations replaced. The last one is path-traced. All except I₀ are traced twice, with independent halves of the
/// samples, to estimate the effect of noise.
struct LadderImages {
    ImageRgb first;                                         ///< I₀
    std::array<std::array<ImageRgb, kRungCount>, 2> halves; ///< halves[h][k − 1] is I_k of half h
    std::int64_t invalid_samples = 0;                       ///< samples with NaN, infinite or negative values, which
                                                            ///< are discarded

    /// Returns I_k, k in [0, kRungCount], from all samples.
    ImageRgb image(std::size_t k) const;
};

/// Renders the images of all ladder stages. Each camera sample is shaded in two ways. The rasterizer's shading yields
/// the components of raster::LightComponentImages: emission e, direct d, environment v, indirect g, reflection r, and
/// s, the light that shadows remove from d. The path tracer yields those of raytrace::LightComponents: emission E,
/// direct D, unshadowed U, environment V, reflection R, indirect G. The stages are the means, over the path tracer's
/// camera samples, of
///
///   I₁ = e + d + v + g + r at the traced hits      I₄ = E + D + v + g + r
///   I₂ = the same at the traced surfaces           I₅ = E + D + V + g + r
///   I₃ = E + U − s + v + g + r                     I₆ = E + D + V + g + R
///                                                  I₇ = E + D + V + G + R, the path tracer's image.
///
/// The rasterizer shades the hits of one sample of all pixels together, since its effects look at other pixels. It
/// takes the lens center as their viewer, at the time the shutter opens (raster::HitShader).
///
/// `first` is I₀. If `control` is stopped, returns what is finished.
LadderImages evaluate_ladder(ImageRgb first, const PreparedPair& pair, const View& view, Control& control);

} // namespace duet::compare
