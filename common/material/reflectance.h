// Colours that say which part of the light survives.
#pragma once

#include "common/texture/texture.h"

namespace duet {

/// A slot's colour at a point, clamped to [0, 1]: a bright texture must not make a surface that reflects more light
/// than it receives.
inline Rgb evaluate_reflectance(const TextureSet& textures, const RgbSlot& slot, const SurfacePoint& point) {
    const Rgb c = evaluate(textures, slot, point);
    return {clamp(c.r, 0.0f, 1.0f), clamp(c.g, 0.0f, 1.0f), clamp(c.b, 0.0f, 1.0f)};
}

/// A slot's number at a point, clamped to [0, 1] likewise.
inline float evaluate_unit(const TextureSet& textures, const ScalarSlot& slot, const SurfacePoint& point) {
    return clamp(evaluate(textures, slot, point), 0.0f, 1.0f);
}

} // namespace duet
