#include "common/texture/texture.h"

#include "common/texture/texture_kinds.h"

namespace duet {

Rgb evaluate_texture(const TextureSet& set, const Texture& texture, const SurfacePoint& point) {
    if (const auto* image = std::get_if<ImageTexture>(&texture))
        return evaluate(*image, set.images[image->image], point.uv);
    if (const auto* checker = std::get_if<CheckerTexture>(&texture)) return evaluate(*checker, point);
    return evaluate(std::get<NoiseTexture>(texture), point);
}

} // namespace duet
