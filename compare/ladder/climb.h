// The pictures of the ladder, from the rasterizer's to the path tracer's, one approximation after the other replaced by
// the traced quantity.
#pragma once

#include "compare/ladder/rungs.h"

namespace duet::compare {

/// I₀ is the rasterizer's picture; I_k the same with its first k approximations replaced; the last is path-traced.
/// All but I₀ are traced twice, by independent halves of the samples, for what noise alone does to them.
struct LadderPictures {
    ImageRgb first;                                         ///< I₀
    std::array<std::array<ImageRgb, kRungCount>, 2> halves; ///< halves[h][k − 1] is I_k of half h
    std::int64_t invalid_samples = 0;                       ///< NaN, infinite or negative: dropped

    /// I_k, k in [0, kRungCount], of all samples.
    ImageRgb picture(std::size_t k) const;
};

/// With the parts of the light of one camera sample as the rasterizer shades it (raster::LightParts: e, d, v, r, and s,
/// what its shadows take from d) and as
/// the path tracer finds it (raytrace::LightParts: emission E, direct D, unshadowed U, environment V, reflection R,
/// indirect G), the means over the path tracer's camera samples are
///
///   I₁ = e + d + v + r at the traced hits      I₄ = E + D + v + r
///   I₂ = the same at the traced surfaces       I₅ = E + D + V + r
///   I₃ = E + U − s + v + r                     I₆ = E + D + V + R
///                                              I₇ = E + D + V + R + G, the path tracer's picture.
///
/// What the rasterizer knows of reflections and of the environment's occlusion is part of its r and v. Effects in screen
/// space look at the depths seen through the lens's centre as the shutter opens.
///
/// `first` is I₀. Stopped by `control`, it returns what is finished, the rest black.
LadderPictures climb(ImageRgb first, const PreparedPair& pair, const View& view, Control& control);

} // namespace duet::compare
