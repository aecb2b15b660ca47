#include "raster/shadows/shadow_map.h"

#include "raster/visibility/depth_image.h"

namespace duet::raster {

ShadowMap::ShadowMap(const RasterSceneData& casters, const Camera& camera, int side, int threads)
    : view_(CameraModel({camera, side, side}).pinhole()),
      orthographic_(camera.projection == Camera::Projection::kOrthographic), dithered_(casters.has_layers()),
      reversed_depth_(render_depth(casters, {camera, side, side}, threads)) {}

} // namespace duet::raster
