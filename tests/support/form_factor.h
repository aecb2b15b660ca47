// This header computes the unoccluded irradiance from area lights in double, as a reference.
#pragma once

#include "common/light/light.h"
#include "raster/lighting/form_factor.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet {

inline double clamp_to_unit(double x) { return std::clamp(x, -1.0, 1.0); }

/// Returns the form factor times π of a sphere that is partly below the horizon. The sphere subtends a half angle of
/// the given sine and cosine, and `c` is the cosine between the normal and the direction to its center, |c| < sine.
inline double clipped_sphere(double sine, double cosine, double c) {
    const double s = std::sqrt((1 - c) * (1 + c));
    // Below this size the sum at the end would cancel. The sphere is then a disk in the tangent plane, and k is the
    // height of its center in units of its radius.
    if (sine < 1e-4) {
        const double k = clamp_to_unit(c / sine), root = std::sqrt((1 - k) * (1 + k));
        return sine * sine * sine * (k * (std::acos(-k) + k * root) + 2.0 / 3.0 * root * root * root);
    }
    const double cot = cosine / sine, y = clamp_to_unit(-cot * c / s);
    const double half_chord = s * std::sqrt((1 - y) * (1 + y));
    return max((c * std::acos(y) - cot * half_chord) * sine * sine + std::atan2(half_chord, cot), 0.0);
}

inline double sphere_factor(Vec3d to_center, double radius, Vec3d n) {
    const double d2 = length_squared(to_center), r2 = radius * radius;
    if (!(r2 > 0)) return 0;
    if (d2 <= r2) return kPiDouble;
    const double d = std::sqrt(d2), sine = radius / d, cosine = std::sqrt((d2 - r2) / d2);
    const double c = clamp_to_unit(dot(n, to_center) / d);
    if (c >= sine) return kPiDouble * sine * sine * c;
    return c > -sine ? clipped_sphere(sine, cosine, c) : 0.0;
}

/// Returns the irradiance at p per unit of radiance of a sphere, its visible cap clipped to the hemisphere of n, in
/// [0, π] (Snyder 1996, "Area Light Sources for Real-Time Graphics", §A). The result is π where p is inside or on
/// the sphere, which then fills the hemisphere.
inline double sphere_form_factor_times_pi(Vec3 p, Vec3 n, const Sphere& sphere) {
    return sphere_factor(Vec3d(sphere.center) - Vec3d(p), static_cast<double>(sphere.radius), Vec3d(n));
}

/// Returns the unoccluded irradiance at p with normal n from an emissive surface, W/m². It is black where p is not
/// on an emitting side. A point of the light's own surface lies in its plane only up to rounding, so callers must
/// skip a surface's own light.
inline Rgb surface_light_irradiance(const SurfaceLight& light, Vec3 p, Vec3 n) {
    if (!emits_towards(light, p)) return {};
    double f = 0;
    if (const auto* sphere = std::get_if<Sphere>(&light.shape))
        f = sphere_form_factor_times_pi(p, n, *sphere);
    else if (const auto* quad = std::get_if<Quad>(&light.shape))
        f = polygon_form_factor_times_pi(p, n, *quad);
    else if (const auto* t = std::get_if<SurfaceLight::Triangle>(&light.shape))
        f = polygon_form_factor_times_pi(p, n, std::array{t->a, t->b, t->c});
    return light.radiance * static_cast<float>(f);
}

} // namespace duet
