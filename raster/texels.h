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

/// An image and its smaller versions, each texel in one piece of memory that can be loaded at once.
class Texels {
public:
    /// Of a picture that no texture filters there is nothing.
    Texels() = default;
    Texels(const ImageRgb& image, const std::vector<ImageRgb>& smaller);
    bool empty() const { return levels_.empty(); }
    std::size_t memory_bytes() const;

    /// What evaluate_texture() says at each place, of a texture of this image that uses_footprint().
    RgbT<Floats> look_up(const ImageTexture& texture, const TexturePlaces& places) const;

private:
    struct alignas(16) Texel {
        float r = 0, g = 0, b = 0, unused = 0;
    };
    struct Level {
        int width = 0, height = 0;
        std::vector<Texel> texels;

        explicit Level(const ImageRgb& image);
    };
    struct Probes;
    struct LevelLanes;
    void find(const ImageTexture& texture, const TexturePlaces& places, Probes& probes) const;

    std::vector<Level> levels_;
};

/// Of each image of a scene.
std::vector<Texels> pack_texels(const TextureSet& textures);

} // namespace duet::raster
