#include "raster/lighting/incident_light.h"

#include "raster/lighting/form_factor.h"

#include <array>
#include <cmath>

namespace duet::raster {
namespace {

Vec3 center(const SurfaceLight::Triangle& t) { return (t.a + t.b + t.c) * (1.0f / 3); }
Vec3 center(const Quad& q) { return q.corner + (q.u + q.v) * 0.5f; }
Vec3 center(const Sphere& s) { return s.center; }

/// Returns the irradiance at p per unit of radiance, for a surface whose unit normal n points to the shape's center.
double facing_irradiance(const SurfaceLight::Triangle& t, Vec3 p, Vec3 n) {
    return polygon_form_factor_times_pi(p, n, std::array{t.a, t.b, t.c});
}
double facing_irradiance(const Quad& q, Vec3 p, Vec3 n) { return polygon_form_factor_times_pi(p, n, q); }
double facing_irradiance(const Sphere& s, Vec3 p, Vec3 n) {
    const Vec3d to_center = Vec3d(s.center) - Vec3d(p);
    const double squared = length_squared(to_center), radius = static_cast<double>(s.radius);
    if (squared <= radius * radius) return kPiDouble;
    const double distance = std::sqrt(squared), sine = radius / distance;
    return kPiDouble * sine * sine * min(dot(Vec3d(n), to_center) / distance, 1.0);
}

} // namespace

IncidentT<float> as_distant(const SurfaceLight& light, Vec3 p) {
    const Vec3 direction = std::visit([](const auto& shape) { return center(shape); }, light.shape) - p;
    if (!(length_squared(direction) > 0)) return {Vec3(0, 0, 1), Rgb()};
    const Vec3 wi = normalize(direction);
    if (!emits_towards(light, p)) return {wi, Rgb()};
    const double f = std::visit([&](const auto& shape) { return facing_irradiance(shape, p, wi); }, light.shape);
    return {wi, light.radiance * static_cast<float>(f)};
}

} // namespace duet::raster
