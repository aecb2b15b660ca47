// One function a kind of texture; texture.h is what callers use.
#pragma once

#include "common/texture/texture.h"

namespace duet {

/// `smaller`: of the image, or empty: then it is not filtered.
Rgb evaluate(const ImageTexture& texture, const ImageRgb& image, const std::vector<ImageRgb>& smaller,
             const SurfacePoint& point);
Rgb evaluate(const CheckerTexture& texture, const SurfacePoint& point);
Rgb evaluate(const NoiseTexture& texture, const SurfacePoint& point);

} // namespace duet
