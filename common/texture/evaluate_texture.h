// This file declares the evaluation of each kind of texture. Callers use texture.h instead.
#pragma once

#include "common/texture/texture.h"

namespace duet {

/// Returns the texture's color at a point. `mip_levels` holds the image's mip levels. Where it is empty, the image is
/// sampled bilinearly, or at the nearest texel if the filter says so.
Rgb evaluate(const ImageTexture& texture, const ImageRgb& image, const std::vector<ImageRgb>& mip_levels,
             const SurfacePoint& point);
Rgb evaluate(const CheckerTexture& texture, const SurfacePoint& point);
Rgb evaluate(const NoiseTexture& texture, const SurfacePoint& point);

} // namespace duet
