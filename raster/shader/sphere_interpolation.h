// Computes a shader's varyings for samples on a sphere with SIMD.
#pragma once

#include "raster/shader/sphere_packet.h"
#include "raster/visibility/packet_interpolation.h"

#include "common/geometry/sphere.h"

namespace duet::raster {

/// Computes the varyings on a sphere, which has no corners. The vertex function is evaluated at each sample, and for
/// derivatives at its neighbors on the tangent plane, as in hit_corners(). Barycentrics are not set.
template <VertexShader S>
void interpolate_sphere(const SpherePacket& at, const Sphere& sphere, const S& shader, const ObjectView& object,
                        InterpolatedPacket<S, float>& result) {
    result.object_view = &object;
    result.depth = at.depth;
    const Vec3T<Floats> center = broadcast<Floats>(sphere.center);
    const Floats radius(sphere.radius), one(1.0f);
    for (std::size_t i = 0; i < kPacketSize; i += Floats::size) {
        const Vec3T<Floats> n = packet_detail::vector(at.n, 0, i), ng = n * load(at.side, i),
                            middle = center + n * radius;
        const auto varyings = [&](const SpherePacket::Vectors& normals) {
            const Vec3T<Floats> normal = packet_detail::vector(normals, 0, i);
            Vec2T<Floats> uv(Floats(0.0f), Floats(0.0f));
            if constexpr (wants_texture_coordinates<S>()) {
                const auto [u, v, none] = evaluate_per_lane(i, [&](std::size_t sample) {
                    const Vec2 here = sphere_uv({normals[0][sample], normals[1][sample], normals[2][sample]});
                    return Vec3(here.x, here.y, 0);
                });
                uv = {u, v};
            }
            return varying_floats<S, Floats>(shader.vertex(
                VertexInput<Floats>{center + normal * radius, normal, uv, ng, middle, {one, one, one}, object}));
        };
        for (std::size_t axis = 0; axis < 3; ++axis) store(result.ng[axis], i, ng[axis]);
        const auto here = varyings(at.n);
        for (std::size_t c = 0; c < here.size(); ++c) store(result.at[c], i, here[c]);
        if constexpr (wants_derivatives<S>()) {
            const auto right = varyings(at.n_right), down = varyings(at.n_down);
            for (std::size_t c = 0; c < here.size(); ++c) {
                store(result.dx[c], i, Floats(right[c] - here[c]));
                store(result.dy[c], i, Floats(down[c] - here[c]));
            }
        }
    }
}

} // namespace duet::raster
