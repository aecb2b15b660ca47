#include "raster/shadows/space_shadows.h"

namespace duet::raster {

SpaceShadows::SpaceShadows(const RasterSceneData& data, const Vec3d& eye, float time)
    : shadows_(*data.shadows), maps_(shadows_, eye, time), eye_(eye) {}

Floats SpaceShadows::visibility(std::size_t light, const Vec3T<Floats>& p) const {
    const std::size_t source = shadows_.source_of(light);
    if (source == shadows_.sources().size()) return Floats(1.0f);
    return maps_.visibility(
        source, [&](const SharpShadowMap& map, auto& inside) { return map.visibility(p, inside); },
        [&](const SoftShadowMap& map) { return map.visibility(eye_, p); });
}

} // namespace duet::raster
