// These tests compare shadow maps with shadows of known silhouettes.
#include "tests/raster/shadow_floor.h"

#include "raster/raster_scene.h"
#include "raster/shadows/shadow_map.h"
#include "raster/shadows/shadow_maps.h"

#include "compare/stress/accelerated_scene.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

std::ptrdiff_t dark_pixels(const ImageFloat& visible) {
    return std::ranges::count_if(visible, [](float part) { return part < 0.999f; });
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a sphere under a point light: the shadow is the disk that its tangents draw, to a texel") {
        const double height = 3, center = 1, radius = 0.4;
        Scene scene = floor_scene();
        add(scene, Sphere{Vec3(0, 1, 0), 0.4f});
        scene.lights.push_back(PointLight{Vec3(0, 3, 0), Rgb(20)});
        finish_scene(scene);
        raster::RasterSettings settings;
        settings.shadow_map_side = 1024;
        const double sine = radius / (height - center), edge = height * sine / std::sqrt(1 - sine * sine);
        const double texel = 2 * height / (settings.shadow_map_side / 2 - 8);
        check_outline(
            visible(scene, over_floor(), settings), [&](Vec3d p) { return edge - length(p); },
            (kFilterRadius + 1) * texel, 2 * kPiDouble * edge, texel / 2);
    }

    TEST_CASE("a square under a slanting sun and in a spot's cone: its shadow is where the light's rays take it") {
        for (const bool sun : {true, false}) {
            Scene scene = floor_scene();
            add(scene, QuadList{{{Vec3(-0.5f, 1, 0.5f), Vec3(1, 0, 0), Vec3(0, 0, -1)}}});
            const Vec3 way = normalize(Vec3(0.4f, -1, 0.2f));
            if (sun)
                scene.lights.push_back(SunLight{way, Rgb(2)});
            else
                scene.lights.push_back(SpotLight{Vec3(0, 3, 0), Vec3(0, -1, 0), Rgb(20), 0.8f, 0.7f});
            finish_scene(scene);
            raster::RasterSettings settings;
            settings.shadow_map_side = 1024;
            const double half = sun ? 0.5 : 0.75;
            const Vec3d middle = sun ? Vec3d(0.4, 0, 0.2) : Vec3d();
            // This is the texel of the sun's map over the whole scene. The spot's map is finer.
            const double texel = 8.0 / settings.shadow_map_side;
            check_outline(
                visible(scene, over_floor(), settings),
                [&](Vec3d p) {
                    const Vec3d d = abs(p - middle);
                    return half - max(d.x, d.z);
                },
                (kFilterRadius + 1) * texel, 8 * half, texel / 2);
        }
    }

    TEST_CASE("no acne but on a few pixels of silhouettes: flat and convex surfaces under steep and grazing light are "
              "lit as if shadows were off") {
        for (const float lift : {1.0f, 0.1f, 0.01f})
            for (const int side : {64, 2048}) {
                Scene scene = floor_scene();
                add(scene, Sphere{Vec3(1, 3, 0), 0.5f});
                const Vec3 way = normalize(Vec3(-1, -lift, 0.3f));
                scene.lights.push_back(SunLight{way, Rgb(2)});
                scene.lights.push_back(PointLight{way * -20.0f, Rgb(20)});
                scene.lights.push_back(SpotLight{way * -20.0f, way, Rgb(20), 0.99f, 0.98f});
                finish_scene(scene);
                raster::RasterSettings settings;
                settings.shadow_map_side = side;
                // The sphere's own shadow falls beyond the floor or onto it. The views show the sphere, and the floor
                // where it is not in shadow.
                const View ball{look({4, 3, 4}, {1, 3, 0}, 12), 64, 64};
                CHECK(dark_pixels(visible(scene, ball, settings)) < (side == 64 ? 200 : 16)); // measured: 145 and 12
                if (lift == 1.0f) continue;
                for (const float part : visible(scene, over_floor(), settings)) CHECK(part > 0.95f); // measured: 0.965
            }
    }

    // Some facets face away from the sun, although their smooth normals do not.
    TEST_CASE("a smooth convex mesh of coarse facets does not shade itself") {
        Scene scene;
        Mesh ball = compare::icosphere(1);
        ball.normals = ball.positions;
        add(scene, ball);
        const Vec3 way = normalize(Vec3(-1, -0.3f, 0.2f));
        scene.lights.push_back(SunLight{way, Rgb(2)});
        scene.camera = look({0, 0, 6}, {0, 0, 0}, 24);
        finish_scene(scene);
        raster::RasterSettings open = direct_light_only();
        open.shadows = false;
        const View view{scene.camera, 160, 160};
        const ImageRgb shaded = render(scene, view, direct_light_only()).radiance,
                       lit = render(scene, view, open).radiance;
        int seen = 0, dark = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                seen += lit(x, y).g > 0.01f;
                dark += lit(x, y).g > 0.01f && shaded(x, y).g < 0.99f * lit(x, y).g;
            }
        CHECK(seen > 4000);
        CHECK(dark < 4); // measured: 0; without the bulge of the smooth surface 501
    }

    TEST_CASE("no leaks: a smooth mesh of coarse facets in the shade of a roof is dark, facets that are turned "
              "away, too") {
        for (const float lift : {1.0f, 0.2f}) {
            Scene scene = floor_scene();
            Mesh ring = torus(24, 12);
            ring.normals = torus(24, 12, 0, 1).positions;
            add(scene, ring);
            const Vec3 way = normalize(Vec3(-1, -lift, 0.3f));
            const Vec3 middle = way * -30.0f, side = normalize(cross(way, Vec3(0, 1, 0)));
            const Vec3 u = side * 20.0f, v = cross(way, side) * 20.0f;
            add(scene, QuadList{{Quad{middle - u * 0.5f - v * 0.5f, u, v}}});
            scene.lights.push_back(SunLight{way, Rgb(2)});
            finish_scene(scene);
            raster::RasterSettings settings = direct_light_only();
            settings.shadow_map_side = 512;
            for (const Vec3d eye : {Vec3d(4, 3, 4), Vec3d(-4, 3, -4)}) {
                const View view{look(eye, {0, 0.2, 0}, 30), 160, 120};
                const ImageRgb shaded = render(scene, view, settings).radiance;
                float brightest = 0;
                for (const Rgb& c : shaded) brightest = max(brightest, c.g);
                CHECK(brightest < 1e-4); // at grazing angles below a thousandth, filters reach past the roof
                raster::RasterSettings open = settings;
                open.shadows = false;
                CHECK(std::ranges::count_if(render(scene, view, open).radiance, [](Rgb c) { return c.g > 0; }) > 5000);
            }
        }
    }

    TEST_CASE("no peter-panning: behind a box that stands on the floor the shadow begins at its foot") {
        Scene scene = floor_scene();
        add(scene, QuadList{box_quads(Vec3(-0.5f, 0, -0.5f), Vec3(0.5f, 1, 0.5f))});
        scene.lights.push_back(SunLight{normalize(Vec3(1, -1, 0)), Rgb(2)}); // the shadow extends to x = 1.5
        finish_scene(scene);
        raster::RasterSettings settings;
        settings.shadow_map_side = 1024;
        const double texel = 8.0 / settings.shadow_map_side;
        const ImageFloat found = visible(scene, over_floor(2), settings);
        int dark = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const Vec3d p = floor_point(x, y);
                const double margin = 3 * texel;
                if (p.x < 0.5 + 1e-3 || p.x > 1.5 - margin || std::abs(p.z) > 0.5 - margin) continue;
                CHECK(found(x, y) < 0.01f);
                ++dark;
            }
        CHECK(dark > 1000);
    }

    TEST_CASE("forty spots over what moves: their maps are coarser than requested, fit in memory, and that is told") {
        Scene scene = floor_scene();
        Object& box = add(scene, QuadList{box_quads(Vec3(-0.5f, 0, -0.5f), Vec3(0.5f, 1, 0.5f))});
        box.place(box.to_world, translation(Vec3(0.1f, 0, 0)));
        for (int i = 0; i < 40; ++i)
            scene.lights.push_back(
                SpotLight{Vec3(0, 3 + 0.1f * static_cast<float>(i), 0), Vec3(0, -1, 0), Rgb(1), 0.8f, 0.7f});
        finish_scene(scene);
        raster::RasterSettings settings;
        for (const bool moving : {false, true}) {
            settings.samples_per_pixel = moving ? 2 : 1;
            const raster::RasterScene prepared = raster::prepare(scene, settings);
            const raster::Shadows& shadows = *prepared.data().shadows;
            CHECK(shadows.moments() == (moving ? raster::Shadows::kMoments : 1));
            CHECK(shadows.memory_bytes() > 100 << 20);
            CHECK(shadows.memory_bytes() <= 512 << 20); // with 2048 texels a side: 0.7 and 5.4 GB
            Control control;
            const auto messages =
                raster::render(prepared, {scene.camera, 8, 8}, settings, control).statistics.approximations;
            CHECK(std::ranges::any_of(messages,
                                      [](const std::string& s) { return s.find("coarser") != std::string::npos; }));
        }
    }

    TEST_CASE("the statistics count the depths of an area light once: six faces of a cube for each of its cells") {
        Scene scene = floor_scene();
        add(scene, QuadList{{{Vec3(-0.5f, 3, -0.5f), Vec3(1, 0, 0), Vec3(0, 0, 1)}}}, Mat4(), Emissive{Rgb(5)});
        finish_scene(scene);
        raster::RasterSettings settings;
        settings.shadow_map_side = 256;
        settings.indirect_light = false; // the probes have no part in this
        for (const int cells : {1, 2}) {
            settings.shadow_cells = cells;
            const raster::RasterScene prepared = raster::prepare(scene, settings);
            CHECK(prepared.data().shadows->memory_bytes() == 4 * 6 * 64 * 64 * cells * cells);
        }
    }

    TEST_CASE("what moves does not shade itself by its own motion, and leaves a blurred shadow") {
        Scene scene = floor_scene();
        Object& ball = add(scene, Sphere{Vec3(0, 0, 0), 0.3f}, translation(Vec3(-1, 1, 0)));
        ball.place(ball.to_world, translation(Vec3(1, 1, 0)));
        scene.lights.push_back(SunLight{normalize(Vec3(0.1f, -1, 0.1f)), Rgb(2)});
        finish_scene(scene);
        raster::RasterSettings settings;
        settings.samples_per_pixel = 16;
        View from_above = over_floor(3);
        // In the middle of its path the sphere covers its own shadow except for the light's slant. Far beside it
        // everything is lit.
        const ImageFloat above = visible(scene, from_above, settings), floor = visible(scene, over_floor(), settings);
        double least = 1;
        for (int x = 60; x < 140; ++x) least = std::min(least, static_cast<double>(floor(x, kSize / 2 + 5)));
        CHECK(least > 0.3); // at most 0.6 m of 2 m at a time
        CHECK(least < 0.9);
        CHECK(above(10, 10) == 1);
        // The sphere is alone, without a floor to shade, and must be fully lit.
        Scene alone;
        Object& other = add(alone, Sphere{Vec3(0, 0, 0), 0.3f}, translation(Vec3(-1, 1, 0)));
        other.place(other.to_world, translation(Vec3(1, 1, 0)));
        alone.lights = scene.lights;
        alone.camera = scene.camera;
        finish_scene(alone);
        for (const float part : visible(alone, from_above, settings)) CHECK(part == doctest::Approx(1).epsilon(1e-5));
    }

    TEST_CASE("the same bits for any number of threads; a size or a number of pieces out of range is refused") {
        Scene scene = floor_scene();
        add(scene, torus(24, 12), translation(Vec3(0, 0.5f, 0)));
        add(scene, QuadList{{{Vec3(-0.5f, 3, -0.5f), Vec3(1, 0, 0), Vec3(0, 0, 1)}}}, Mat4(), Emissive{Rgb(5)});
        scene.lights.push_back(PointLight{Vec3(1, 2, 1), Rgb(3)});
        scene.lights.push_back(SunLight{normalize(Vec3(1, -1, 0)), Rgb(2)});
        finish_scene(scene);
        raster::RasterSettings settings;
        settings.shadow_map_side = 256;
        settings.threads = 1;
        const Rendering one = render(scene, over_floor(2), settings);
        settings.threads = 5;
        CHECK(render(scene, over_floor(2), settings).radiance.pixels() == one.radiance.pixels());
        settings.shadow_map_side = 16;
        CHECK_THROWS_AS(raster::prepare(scene, settings), Error);
        settings.shadow_map_side = 256;
        settings.shadow_cells = 0;
        CHECK_THROWS_AS(raster::prepare(scene, settings), Error);
    }
}
