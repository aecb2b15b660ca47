#include "raster/lighting/background.h"

#include <algorithm>
#include <bit>

namespace duet::raster {

bool shows_environment(const RasterSceneData& data, const RasterSettings& settings) {
    return settings.environment && (data.scene.needs.environment || !settings.skips.environment);
}

bool is_dark(const RasterSceneData& data, const RasterSettings& settings) {
    return data.scene.lights.empty() && !shows_environment(data, settings) && !data.any_emits;
}

void draw_background(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                     Planes3& radiance) {
    if (settings.shading != Shading::kLit || !settings.components.emission || !shows_environment(data, settings))
        return;
    const auto* constant = std::get_if<ConstantEnvironment>(&data.scene.environment);
    for_each_batch(gbuffer.width(), gbuffer.height(), settings.threads, [&](int x, int y) {
        std::uint32_t open = ~lane_bits(gbuffer.visible(x, y)) & ((1u << Floats::size) - 1);
        for (; open != 0; open &= open - 1) {
            const int column = x + std::countr_zero(open);
            if (column >= gbuffer.width()) break;
            const auto direction = [&] {
                if (!gbuffer.position.empty()) return normalize(gbuffer.position.vector_at(column, y));
                return -gbuffer.projection.to_viewer(gbuffer.projection.point(
                    static_cast<float>(column), static_cast<float>(y), gbuffer.projection.near()));
            };
            radiance.set_at(column, y,
                            constant != nullptr ? constant->radiance
                                                : duet::radiance(data.scene.environment, direction()));
        }
    });
}

} // namespace duet::raster
