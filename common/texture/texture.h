// This file defines the closed set of textures, and the slots by which materials refer to them.
#pragma once

#include "common/geometry/surface_point.h"
#include "common/image/image.h"
#include "common/system/shared_list.h"

#include <cstdint>
#include <variant>
#include <vector>

namespace duet {

/// TextureFilter selects how an image is sampled. The first two filters sample at a point. The others average over
/// the sample's footprint (SurfacePoint::duv_dx, duv_dy): trilinear as if it were a circle as wide as the footprint
/// is long, and anisotropic by its true shape.
enum class TextureFilter { kNearest, kBilinear, kTrilinear, kAnisotropic };
/// Returns whether the filter averages over the sample's footprint.
inline bool uses_footprint(TextureFilter filter) { return filter >= TextureFilter::kTrilinear; }

/// ImageTexture is an image over uv, with (0, 0) at the lower left corner. It repeats outside [0, 1].
struct ImageTexture {
    std::uint32_t image = 0; ///< index into TextureSet::images
    Vec2 scale{1, 1};        ///< factor of uv
    TextureFilter filter = TextureFilter::kAnisotropic;
};
/// CheckerTexture has two colors, in squares of side 1/scale over uv or in cubes of side 1/scale over object space.
struct CheckerTexture {
    Rgb even{0.9f}, odd{0.1f};
    float scale = 1;
    bool solid = false;
};
/// NoiseTexture is gradient noise in object space, summed over octaves (Perlin 2002), and interpolates between two
/// colors.
struct NoiseTexture {
    Rgb low{0.0f}, high{1.0f};
    float scale = 1;     ///< cycles per meter of object space
    int octaves = 4;     ///< 1 to 16, each with half the amplitude and twice the frequency of the last
    bool marble = false; ///< sin(scale·z + 10·turbulence), as in Ray Tracing: The Next Week §5
};
using Texture = std::variant<ImageTexture, CheckerTexture, NoiseTexture>;

/// TextureSet holds all textures of a scene and the images that they share, in linear RGB. Copies share the images.
struct TextureSet {
    std::vector<Texture> textures;
    SharedList<ImageRgb> images;
    /// These are the mip levels of each image, from make_mip_levels(). They are empty where no texture filters the
    /// image.
    SharedList<std::vector<ImageRgb>> mip_levels{};
};
/// Builds TextureSet::mip_levels.
void build_mipmaps(TextureSet& set);

/// An RgbSlot is a color, or a texture times a color.
struct RgbSlot {
    Rgb value{1.0f};
    std::int32_t texture = -1; ///< index into TextureSet::textures, or −1: value alone
};
/// A ScalarSlot is a number, or a texture's red channel times a number.
struct ScalarSlot {
    float value = 1;
    std::int32_t texture = -1; ///< index into TextureSet::textures, or −1: value alone

    ScalarSlot(float value_ = 1, std::int32_t texture_ = -1) : value(value_), texture(texture_) {}
    bool constant() const { return texture < 0; }
};
/// Returns the color of a texture at a point. It is finite for every finite point.
Rgb evaluate_texture(const TextureSet& set, const Texture& texture, const SurfacePoint& point);

inline Rgb evaluate(const TextureSet& set, const RgbSlot& slot, const SurfacePoint& point) {
    if (slot.texture < 0) return slot.value;
    return slot.value * evaluate_texture(set, set.textures[static_cast<std::size_t>(slot.texture)], point);
}
inline float evaluate(const TextureSet& set, const ScalarSlot& slot, const SurfacePoint& point) {
    if (slot.constant()) return slot.value;
    return slot.value * evaluate_texture(set, set.textures[static_cast<std::size_t>(slot.texture)], point).r;
}

// Each kind of texture is implemented in a file of its own.

/// Returns the texture's color at a point. `mip_levels` holds the image's mip levels. Where it is empty, the image is
/// sampled bilinearly, or at the nearest texel if the filter says so.
Rgb evaluate(const ImageTexture& texture, const ImageRgb& image, const std::vector<ImageRgb>& mip_levels,
             const SurfacePoint& point);
Rgb evaluate(const CheckerTexture& texture, const SurfacePoint& point);
Rgb evaluate(const NoiseTexture& texture, const SurfacePoint& point);

} // namespace duet
