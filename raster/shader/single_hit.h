// Shades one hit on a triangle, quad or sphere. This is the scalar reference that the batched code must match.
#pragma once

#include "raster/visibility/hit_tile.h"
#include "raster/visibility/shader.h"

namespace duet::raster {

/// Stores the corners of the hit triangle and the weights that interpolate them to the hit, with the weights'
/// screen-space derivatives. On a sphere the corners are the hit, and the points where the rays through the next pixels
/// to the right and below meet the tangent plane.
struct HitCorners {
    std::array<Vec3, 3> p, n; ///< positions and normals in object space
    std::array<Vec2, 3> uv;
    std::array<Vec3, 3> edges; ///< VertexInput::edges
    Vec3 ng, middle;           ///< as in VertexInput
    std::array<float, 3> weights{}, dx{}, dy{};
    SurfacePoint surface;
    Vec3 ns; ///< world-space shading normal, unit, on the visible side
    double depth = 0; ///< camera-space −z, meters
};
/// Returns the corners of a hit of the ray through `pixel`.
HitCorners hit_corners(const PassView& view, const Hit& hit, Vec2d pixel, const ObjectView& object,
                       int samples_per_pixel);
/// Returns the surface point at a camera ray's hit, with the detail that its material needs (surface_detail()). It has
/// the sample's footprint if the scene has filtered textures.
SurfacePoint filtered_point(const Scene& scene, const PassView& view, const Ray& ray, const Hit& hit,
                            int samples_per_pixel);
/// Returns the base color at a camera ray's hit. Textures are filtered over the sample's footprint.
Rgb hit_color(const Scene& scene, const PassView& view, const Ray& ray, const Hit& hit, int samples_per_pixel);

/// Returns the world-space shading normal at a hit, unit, on the visible side. Normal maps are filtered over the
/// sample's footprint.
Vec3 hit_normal(const Scene& scene, const PassView& view, const Hit& hit, Vec2d pixel, int samples_per_pixel);

/// Returns the radiance emitted at a hit toward the viewer. Textures are filtered over the sample's footprint.
Rgb hit_emission(const Scene& scene, const PassView& view, const Hit& hit, Vec2d pixel, int samples_per_pixel);

/// Returns the color of a hit of the ray through `pixel`.
template <Shader S>
Rgb shade_single_hit(const RasterSceneData& data, const PassView& view, const S& shader, const Hit& hit, Vec2d pixel,
                     int samples_per_pixel) {
    struct Source final : ColorSource {
        const Scene& scene;
        const HitCorners& at;
        const SurfacePoint& surface;
        Vec3 to_viewer;
        Source(const Scene& scene_, const HitCorners& at_, Vec3 to_viewer_)
            : scene(scene_), at(at_), surface(at_.surface), to_viewer(to_viewer_) {}
        Vec3 mapped_normal(std::size_t) const override { return at.ns; }
        Rgb base_color(std::size_t) const override {
            return duet::base_color(scene.materials[surface.material], scene.textures, surface);
        }
        Rgb emitted(std::size_t) const override {
            return duet::emitted(scene.materials[surface.material], scene.textures, surface, to_viewer);
        }
    };
    const ObjectView object(data, view, hit.object);
    const HitCorners at = hit_corners(view, hit, pixel, object, samples_per_pixel);
    std::array<std::array<float, kVaryings<S>>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
        corners[k] = varying_floats<S, float>(
            shader.vertex(VertexInput<float>{at.p[k], at.n[k], at.uv[k], at.ng, at.middle, at.edges[k], object}));
    const auto interpolated = [&](const std::array<float, 3>& w) {
        std::array<float, kVaryings<S>> sum;
        for (std::size_t c = 0; c < sum.size(); ++c)
            sum[c] = w[0] * corners[0][c] + w[1] * corners[1][c] + w[2] * corners[2][c];
        return varyings<S, float>(sum);
    };
    using V = VaryingsOf<S, float>;
    ScreenDerivatives<V, wants_derivatives<S>()> derivatives;
    if constexpr (wants_derivatives<S>()) derivatives = {interpolated(at.dx), interpolated(at.dy)};
    const Pinhole& pinhole = view.pinhole;
    const Vec3 direction(pinhole.direction + pinhole.direction_dx * pixel.x + pinhole.direction_dy * pixel.y);
    const Source colors(data.scene, at, -direction);
    return shader.template fragment<float>(FragmentOf<S, float>{
        derivatives,
        at.ng,
        interpolated(at.weights),
        Vec3(pinhole.origin + pinhole.origin_dx * pixel.x + pinhole.origin_dy * pixel.y),
        direction,
        static_cast<float>(at.depth),
        static_cast<float>(min(pinhole.near / at.depth, 1.0)),
        object,
        colors,
        0});
}

} // namespace duet::raster
