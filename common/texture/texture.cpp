#include "common/texture/texture.h"

#include "common/texture/mipmap.h"

namespace duet {

void build_mipmaps(TextureSet& set) {
    set.mip_levels.assign(set.images.size(), {});
    for (const Texture& texture : set.textures) {
        const auto* image = std::get_if<ImageTexture>(&texture);
        if (image == nullptr || !uses_footprint(image->filter) || !set.mip_levels[image->image].empty()) continue;
        set.mip_levels[image->image] = make_mip_levels(set.images[image->image]);
    }
}

Rgb evaluate_texture(const TextureSet& set, const Texture& texture, const SurfacePoint& point) {
    if (const auto* image = std::get_if<ImageTexture>(&texture)) {
        static const std::vector<ImageRgb> kNone;
        return evaluate(*image, set.images[image->image], set.mip_levels.empty() ? kNone : set.mip_levels[image->image],
                        point);
    }
    if (const auto* checker = std::get_if<CheckerTexture>(&texture)) return evaluate(*checker, point);
    return evaluate(std::get<NoiseTexture>(texture), point);
}

} // namespace duet
