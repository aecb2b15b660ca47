// A shader at one sample, whatever it sees: triangle, quad or sphere. The naive way, to which batches are held.
#pragma once

#include "raster/cover.h"
#include "raster/shader.h"

namespace duet::raster {

/// The corners of what a sample sees, and the weights that make it of them: their derivatives by the sample's place,
/// too. Of a sphere three of its points: where the sample sees it, and where the next to the right and below do, if they
/// looked at its tangent plane.
struct SampleCorners {
    std::array<Vec3, 3> p, n;
    std::array<Vec2, 3> uv;
    std::array<Vec3, 3> edges; ///< VertexInput::edges
    Vec3 ng, middle;           ///< VertexInput's
    std::array<float, 3> weights{}, dx{}, dy{};
    Ray ray;
    Hit hit;
    SurfacePoint surface;
    double depth = 0;
};
SampleCorners sample_corners(const PreparedData& data, const Geometry& geometry, const PassView& view, std::uint32_t id,
                             Vec2d pixel, const ObjectView& object);
/// The object that a number is of.
std::uint32_t object_of(const Geometry& geometry, std::uint32_t id);

/// `nearness`: known, or null.
template <Shader S>
Rgb shade_one(const PreparedData& data, const Geometry& geometry, const PassView& view, const S& shader, std::uint32_t id,
              Vec2d pixel, const float* nearness = nullptr) {
    struct Source final : ColorSource {
        const Scene& scene;
        const SampleCorners& sample;
        Source(const Scene& scene_, const SampleCorners& sample_) : scene(scene_), sample(sample_) {}
        Rgb base_color(std::size_t) const override {
            return duet::base_color(scene.materials[sample.surface.material], scene.textures, sample.surface);
        }
    };
    const ObjectView object(data, view, object_of(geometry, id));
    const SampleCorners sample = sample_corners(data, geometry, view, id, pixel, object);
    std::array<std::array<float, kVaryings<S>>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
        corners[k] = numbers<S, float>(shader.vertex(
            VertexInput<float>{sample.p[k], sample.n[k], sample.uv[k], sample.ng, sample.middle, sample.edges[k], object}));
    const auto weighed = [&](const std::array<float, 3>& w) {
        std::array<float, kVaryings<S>> sum;
        for (std::size_t c = 0; c < sum.size(); ++c)
            sum[c] = w[0] * corners[0][c] + w[1] * corners[1][c] + w[2] * corners[2][c];
        return varyings<S, float>(sum);
    };
    using V = VaryingsOf<S, float>;
    ScreenDerivatives<V, wants_derivatives<S>()> derivatives;
    if constexpr (wants_derivatives<S>()) derivatives = {weighed(sample.dx), weighed(sample.dy)};
    const Pinhole& pinhole = view.pinhole;
    const Source colors(data.scene, sample);
    return shader.template fragment<float>(FragmentOf<S, float>{
        derivatives, weighed(sample.weights), sample.ng,
        Vec3(pinhole.origin + pinhole.origin_dx * pixel.x + pinhole.origin_dy * pixel.y),
        Vec3(pinhole.direction + pinhole.direction_dx * pixel.x + pinhole.direction_dy * pixel.y),
        static_cast<float>(sample.depth),
        nearness != nullptr ? *nearness : static_cast<float>(min(pinhole.near / sample.depth, 1.0)), object, colors, 0});
}

} // namespace duet::raster
