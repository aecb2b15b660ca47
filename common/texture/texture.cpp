#include "common/texture/texture.h"

#include "common/texture/pyramid.h"
#include "common/texture/texture_kinds.h"

namespace duet {

void build_pyramids(TextureSet& set) {
    set.smaller.assign(set.images.size(), {});
    for (const Texture& texture : set.textures) {
        const auto* image = std::get_if<ImageTexture>(&texture);
        if (image == nullptr || !uses_footprint(image->filter) || !set.smaller[image->image].empty()) continue;
        set.smaller[image->image] = smaller_versions(set.images[image->image]);
    }
}

Rgb evaluate_texture(const TextureSet& set, const Texture& texture, const SurfacePoint& point) {
    if (const auto* image = std::get_if<ImageTexture>(&texture)) {
        static const std::vector<ImageRgb> kNone;
        return evaluate(*image, set.images[image->image], set.smaller.empty() ? kNone : set.smaller[image->image],
                        point);
    }
    if (const auto* checker = std::get_if<CheckerTexture>(&texture)) return evaluate(*checker, point);
    return evaluate(std::get<NoiseTexture>(texture), point);
}

} // namespace duet
