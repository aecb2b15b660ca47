#include "common/texture/texture.h"

#include "common/texture/mipmap.h"

namespace duet {

void build_mipmaps(TextureSet& set) {
    std::vector<bool> filtered(set.images.size());
    for (const Texture& texture : set.textures)
        if (const auto* image = std::get_if<ImageTexture>(&texture))
            if (uses_footprint(image->filter)) filtered[image->image] = true;
    set.mip_levels = {};
    for (std::size_t i = 0; i < filtered.size(); ++i)
        set.mip_levels.push_back(filtered[i] ? make_mip_levels(set.images[i]) : std::vector<ImageRgb>());
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
