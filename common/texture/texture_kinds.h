// One function a kind of texture; texture.h is what callers use.
#pragma once

#include "common/texture/texture.h"

namespace duet {

Rgb evaluate(const ImageTexture& texture, const ImageRgb& image, Vec2 uv);
Rgb evaluate(const CheckerTexture& texture, const SurfacePoint& point);
Rgb evaluate(const NoiseTexture& texture, const SurfacePoint& point);

} // namespace duet
