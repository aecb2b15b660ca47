#include "raster/shadows/shadow_map.h"

#include "raster/raster_scene.h"

namespace duet::raster {

ShadowMap::ShadowMap(const RasterScene& casters, const Camera& camera, int side, int threads)
    : view_(CameraModel({camera, side, side}).pinhole()),
      orthographic_(camera.projection == Camera::Projection::kOrthographic), dithered_(casters.data().has_layers()) {
    RasterSettings settings;
    settings.output = Output::kReversedDepth;
    settings.threads = threads;
    Control control;
    reversed_depth_ = std::move(render(casters, {camera, side, side}, settings, control).reversed_depth);
}

} // namespace duet::raster
