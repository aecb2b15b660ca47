// The closed set of textures, and the slots by which materials refer to them.
#pragma once

#include "common/geometry/surface_point.h"
#include "common/image/image.h"

#include <cstdint>
#include <variant>
#include <vector>

namespace duet {

/// How a picture is looked up. The first two take it as it is at a point; the others average what a sample stands for
/// (SurfacePoint::duv_dx, duv_dy): as if it were round, as wide as it is long, or by its true shape.
enum class TextureFilter { kNearest, kBilinear, kTrilinear, kAnisotropic };
inline bool uses_footprint(TextureFilter filter) { return filter >= TextureFilter::kTrilinear; }

/// A picture over uv: (0, 0) is the lower left corner; repeats outside [0, 1].
struct ImageTexture {
    std::uint32_t image = 0; ///< index into TextureSet::images
    Vec2 scale{1, 1};        ///< uv are multiplied by it
    TextureFilter filter = TextureFilter::kAnisotropic;
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
    std::vector<std::vector<ImageRgb>> smaller{}; ///< of each image: smaller_versions(), where a texture filters it
};
/// Makes TextureSet::smaller.
void build_pyramids(TextureSet& set);

/// A colour, or a texture times a colour.
struct RgbSlot {
    Rgb value{1.0f};
    std::int32_t texture = -1; ///< index into TextureSet::textures, or −1: value alone
};
/// A number, or a texture's red channel times a number.
struct ScalarSlot {
    float value = 1;
    std::int32_t texture = -1; ///< index into TextureSet::textures, or −1: value alone

    ScalarSlot(float value_ = 1, std::int32_t texture_ = -1) : value(value_), texture(texture_) {}
    bool constant() const { return texture < 0; }
};
/// The colour of a texture at a point. Finite for every finite point.
Rgb evaluate_texture(const TextureSet& set, const Texture& texture, const SurfacePoint& point);

inline Rgb evaluate(const TextureSet& set, const RgbSlot& slot, const SurfacePoint& point) {
    if (slot.texture < 0) return slot.value;
    return slot.value * evaluate_texture(set, set.textures[static_cast<std::size_t>(slot.texture)], point);
}
inline float evaluate(const TextureSet& set, const ScalarSlot& slot, const SurfacePoint& point) {
    if (slot.constant()) return slot.value;
    return slot.value * evaluate_texture(set, set.textures[static_cast<std::size_t>(slot.texture)], point).r;
}

} // namespace duet
