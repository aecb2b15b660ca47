#include "raster/shading/deferred.h"

#include "raster/gbuffer/gbuffer_pass.h"
#include "raster/lighting/background.h"
#include "raster/lighting/direct_light.h"

namespace duet::raster {

Planes3 shade_deferred(const PreparedData& data, const Settings& settings, const Geometry& geometry,
                       const PassView& view, const TileGrid& grid, SampleOffset offset, const Control& control) {
    const int width = grid.region.width(), height = grid.region.height();
    GBuffer gbuffer(ScreenProjection(view.pinhole, offset), width, height, any_clear_coat(data.scene));
    Planes3 radiance(width, height);
    fill_gbuffer(data, settings, geometry, view, grid, offset, control, gbuffer, radiance);
    add(direct_light(data, settings, gbuffer, nullptr), settings.threads, radiance);
    draw_background(data, settings, gbuffer, radiance);
    return radiance;
}

} // namespace duet::raster
