// These tests check the shading-terminator fix: smooth normals on coarse meshes must give a smooth boundary between
// light and shadow.
#include "raytrace/render.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

/// Returns a smooth sphere of 80 triangles under a sun from the side.
Scene ball(const Mat4& to_world) {
    SceneBuilder builder;
    const std::uint32_t grey = builder.material(Diffuse{{Rgb(1.0f)}});
    const std::uint32_t shape = builder.shape(icosphere(1, 1, {}, true));
    builder.place(shape, grey, to_world);
    // A second instance far away prevents the first from being baked.
    builder.place(shape, grey, Mat4(translation(Vec3d(50, 0, 0))));
    builder.scene.lights.push_back(SunLight{normalize(Vec3(1, -0.3f, -0.2f)), Rgb(kPi)});
    builder.scene.camera.eye = {0, 0, 6};
    builder.scene.camera.fov_degrees = 24;
    return builder.finish();
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("direct light on a smooth ball of few facets is the cosine of its smooth normal") {
        for (const Mat4& to_world : {Mat4(), Mat4(scaling(Vec3d(1, 0.7, 1.1)))}) {
            const Scene scene = ball(to_world);
            PathTracerSettings settings;
            settings.integrator = Integrator::kDirect;
            settings.sampler = SamplerKind::kCenter;
            settings.samples_per_pixel = 1;
            const PathTracerScene prepared = prepare(scene, settings);
            const View view{scene.camera, 128, 128};
            Control control;
            const Rendering image = render(prepared, view, settings, control);
            const CameraModel camera(view);
            const Vec3 to_sun = -std::get<SunLight>(scene.lights[0]).direction;
            int seen = 0, below_facet = 0, wrong = 0;
            for (int y = 0; y < view.height; ++y)
                for (int x = 0; x < view.width; ++x) {
                    const Ray ray = camera.ray({x + 0.5, y + 0.5});
                    const Hit hit = trace(prepared, ray);
                    if (!hit.valid()) continue;
                    const SurfacePoint point = surface_point(scene, ray, hit);
                    const float expected = max(0.0f, dot(point.ns, to_sun));
                    ++seen;
                    below_facet += dot(point.ng, to_sun) <= 0 && expected > 0.02f;
                    wrong += std::abs(image.radiance(x, y).g - expected) > 1e-3f;
                }
            CHECK(seen > 3000);
            // These facets face away from the sun although the smooth surface does not. They would cause steps.
            CHECK(below_facet > 20);
            CHECK(wrong == 0);
        }
    }

    TEST_CASE("the lift leads to the vertices' tangent planes, on the viewer's side, and flat facets have none") {
        const Shape smooth = icosphere(0, 1, {}, true), flat = icosphere(0);
        const auto& mesh = std::get<Mesh>(smooth);
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const Hit hit{0, i, 1.0f / 3, 1.0f / 3, 1};
            const Vec3 a = mesh.positions[mesh.triangles[i][0]], b = mesh.positions[mesh.triangles[i][1]],
                       c = mesh.positions[mesh.triangles[i][2]];
            const Vec3 middle = (a + b + c) / 3.0f;
            const Ray from_outside{middle * 3.0f, -normalize(middle)}, from_inside{{}, normalize(middle)};
            const SurfacePoint outer = surface_point(smooth, hit, from_outside, Mat4(), Mat4(), true);
            CHECK(outer.terminator_normal == outer.ns);
            CHECK(length(outer.p + outer.terminator_offset) > length(outer.p));
            // The offset `lift` must reach all three tangent planes, because the center is equally far below each.
            CHECK(dot(outer.p + outer.terminator_offset, normalize(middle)) > 0.9f);
            const SurfacePoint inner = surface_point(smooth, hit, from_inside, Mat4(), Mat4(), true);
            CHECK(inner.terminator_normal ==
                  inner.ng); // concave from inside, so the geometric normal bounds the directions
            CHECK(length(inner.terminator_offset) == 0);
            const SurfacePoint facet = surface_point(flat, hit, from_outside, Mat4(), Mat4(), true);
            CHECK(length(facet.terminator_offset) == 0);
            CHECK(facet.terminator_normal == facet.ng);
        }
    }
}
