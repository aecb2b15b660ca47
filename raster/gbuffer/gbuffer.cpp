#include "raster/gbuffer/gbuffer.h"

namespace duet::raster {

GBuffer::GBuffer(const ScreenProjection& view, int width, int height, OptionalPlanes planes)
    : projection(view), reversed_depth(width, height), normal(width, height), bulge(width, height),
      diffuse(width, height), specular(width, height), alpha(width, height), object(width, height, -1),
      material(width, height, -1) {
    if (planes.coat) coat = PlaneFloat(width, height), coat_alpha = PlaneFloat(width, height);
    if (planes.tint) tint = Planes3(width, height);
}

std::size_t GBuffer::memory_bytes() const {
    return reversed_depth.memory_bytes() + normal.memory_bytes() + bulge.memory_bytes() + diffuse.memory_bytes() +
           specular.memory_bytes() + alpha.memory_bytes() + coat.memory_bytes() + coat_alpha.memory_bytes() +
           tint.memory_bytes() + object.memory_bytes() + material.memory_bytes() + position.memory_bytes();
}

} // namespace duet::raster
