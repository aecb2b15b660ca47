#include "raster/area_specular.h"

#include "common/light/lambert.h"
#include "common/material/ggx.h"
#include "common/material/ggx_albedo.h"
#include "raster/ggx_table.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace duet::raster {
namespace {

struct Outline {
    std::array<Vec3, 8> v;
    std::size_t count = 0;
};
Outline outline(const SurfaceLight::Triangle& t, Vec3) { return {{t.a, t.b, t.c}, 3}; }
Outline outline(const Quad& q, Vec3) {
    Outline result{{}, 4};
    const std::array<Vec3, 4> c = corners(q);
    std::copy(c.begin(), c.end(), result.v.begin());
    return result;
}
/// The disk that fills the sphere's cone, as an octagon of its area: ½·8·sin 45°·R² = π r².
Outline outline(const Sphere& s, Vec3 p) {
    const Vec3 way = s.center - p;
    const float distance = length(way);
    if (!(distance > s.radius)) return {};
    const float disk = s.radius / std::sqrt(1 - sqr(s.radius / distance));
    const float radius = disk * std::sqrt(kPi / (2 * std::sqrt(2.0f)));
    const Frame frame = frame_from_normal(way / distance);
    Outline result{{}, 8};
    for (std::size_t i = 0; i < 8; ++i) {
        const float turn = kPi / 4 * static_cast<float>(i);
        result.v[i] = s.center + (frame.s * std::cos(turn) + frame.t * std::sin(turn)) * radius;
    }
    return result;
}

} // namespace

Rgb area_reflection(const SurfaceLight& light, const MetalBsdf& bsdf, const ShadingPoint& point) {
    const SurfacePoint& surface = point.surface;
    if (light.object == surface.object && light.primitive == surface.primitive) return {};
    if (!emits_towards(light, surface.p)) return {};
    Outline polygon = std::visit([&](const auto& shape) { return outline(shape, surface.p); }, light.shape);
    if (polygon.count == 0) return {};

    // The frame of the viewer's side, the viewer in the plane y = 0.
    const Vec3 wo(point.wo.x, point.wo.y, std::abs(point.wo.z));
    const float flat = std::sqrt(sin2_theta(wo)), flip = point.wo.z < 0 ? -1.0f : 1.0f;
    const Vec2 turn = flat > 1e-6f ? Vec2(wo.x / flat, wo.y / flat) : Vec2(1, 0);
    const LobeMatrix lobe = ggx_lobe(bsdf.alpha, wo.z);
    for (std::size_t i = 0; i < polygon.count; ++i) {
        Vec3 w = point.frame.to_local(polygon.v[i] - surface.p);
        w.z *= flip;
        polygon.v[i] = lobe.to_cosine({turn.x * w.x + turn.y * w.y, turn.x * w.y - turn.y * w.x, w.z});
    }
    const double part = polygon_form_factor_times_pi({}, {0, 0, 1}, std::span<const Vec3>(polygon.v.data(), polygon.count));
    // Further reflections leave evenly enough to be taken for diffuse.
    const GgxAlbedo single = ggx_albedo(bsdf.alpha, wo.z);
    const Rgb further = bsdf.multiple * ((1 - single.energy) * ggx_means(bsdf.alpha).lost);
    return light.radiance * single.of(bsdf.reflectance) * static_cast<float>(part / kPiDouble) + irradiance(light, point) * further;
}

} // namespace duet::raster
