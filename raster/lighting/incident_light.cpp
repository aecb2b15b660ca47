#include "raster/lighting/incident_light.h"

#include "raster/lighting/form_factor.h"

namespace duet::raster {
namespace {

Vec3 center(const SurfaceLight::Triangle& t) { return (t.a + t.b + t.c) * (1.0f / 3); }
Vec3 center(const Quad& q) { return q.corner + (q.u + q.v) * 0.5f; }
Vec3 center(const Sphere& s) { return s.center; }

} // namespace

IncidentT<float> as_distant(const SurfaceLight& light, Vec3 p) {
    const Vec3 direction = std::visit([](const auto& shape) { return center(shape); }, light.shape) - p;
    if (!(length_squared(direction) > 0)) return {Vec3(0, 0, 1), Rgb()};
    const Vec3 wi = normalize(direction);
    return {wi, surface_light_irradiance(light, p, wi)};
}

} // namespace duet::raster
