// Samples image textures for one batch of texture coordinates with SIMD.
#pragma once

#include "common/texture/texture.h"
#include "raster/geometry/packet.h"

#include <array>
#include <vector>

namespace duet::raster {

/// Stores the texture coordinates and footprints of one batch of samples: SurfacePoint's uv, duv_dx and duv_dy.
struct TextureCoordinates {
    Vec2T<Floats> uv, duv_dx, duv_dy;
    std::uint32_t lanes = 0; ///< one bit per lane that is sampled
};

/// Refers to an image and its mipmap levels.
class TextureSampler {
public:
    /// Creates the empty object of an unfiltered image.
    TextureSampler() = default;
    /// References an image and its mipmap levels, which must outlive this object. `smaller` must not be empty.
    /// There may be up to 16 levels in all, which every image within kMaxImageSide satisfies.
    TextureSampler(const ImageRgb& image, const std::vector<ImageRgb>& smaller);
    bool empty() const { return levels_ == 0; }

    /// Returns the same as evaluate_texture() for each lane, for a texture of this image that uses_footprint(); 0
    /// in inactive lanes.
    RgbT<Floats> sample(const ImageTexture& texture, const TextureCoordinates& coordinates) const;

private:
    class TexelQuads;

    std::int32_t levels_ = 0;
    std::array<const float*, kPacketSize> level_texels_{}; ///< per level, with three floats per texel
    PacketOf<float> widths_, heights_;
};

/// Returns the TextureSampler of all images of a scene. They are empty for images that no texture filters.
std::vector<TextureSampler> texture_samplers(const TextureSet& textures);

} // namespace duet::raster
