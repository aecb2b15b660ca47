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
    std::array<StripOf<float>, 2> uv, duv_dx, duv_dy;
};

/// An image and its smaller versions, each texel in one piece of memory that can be loaded at once. Each version repeats its
/// first column beyond its last one and its bottom row above its top one, as it does over uv: so the four texels around a
/// place always lie beside each other.
class Texels {
public:
    /// Of a picture that is not asked for there is nothing.
    Texels() = default;
    /// `smaller`: not empty; up to 16 sizes in all, as any image that is read has (kMaxImageSide).
    Texels(const ImageRgb& image, const std::vector<ImageRgb>& smaller);
    bool empty() const { return texels_.empty(); }
    std::size_t memory_bytes() const { return texels_.size() * sizeof(Texel); }

    /// What evaluate_texture() says at each place, of a texture of this image that uses_footprint().
    RgbT<Floats> look_up(const ImageTexture& texture, const TexturePlaces& places) const;

private:
    struct alignas(16) Texel {
        float r = 0, g = 0, b = 0, unused = 0;
    };
    struct Probes;
    struct LevelLanes;
    void add(const ImageRgb& image);
    void find(const ImageTexture& texture, const TexturePlaces& places, Probes& probes) const;

    std::int32_t levels_ = 0;
    StripOf<float> widths_, heights_; ///< of each
    StripOf<std::int32_t> firsts_;    ///< number of its first texel
    std::vector<Texel> texels_;       ///< of one after the other, row by row
};

/// Of those images of a scene that are wanted and that a texture filters.
std::vector<Texels> pack_texels(const TextureSet& textures, const std::vector<std::uint8_t>& wanted, int threads);

} // namespace duet::raster
