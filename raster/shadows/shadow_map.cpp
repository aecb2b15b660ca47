#include "raster/shadows/shadow_map.h"

#include "raster/visibility/depth_image.h"

namespace duet::raster {

ShadowMap::ShadowMap(const RasterSceneData& data, const Camera& camera, int side, int threads, std::uint32_t excluded)
    : view_(CameraModel({camera, side, side}).pinhole()),
      orthographic_(camera.projection == Camera::Projection::kOrthographic), dithered_(data.has_layers(excluded)),
      reversed_depth_(render_depth(data, {camera, side, side}, threads, excluded)) {}

} // namespace duet::raster
