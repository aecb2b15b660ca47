// These tests check which rays hit alpha-masked and partly transparent surfaces.
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"
#include "common/geometry/quad.h"
#include "common/geometry/sphere.h"
#include "common/scene/alpha_mask.h"
#include "raytrace/acceleration/accelerator.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;
using namespace duet::raytrace;

namespace {

/// Returns a square at z = 0 with the given opacity (a texture whose left half is transparent) and an opaque one
/// behind it at z = -1.
Scene two_squares(SurfaceMaps maps) {
    SceneBuilder builder;
    ImageRgb halves(64, 1);
    for (int x = 0; x < 64; ++x) halves(x, 0) = Rgb(x < 32 ? 0.0f : 1.0f);
    builder.scene.textures = {{ImageTexture{0, {1, 1}, TextureFilter::kNearest}}, {halves}};
    const std::uint32_t front = builder.material(Diffuse{}), back = builder.material(Diffuse{{Rgb(0.25f)}});
    builder.add(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), front);
    builder.add(quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}), back);
    builder.scene.maps = {maps};
    return builder.finish();
}

SurfaceMaps half_open() {
    SurfaceMaps maps;
    maps.opacity = {1, 0};
    return maps;
}
SurfaceMaps sheet(float opacity) {
    SurfaceMaps maps;
    maps.opacity = opacity;
    return maps;
}

/// Returns the first hit that the ray does not pass through, by testing all hits with all spheres and quads.
Hit naive_closest(const Scene& scene, const Ray& ray) {
    Hit best;
    best.t = ray.t_max;
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const auto consider = [&](const Hit& hit) {
            if (hit.t < best.t && !passes_alpha_mask(scene, ray, hit)) best = hit;
        };
        const Shape& shape = scene.shapes[scene.objects[i].shape];
        if (const auto* sphere = std::get_if<Sphere>(&shape)) {
            Ray rest = ray;
            for (int side = 0; side < 2; ++side)
                if (const auto t = intersect_sphere(rest, *sphere)) consider({i, 0, 0, 0, rest.t_min = *t});
        } else {
            const Quad& quad = std::get<QuadList>(shape).quads.front();
            const std::array corners{quad.corner, quad.corner + quad.u, quad.corner + quad.u + quad.v,
                                     quad.corner + quad.v};
            if (const auto hit = intersect_quad(ShearedRay(ray), corners)) consider({i, 0, hit->u, hit->v, hit->t});
        }
    }
    return best.valid() ? best : Hit{};
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("many spheres and squares with holes: every query agrees with testing all primitives") {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> uniform(-1, 1);
        const auto point = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
        for (const bool instances : {false, true}) {
            SceneBuilder builder;
            ImageRgb squares(8, 8);
            for (std::size_t i = 0; i < 64; ++i) squares[i] = Rgb(static_cast<float>((i / 8 + i) % 2));
            builder.scene.textures = {{ImageTexture{0, {1, 1}, TextureFilter::kNearest}}, {squares}};
            const std::uint32_t holes = builder.material(Diffuse{}), partial = builder.material(Diffuse{});
            for (std::uint32_t i = 0; i < 40; ++i) {
                const std::uint32_t material = i % 2 == 0 ? holes : partial;
                if (i % 4 < 2)
                    builder.add(Sphere{point(), 0.5f + 0.3f * uniform(random)}, material);
                else
                    builder.add(quad(point(), point(), point()), material);
            }
            builder.scene.maps = {half_open(), sheet(0.2f)};
            Scene scene = builder.finish();
            if (instances)
                for (Object& object : scene.objects) object.identity = false;
            const Accelerator accelerator(scene, 1);
            std::vector<Ray> rays;
            for (int i = 0; i < 2000; ++i) {
                const Vec3 from = i % 2 == 0 ? point() * 4.0f : Vec3(0, 0, 5); // every other ray from one point
                rays.push_back({from, point() - from});
            }
            std::vector<Hit> hits(rays.size());
            accelerator.closest(rays, hits);
            std::size_t found = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const Hit expected = naive_closest(scene, rays[i]);
                found += expected.valid();
                CHECK(accelerator.closest(rays[i]) == expected);
                CHECK(hits[i] == expected);
                Hit end;
                end.t = 1;
                CHECK(accelerator.occluded(rays[i], end) == (expected.valid() && expected.t < 1));
            }
            CHECK(found > rays.size() / 2);
            CHECK(found < rays.size());
        }
    }

    TEST_CASE("rays go through holes, and only there; many at once and one by one alike") {
        const Scene scene = two_squares(half_open());
        REQUIRE(scene.needs.alpha);
        const Accelerator accelerator(scene, 1);
        std::mt19937 random(1);
        std::uniform_real_distribution<float> uniform(-0.99f, 0.99f);
        std::vector<Ray> rays;
        for (int i = 0; i < 500; ++i) rays.push_back({{uniform(random), uniform(random), 2}, {0, 0, -1}});
        std::vector<Hit> hits(rays.size());
        accelerator.closest(rays, hits);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const bool hole = rays[i].origin.x < 0;
            CHECK(hits[i].object == (hole ? 1u : 0u));
            CHECK(hits[i].t == doctest::Approx(hole ? 3 : 2));
            CHECK(accelerator.closest(rays[i]) == hits[i]);
            Hit end;
            end.t = 2.5f; // between the squares
            CHECK(accelerator.occluded(rays[i], end) == !hole);
            end.t = 4;
            CHECK(accelerator.occluded(rays[i], end));
            end.object = 1; // the shadow ray targets the back square, which does not occlude itself
            end.primitive = 0;
            end.t = 3;
            CHECK(accelerator.occluded(rays[i], end) == !hole);
        }
    }

    TEST_CASE("coincident surfaces: a ray that passes through one may hit another at the same distance") {
        for (const bool instances : {false, true}) {
            SceneBuilder builder;
            const std::uint32_t hole = builder.material(Diffuse{}), partial = builder.material(Diffuse{}),
                                opaque = builder.material(Diffuse{});
            constexpr std::uint32_t kHoles = 20; // more than a leaf holds
            for (std::uint32_t i = 0; i < kHoles; ++i) builder.add(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), hole);
            builder.add(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), partial);
            builder.add(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), opaque);
            builder.scene.maps = {sheet(0), sheet(0.5f)};
            Scene scene = builder.finish();
            if (instances)
                for (Object& object : scene.objects) object.identity = false;
            const Accelerator accelerator(scene, 1);
            std::vector<Ray> rays;
            for (int i = 0; i < 64; ++i) rays.push_back({{0.01f * static_cast<float>(i), 0.2f, 1}, {0, 0, -1}});
            std::vector<Hit> hits(rays.size());
            accelerator.closest(rays, hits);
            int of_partial = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                REQUIRE(hits[i].valid());
                CHECK(hits[i].object >= kHoles);
                of_partial += hits[i].object == kHoles;
                const Hit one = accelerator.closest(rays[i]);
                CHECK(one.object == hits[i].object);
                CHECK(one.t == hits[i].t);
                Hit end;
                end.t = 2;
                CHECK(accelerator.occluded(rays[i], end));
            }
            CHECK(of_partial > 16); // of 64, with a probability of 1/2 each: fewer by chance once in 30,000
            CHECK(of_partial < 48);
        }
    }

    TEST_CASE("of opaque primitives at one place one is kept, of those that can be seen through all are") {
        SceneBuilder builder;
        const std::uint32_t partial = builder.material(Diffuse{}), opaque = builder.material(Diffuse{});
        for (int i = 0; i < 1000; ++i) builder.add(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), opaque);
        for (int i = 0; i < 30; ++i) builder.add(quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}), partial);
        builder.scene.maps = {sheet(0.5f)};
        const Scene scene = builder.finish();
        CHECK(Accelerator(scene, 1).statistics().references == 31);
    }

    TEST_CASE("a cutoff makes surfaces whole or holes") {
        SurfaceMaps maps = half_open();
        maps.opacity.value = 0.6f;
        maps.cutoff = 0.5f;
        const Scene scene = two_squares(maps);
        const Accelerator accelerator(scene, 1);
        for (float x = -0.95f; x < 1; x += 0.1f)
            CHECK(accelerator.closest(Ray{{x, 0.1f, 1}, {0, 0, -1}}).object == (x < 0 ? 1u : 0u));
    }

    TEST_CASE("a scene without holes has no opacity to test") {
        const Scene scene = two_squares({});
        CHECK_FALSE(scene.needs.alpha);
        const Accelerator accelerator(scene, 1);
        CHECK(accelerator.closest(Ray{{-0.5f, 0.1f, 1}, {0, 0, -1}}).object == 0u);
    }
}

TEST_SUITE("statistical") {

    TEST_CASE("what is partly there stops its part of the rays") {
        for (const float opacity : {0.1f, 0.5f, 0.85f}) {
            const Scene scene = two_squares(sheet(opacity));
            const Accelerator accelerator(scene, 1);
            std::mt19937 random(2);
            std::uniform_real_distribution<float> uniform(-0.99f, 0.99f);
            constexpr int kRays = 40000;
            int stopped = 0;
            for (int i = 0; i < kRays; ++i)
                stopped += accelerator.closest(Ray{{uniform(random), uniform(random), 2}, {0, 0, -1}}).object == 0;
            const double p = static_cast<double>(opacity), deviation = std::sqrt(p * (1 - p) / kRays);
            CHECK(std::abs(stopped / static_cast<double>(kRays) - p) < 4.5 * deviation); // odds 7e-6 each
        }
    }

    TEST_CASE("a light that shows an image: light sampling finds the light that chance finds") {
        for (const int kind : {0, 1, 2}) { // quad, triangle, sphere
            SceneBuilder builder;
            ImageRgb image(8, 4);
            for (std::size_t i = 0; i < 32; ++i) image[i] = Rgb(i % 5 == 0 ? 1.0f : 0.1f * static_cast<float>(i % 7));
            builder.scene.textures = {{ImageTexture{0}}, {image}};
            Emissive area_light{Rgb(5.0f), true, {}};
            area_light.radiance_texture = 0;
            const std::uint32_t light = builder.material(area_light), grey = builder.material(Diffuse{});
            if (kind == 0) builder.add(quad({-0.5f, 1, 0.5f}, {1, 0, 0}, {0, 0, -1}), light);
            if (kind == 1) {
                Mesh mesh;
                mesh.positions = {{-0.5f, 1, 0.5f}, {0.7f, 1, 0.4f}, {0, 1.1f, -0.5f}};
                mesh.uvs = {{0, 0}, {1, 0.2f}, {0.4f, 1}};
                mesh.triangles = {{0, 1, 2}};
                builder.add(mesh, light);
            }
            if (kind == 2) builder.add(Sphere{{0, 1, 0}, 0.4f}, light);
            builder.add(quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), grey);
            builder.scene.camera.eye = {0, 0.6, 3};
            builder.scene.camera.look_at = {0, 0, 0};
            builder.scene.camera.fov_degrees = 20;
            const Scene scene = builder.finish();
            REQUIRE(scene.needs.emitter_textures);
            PathTracerSettings settings;
            settings.samples_per_pixel = 256;
            settings.max_depth = 1;
            const Estimate sampled = estimate(scene, 16, settings);
            settings.integrator = Integrator::kNaive;
            settings.samples_per_pixel = 2048;
            const Estimate found = estimate(scene, 16, settings);
            CAPTURE(kind);
            CHECK(sampled.mean > 0.05);
            check_equal_means(sampled, found);
        }
    }
}
