// This file evaluates texture slots as reflectances, clamped to [0, 1].
#pragma once

#include "common/texture/texture.h"

namespace duet {

/// Returns a slot's color at a point, clamped to [0, 1], so that a surface with a bright texture cannot reflect more
/// light than it receives.
inline Rgb evaluate_reflectance(const TextureSet& textures, const RgbSlot& slot, const SurfacePoint& point) {
    const Rgb c = evaluate(textures, slot, point);
    return {clamp(c.r, 0.0f, 1.0f), clamp(c.g, 0.0f, 1.0f), clamp(c.b, 0.0f, 1.0f)};
}

/// Returns a slot's scalar value at a point, clamped to [0, 1].
inline float evaluate_clamped(const TextureSet& textures, const ScalarSlot& slot, const SurfacePoint& point) {
    return clamp(evaluate(textures, slot, point), 0.0f, 1.0f);
}

} // namespace duet
