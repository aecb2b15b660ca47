// Computes a shader's varyings for samples on a sphere with SIMD.
#pragma once

#include "raster/shader/solve.h"
#include "raster/shader/sphere_strip.h"

#include "common/geometry/sphere.h"

namespace duet::raster {

/// A sphere has no corners. The vertex function is evaluated at each sample, and for derivatives at its neighbors
/// on the tangent plane, as in hit_corners(). Barycentrics are not set.
template <VertexShader S>
void solve_sphere(const SphereStrip& at, const Sphere& sphere, const S& shader, const ObjectView& object,
                  SolvedStrip<S, float>& strip) {
    strip.object_view = &object;
    strip.directions = false;
    strip.depth = at.depth;
    const Vec3T<Floats> center = spread<Floats>(sphere.center);
    const Floats radius(sphere.radius), one(1.0f);
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        const Vec3T<Floats> n = strips::vector(at.n, 0, i), ng = n * load(at.side, i), middle = center + n * radius;
        const auto varyings = [&](const SphereStrip::Vectors& normals) {
            const Vec3T<Floats> normal = strips::vector(normals, 0, i);
            Vec2T<Floats> uv(Floats(0.0f), Floats(0.0f));
            if constexpr (wants_texture_coordinates<S>()) {
                const auto [u, v, none] = one_by_one(i, [&](std::size_t sample) {
                    const Vec2 here = sphere_uv({normals[0][sample], normals[1][sample], normals[2][sample]});
                    return Vec3(here.x, here.y, 0);
                });
                uv = {u, v};
            }
            return numbers<S, Floats>(shader.vertex(
                VertexInput<Floats>{center + normal * radius, normal, uv, ng, middle, {one, one, one}, object}));
        };
        for (std::size_t axis = 0; axis < 3; ++axis) store(strip.ng[axis], i, ng[axis]);
        const auto here = varyings(at.n);
        for (std::size_t c = 0; c < here.size(); ++c) store(strip.at[c], i, here[c]);
        if constexpr (wants_derivatives<S>()) {
            const auto right = varyings(at.n_right), down = varyings(at.n_down);
            for (std::size_t c = 0; c < here.size(); ++c) {
                store(strip.dx[c], i, Floats(right[c] - here[c]));
                store(strip.dy[c], i, Floats(down[c] - here[c]));
            }
        }
    }
}

} // namespace duet::raster
