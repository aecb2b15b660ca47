// Pictures as strips of samples look them up: many places side by side.
#pragma once

#include "common/texture/texture.h"
#include "raster/lanes.h"

#include <array>
#include <vector>

namespace duet::raster {

/// Where as many samples as a batch of floats has lanes look a texture up, and what each stands for: SurfacePoint's uv, and
/// duv_dx and duv_dy.
struct TexturePlaces {
    Vec2T<Floats> uv, duv_dx, duv_dy;
    std::uint32_t lanes = 0; ///< a bit for each that looks
};

/// Where an image and its smaller versions lie.
class Texels {
public:
    /// Of a picture that is not filtered there is nothing.
    Texels() = default;
    /// `smaller`: not empty; up to 16 sizes in all, as any image that is read has (kMaxImageSide). Both stay where they are.
    Texels(const ImageRgb& image, const std::vector<ImageRgb>& smaller);
    bool empty() const { return levels_ == 0; }

    /// What evaluate_texture() says at each place, of a texture of this image that uses_footprint(); 0 in lanes that don't look.
    RgbT<Floats> look_up(const ImageTexture& texture, const TexturePlaces& places) const;

private:
    class Quartets;

    std::int32_t levels_ = 0;
    std::array<const float*, kStrip> numbers_{}; ///< of each, three a texel
    StripOf<float> widths_, heights_;
};

/// Of those images of a scene that a texture filters.
std::vector<Texels> texels_of(const TextureSet& textures);

} // namespace duet::raster
