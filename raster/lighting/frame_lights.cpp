#include "raster/lighting/frame_lights.h"

#include <variant>

namespace duet::raster {
namespace {

using Kind = FrameLight::Kind;

struct Converter {
    const ScreenProjection& projection;

    Vec3 relative(Vec3 p) const { return projection.relative(Vec3d(p)); }

    FrameLight operator()(const PointLight& light) const {
        FrameLight result(Kind::kPoint, light.intensity);
        result.position = relative(light.position);
        return result;
    }
    FrameLight operator()(const SpotLight& light) const {
        FrameLight result(Kind::kSpot, light.intensity);
        result.position = relative(light.position), result.axis = light.direction;
        result.cos_outer = light.cos_outer;
        result.inverse_range = 1 / max(light.cos_inner - light.cos_outer, 1e-12f); // equal angles give a hard edge
        return result;
    }
    FrameLight operator()(const SunLight& light) const {
        FrameLight result(Kind::kSun, light.irradiance);
        result.axis = -light.direction;
        return result;
    }
    FrameLight operator()(const SurfaceLight& light) const {
        FrameLight result = std::visit([&](const auto& shape) { return of_shape(shape); }, light.shape);
        result.emitted = light.radiance, result.two_sided = light.two_sided;
        return result;
    }

    FrameLight flat(Kind kind, Vec3 corner, Vec3d u, Vec3d v) const {
        FrameLight result(kind);
        result.position = relative(corner), result.u = Vec3(u), result.v = Vec3(v);
        result.axis = Vec3(normalize_or_zero(cross(u, v)));
        return result;
    }
    FrameLight of_shape(const SurfaceLight::Triangle& t) const {
        return flat(Kind::kTriangle, t.a, Vec3d(t.b) - Vec3d(t.a), Vec3d(t.c) - Vec3d(t.a));
    }
    FrameLight of_shape(const Quad& q) const { return flat(Kind::kQuad, q.corner, Vec3d(q.u), Vec3d(q.v)); }
    FrameLight of_shape(const Sphere& s) const {
        FrameLight result(Kind::kSphere);
        result.position = relative(s.center), result.radius = s.radius;
        return result;
    }
};

} // namespace

std::vector<FrameLight> frame_lights(std::span<const Light> lights, const ScreenProjection& projection) {
    std::vector<FrameLight> result;
    result.reserve(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        FrameLight light = std::visit(Converter{projection}, lights[i]);
        light.index = i;
        const bool degenerate = light.flat() && light.axis == Vec3();
        if (!is_black(light.emitted) && !degenerate) result.push_back(light);
    }
    return result;
}

std::vector<FrameLight> scene_lights(const RasterSceneData& data, const RasterSettings& settings,
                                     const ScreenProjection& projection) {
    if (!settings.components.direct) return {};
    return frame_lights(data.scene.lights, projection);
}

std::vector<FrameLight> sun_lights(const RasterSceneData& data, const RasterSettings& settings,
                                   const ScreenProjection& projection) {
    if (!data.sun || !settings.environment || !settings.components.environment) return {};
    const Light sun = data.sun->light;
    std::vector<FrameLight> result = frame_lights(std::span(&sun, 1), projection);
    for (FrameLight& light : result) light.index = data.scene.lights.size(), light.diffuse_only = true;
    return result;
}

LightDirection direction_to(const FrameLight& light, const Vec3T<Floats>& p) {
    if (light.kind == FrameLight::Kind::kSun) return {broadcast<Floats>(light.axis), Floats(kInfinity)};
    const Vec3T<Floats> way = broadcast<Floats>(light.center()) - p;
    const Floats distance = max(xsimd::sqrt(dot(way, way)), Floats(1e-15f));
    return {way * (Floats(1.0f) / distance), distance};
}

std::vector<Medium> frame_media(std::span<const Medium> media, const RasterSettings& settings,
                                const ScreenProjection& projection) {
    if (!settings.fog) return {};
    std::vector<Medium> result(media.begin(), media.end());
    for (Medium& medium : result)
        medium.box = {projection.relative(Vec3d(medium.box.low)), projection.relative(Vec3d(medium.box.high))};
    // A thin box far from the eye may have no thickness in float precision.
    std::erase_if(result, [](const Medium& medium) {
        const Vec3 size = medium.box.diagonal();
        return !(size.x > 0 && size.y > 0 && size.z > 0);
    });
    return result;
}

} // namespace duet::raster
