// These tests check the shading-terminator fix: smooth normals on coarse meshes must give a smooth boundary between
// light and shadow.
#include "raytrace/integrator/vertex.h"
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

    TEST_CASE("the smooth surface bulges over convex edges, on the viewer's side, and flat facets have none") {
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
            // The point must reach all three tangent planes, because the center is equally far below each.
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

    TEST_CASE("a saddle bulges over its convex edge alone, and tilted normals leave a plane flat") {
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};
        mesh.triangles = {{0, 1, 2}};
        const auto offset_at = [&](std::array<Vec3, 3> normals, float u, float v) {
            mesh.normals = {normalize(normals[0]), normalize(normals[1]), normalize(normals[2])};
            const Ray down{{u, 1, -v}, {0, -1, 0}};
            return surface_point(Shape(mesh), Hit{0, 0, u, v, 1}, down, Mat4(), Mat4(), true).terminator_offset;
        };
        // The surface falls toward x, and rises toward -z.
        const std::array<Vec3, 3> saddle{Vec3(0, 1, 0), Vec3(0.2f, 1, 0), Vec3(0, 1, 0.2f)};
        CHECK(offset_at(saddle, 0.5f, 0).y > 0.04f); // (n₁ − n₀)·(v₁ − v₀)/4
        CHECK(offset_at(saddle, 0.5f, 0).y < 0.05f);
        CHECK(offset_at(saddle, 0.3f, 0.3f).y > 0.01f);
        CHECK(length(offset_at(saddle, 0, 0.5f)) == 0);
        const Vec3 tilted(0.2f, 1, 0.1f);
        CHECK(length(offset_at({tilted, tilted, tilted}, 0.3f, 0.3f)) == 0);
    }

    TEST_CASE("rays above the triangle's plane start from the triangle, rays below from the smooth surface") {
        const Shape smooth = icosphere(0, 1, {}, true);
        const Vec3 p = std::get<Mesh>(smooth).positions[0];
        const SurfacePoint point =
            surface_point(smooth, {0, 0, 1.0f / 3, 1.0f / 3, 1}, {p * 3.0f, -p}, Mat4(), Mat4(), true);
        const Vec3 along = normalize(p - point.ng * dot(p, point.ng));
        CHECK(terminator_fraction(point, point.ng) == 0);
        CHECK(terminator_fraction(point, along) == doctest::Approx(1));
        CHECK(terminator_fraction(point, normalize(along + 0.1f * point.ng)) > 0.1f);
        CHECK(terminator_fraction(point, -point.ng) == 0); // into the sphere
    }

    // A flat shell lies close over a coarse ball, below its smooth surface. The ball's light must stay in the shell.
    TEST_CASE("no ray starts beyond a surface that touches a smooth mesh") {
        SceneBuilder builder;
        const std::uint32_t grey = builder.material(Diffuse{{Rgb(1.0f)}});
        const Mesh ball = icosphere(1, 1, {}, true);
        builder.add(ball, grey);
        builder.add(icosphere(1, 1.01f), grey);
        const Scene scene = builder.finish();
        PathTracerSettings settings;
        const PathTracerScene prepared = prepare(scene, settings);
        const RenderPlan plan(prepared.data(), View{scene.camera, 8, 8}, settings);
        int beyond = 0;
        for (std::uint32_t i = 0; i < ball.triangles.size(); ++i) {
            const auto& [a, b, c] = ball.triangles[i];
            const Vec3 middle = (ball.positions[a] + ball.positions[b] + ball.positions[c]) / 3.0f,
                       along = normalize(ball.positions[b] - ball.positions[a] + 0.01f * middle); // just above it
            const Ray ray{middle * 1.005f, -middle};
            const Hit hit = trace(prepared, ray);
            REQUIRE(hit.object == 0);
            const SurfacePoint point = surface_point(scene, ray, hit);
            beyond += dot(point.p + point.terminator_offset, normalize(middle)) > 1.01f * length(middle);
            const Ray leaving{ray_origin(plan, point, along, 0), along};
            const Hit next = trace(prepared, leaving);
            CHECK(next.object == 1);
            CHECK(dot(leaving.origin, normalize(middle)) < 1.01f * length(middle));
        }
        CHECK(beyond == static_cast<int>(ball.triangles.size()));
    }
}
