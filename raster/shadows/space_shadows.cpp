#include "raster/shadows/space_shadows.h"

namespace duet::raster {

SpaceShadows::SpaceShadows(const RasterSceneData& data, const Vec3d& eye, float time)
    : shadows_(*data.shadows), soft_(*data.soft_shadows), eye_(eye), moment_(shadows_.moment_at(time)) {
    for (const Shadows::Source& source : shadows_.sources()) {
        std::vector<SharpShadowMap>& maps = sharp_.emplace_back();
        for (const ShadowMap& view : source.moments[moment_].views) maps.emplace_back(view, eye);
        for (const CubeMap& cube : source.moments[moment_].cubes)
            for (const auto& face : cube.faces) maps.emplace_back(*face, eye);
    }
}

Floats SpaceShadows::visibility(std::size_t light, const Vec3T<Floats>& p) const {
    const std::size_t source = shadows_.source_of(light);
    Floats result(1.0f);
    if (source == shadows_.sources().size()) return result;
    if (const std::span<const SoftShadowMap> cells = soft_.of(source, moment_); !cells.empty()) {
        Floats sum(0.0f);
        for (const SoftShadowMap& cell : cells) sum += cell.visibility(eye_, p);
        return sum * Floats(1 / static_cast<float>(cells.size()));
    }
    xsimd::batch_bool<float> found(false);
    for (const SharpShadowMap& map : sharp_[source]) {
        xsimd::batch_bool<float> inside;
        const Floats seen = map.visibility(p, inside);
        result = xsimd::select((!found) & inside, seen, result);
        found = found | inside;
        if (xsimd::all(found)) break;
    }
    return result;
}

} // namespace duet::raster
