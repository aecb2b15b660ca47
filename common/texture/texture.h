// The closed set of textures, and the slots by which materials refer to them.
#pragma once

#include "common/geometry/surface_point.h"
#include "common/image/image.h"

#include <cstdint>
#include <variant>
#include <vector>

namespace duet {

/// A picture over uv: (0, 0) is the lower left corner; repeats outside [0, 1]; bilinear, or nearest.
struct ImageTexture {
    std::uint32_t image = 0; ///< index into TextureSet::images
    Vec2 scale{1, 1};        ///< uv are multiplied by it
    bool bilinear = true;
};
/// Two colours in squares of side 1/scale over uv, or in cubes of side 1/scale over object space.
struct CheckerTexture {
    Rgb even{0.9f}, odd{0.1f};
    float scale = 1;
    bool solid = false;
};
/// Gradient noise summed over octaves, in object space (Perlin 2002), between two colours.
struct NoiseTexture {
    Rgb low{0.0f}, high{1.0f};
    float scale = 1;     ///< cycles a metre of object space
    int octaves = 4;     ///< 1 to 16, each of half the amplitude and twice the frequency
    bool marble = false; ///< sin(scale·z + 10·turbulence), as in Ray Tracing: The Next Week §5
};
using Texture = std::variant<ImageTexture, CheckerTexture, NoiseTexture>;

/// All textures of a scene, and the images they share, in linear RGB.
struct TextureSet {
    std::vector<Texture> textures;
    std::vector<ImageRgb> images;
};

/// A colour, or a texture times a colour.
struct RgbSlot {
    Rgb value{1.0f};
    std::int32_t texture = -1; ///< index into TextureSet::textures, or −1: value alone
};
/// The colour of a texture at a point. Finite for every finite point.
Rgb evaluate_texture(const TextureSet& set, const Texture& texture, const SurfacePoint& point);

inline Rgb evaluate(const TextureSet& set, const RgbSlot& slot, const SurfacePoint& point) {
    if (slot.texture < 0) return slot.value;
    return slot.value * evaluate_texture(set, set.textures[static_cast<std::size_t>(slot.texture)], point);
}

} // namespace duet
