#include "raster/fog/light_in_space.h"

#include "common/vec/frame.h"

namespace duet::raster {
namespace {

using Vec3s = Vec3T<Floats>;
using Kind = FrameLight::Kind;
const Floats kNone(0.0f), kOne(1.0f);

Floats solid_angle(const FrameLight& light, const LightDirection& to, const Vec3s& p) {
    if (light.kind == Kind::kSphere) {
        const Floats sine2 = Floats(sqr(light.radius)) / (to.distance * to.distance);
        const Floats outside = Floats(2 * kPi) * sine2 / (kOne + xsimd::sqrt(max(kOne - sine2, kNone)));
        return xsimd::select(sine2 < kOne, outside, Floats(light.two_sided ? 4 * kPi : 0.0f));
    }
    const Vec3s a = broadcast<Floats>(light.position) - p, b = a + broadcast<Floats>(light.u),
                c = a + broadcast<Floats>(light.v);
    const bool quad = light.kind == Kind::kQuad;
    // The solid angle of the corners in their own order is negative in front of the light, so two are exchanged.
    const Floats front =
        quad ? solid_angle(a, c, c + broadcast<Floats>(light.u)) + solid_angle(a, c + broadcast<Floats>(light.u), b)
             : solid_angle(a, c, b);
    return light.two_sided ? abs(front) : max(front, kNone);
}

/// Returns the mean of 1 / distance² to a light over each piece, times the squared distance of the piece's middle. A
/// light close to the ray is treated as spread over the froxel's width or its own extent.
Floats falloff(const FrameLight& light, const RayPieces& rays) {
    const Vec3s to_light = broadcast<Floats>(light.center()) - rays.p();
    const Floats along = dot(to_light, rays.direction), half = (rays.piece.end - rays.piece.begin) * Floats(0.5f);
    const Floats squared = dot(to_light, to_light), height2 = max(squared - along * along, kNone);
    const float extent2 = light.flat() ? dot(light.u, light.u) + dot(light.v, light.v) : sqr(light.radius);
    const Floats smallest = max(max(rays.width * rays.width * Floats(1.0f / 16), Floats(extent2 / 4)), Floats(1e-12f));
    const Floats spread2 = max(height2, smallest), height = xsimd::sqrt(spread2);
    const Floats length = max(half + half, Floats(1e-15f));
    const Floats angle = xsimd::atan2(height * length, spread2 + (along - half) * (along + half));
    // The solid angle of an extended light stays finite near the light, so its factor uses the spread distance, too.
    return angle / (height * length) * (extent2 > 0 ? spread2 + along * along : squared);
}

/// Returns `fraction` dimmed by the spot's cone, averaged over four points of the froxel's cross section.
Floats dimmed_by_cone(const FrameLight& spot, const RayPieces& rays, const Floats& fraction) {
    const FrameT<Floats> frame = frame_from_normal(rays.direction);
    const Vec3s across = frame.s * (rays.width * Floats(0.25f)), down = frame.t * (rays.width * Floats(0.25f));
    Floats sum = kNone;
    for (const Vec3s& offset : {across + down, across - down, down - across, -across - down})
        sum += raster::dimmed_by_cone(spot, direction_to(spot, rays.p() + offset).wi, fraction);
    return sum * Floats(0.25f);
}

} // namespace

RgbT<Floats> light_in_space(const FrameLight& light, const LightDirection& to, const RayPieces& rays) {
    const RgbT<Floats> emitted = broadcast<Floats>(light.emitted);
    if (light.kind == Kind::kSun) return emitted;
    Floats fraction;
    if (light.kind == Kind::kPoint || light.kind == Kind::kSpot) {
        fraction = kOne / (to.distance * to.distance);
        if (light.kind == Kind::kSpot) fraction = dimmed_by_cone(light, rays, fraction);
    } else {
        fraction = solid_angle(light, to, rays.p());
    }
    if (!xsimd::any(fraction > kNone)) return RgbT<Floats>(kNone);
    return emitted * (fraction * falloff(light, rays));
}

} // namespace duet::raster
