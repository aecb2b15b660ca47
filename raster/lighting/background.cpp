#include "raster/lighting/background.h"

#include "raster/lighting/environment_light.h"

#include <bit>

namespace duet::raster {

void draw_background(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                     Planes3& radiance) {
    const std::optional<Rgb> constant = constant_background(data, settings);
    if (constant && is_black(*constant)) return;
    for_each_batch(gbuffer.width(), gbuffer.height(), settings.threads, [&](int x, int y) {
        std::uint32_t open = ~lane_bits(gbuffer.visible(x, y)) & ((1u << Floats::size) - 1);
        for (; open != 0; open &= open - 1) {
            const int column = x + std::countr_zero(open);
            if (column >= gbuffer.width()) break;
            const auto direction = [&] {
                return -gbuffer.projection.to_viewer(gbuffer.projection.point(
                    static_cast<float>(column), static_cast<float>(y), gbuffer.projection.near()));
            };
            radiance.set_at(column, y, constant ? *constant : duet::radiance(data.scene.environment, direction()));
        }
    });
}

} // namespace duet::raster
