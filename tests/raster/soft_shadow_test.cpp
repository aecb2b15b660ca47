// These tests compare soft shadows with the visible fraction of a light.
#include "tests/raster/shadow_floor.h"

#include "tests/support/form_factor.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

TEST_SUITE("unit") {

    // The square occluder and the square light are parallel to the floor. The lines through the occluder's corners
    // bound the hidden part of the light, so the irradiance has a closed form.
    TEST_CASE("a square before a square light: the penumbra of the closed form, to 1.3 % in the mean") {
        Scene scene = floor_scene();
        constexpr float kAreaLight = 0.5f, kHeight = 3, kSide = 0.6f, kAbove = 1;
        add(scene,
            QuadList{
                {{Vec3(-kAreaLight, kHeight, -kAreaLight), Vec3(2 * kAreaLight, 0, 0), Vec3(0, 0, 2 * kAreaLight)}}},
            Mat4(), Emissive{Rgb(5)});
        add(scene, QuadList{{{Vec3(-kSide, kAbove, kSide), Vec3(2 * kSide, 0, 0), Vec3(0, 0, -2 * kSide)}}});
        finish_scene(scene);
        for (const int cells : {1, 2, 4}) {
            raster::RasterSettings settings = direct_light_only();
            settings.shadow_cells = cells;
            settings.shadow_map_side = 1024;
            const ImageFloat found = visible(scene, over_floor(), settings);
            double sum = 0;
            int penumbra = 0;
            for (int y = 0; y < kSize; y += 4)
                for (int x = 0; x < kSize; x += 4) {
                    const Vec3d p = floor_point(x, y);
                    const auto hidden = [&](double at) { // an interval of the light, along one axis
                        const double a = at +
                                         (-static_cast<double>(kSide) - at) * static_cast<double>(kHeight / kAbove),
                                     b = at + (static_cast<double>(kSide) - at) * static_cast<double>(kHeight / kAbove);
                        const double area_light = static_cast<double>(kAreaLight);
                        return Vec2d(std::clamp(a, -area_light, area_light), std::clamp(b, -area_light, area_light));
                    };
                    const Vec2d u = hidden(p.x), v = hidden(p.z);
                    const auto factor = [&](Vec2d a, Vec2d b) {
                        const double h = static_cast<double>(kHeight);
                        const std::array<Vec3, 4> q = {Vec3(Vec3d(a.x, h, b.x)), Vec3(Vec3d(a.y, h, b.x)),
                                                       Vec3(Vec3d(a.y, h, b.y)), Vec3(Vec3d(a.x, h, b.y))};
                        return polygon_form_factor_times_pi(Vec3(p), Vec3(0, 1, 0), q);
                    };
                    const double area_light = static_cast<double>(kAreaLight),
                                 all = factor({-area_light, area_light}, {-area_light, area_light});
                    const double part = u.x < u.y && v.x < v.y ? 1 - factor(u, v) / all : 1;
                    sum += std::abs(static_cast<double>(found(x, y)) - part);
                    penumbra += part > 0.05 && part < 0.95;
                }
            const double error = sum / (kSize * kSize / 16);
            CAPTURE(cells);
            CHECK(penumbra > 100);
            CHECK(error < 0.013); // measured: 0.0123
        }
    }

    // The fraction of a light of any shape that a square hides is estimated from points all over the light.
    TEST_CASE("shadows of squares, slivers of 1 : 10,000, straight and slanting, and thin triangles, from a micrometre "
              "to 1000 km") {
        struct AreaLight {
            Vec3 u, v;
            bool triangle;
        };
        const std::array<AreaLight, 4> area_lights{
            AreaLight{Vec3(1, 0, 0), Vec3(0, 0, 1), false}, AreaLight{Vec3(1, 0, 0), Vec3(0, 0, 1e-4f), false},
            AreaLight{Vec3(1, 0, 0), Vec3(1, 0, 1e-4f), false}, AreaLight{Vec3(1, 0, 0), Vec3(1, 0, 1e-4f), true}};
        constexpr double kHeight = 3, kSide = 0.6;
        for (const double size : {1e-6, 1.0, 1e6})
            for (const AreaLight& area_light : area_lights) {
                const float s = static_cast<float>(size);
                Scene scene;
                add(scene, QuadList{{{Vec3(-4, 0, 4) * s, Vec3(8, 0, 0) * s, Vec3(0, 0, -8) * s}}});
                add(scene, QuadList{{{Vec3(-0.6f, 1, 0.6f) * s, Vec3(1.2f, 0, 0) * s, Vec3(0, 0, -1.2f) * s}}});
                const Vec3 corner = (Vec3(0, 3, 0) - (area_light.u + area_light.v) * 0.5f) * s, u = area_light.u * s,
                           v = area_light.v * s;
                Mesh mesh;
                mesh.positions = {corner, corner + u, corner + v};
                mesh.triangles = {{0, 1, 2}};
                add(scene, area_light.triangle ? Shape(mesh) : Shape(QuadList{{{corner, u, v}}}), Mat4(),
                    Emissive{Rgb(5)});
                View view = over_floor();
                view.camera.eye *= size, view.camera.height *= size;
                scene.camera = view.camera;
                finish_scene(scene);
                raster::RasterSettings settings = direct_light_only();
                settings.shadow_map_side = 1024;
                settings.shadow_cells = 1;
                const ImageFloat found = visible(scene, view, settings);
                const auto expected = [&](Vec3d p) {
                    constexpr int kSteps = 32;
                    double all = 0, open = 0;
                    for (int i = 0; i < kSteps * kSteps; ++i) {
                        const double a = (i % kSteps + 0.5) / kSteps, b = (i / kSteps + 0.5) / kSteps;
                        if (area_light.triangle && a + b > 1) continue;
                        const Vec3d at = Vec3d(0, kHeight, 0) + Vec3d(area_light.u) * (a - 0.5) +
                                         Vec3d(area_light.v) * (b - 0.5),
                                    way = at - p;
                        const Vec3d met = p + way / kHeight;
                        const double weight = 1 / sqr(dot(way, way));
                        all += weight;
                        if (std::abs(met.x) > kSide || std::abs(met.z) > kSide) open += weight;
                    }
                    return open / all;
                };
                double sum = 0;
                int dark = 0;
                for (int y = 0; y < kSize; y += 4)
                    for (int x = 0; x < kSize; x += 4) {
                        const double part = expected(floor_point(x, y));
                        sum += std::abs(static_cast<double>(found(x, y)) - part);
                        dark += part == 0;
                    }
                CAPTURE(size);
                CAPTURE(area_light.v.x);
                CAPTURE(area_light.triangle);
                CHECK(dark > 50);
                CHECK(sum / (kSize * kSize / 16) < 0.0115);
            }
    }

    TEST_CASE("a light too thin to have an outline, 1 : 10,000,000, still throws a shadow") {
        Scene scene = floor_scene();
        add(scene, QuadList{{{Vec3(-1, 3, -0.5e-7f), Vec3(1, 0, 0), Vec3(1, 0, 1e-7f)}}}, Mat4(), Emissive{Rgb(1e7f)});
        add(scene, QuadList{{{Vec3(-1, 1, 1), Vec3(2, 0, 0), Vec3(0, 0, -2)}}});
        finish_scene(scene);
        const ImageFloat found = visible(scene, over_floor());
        CHECK(found(kSize / 2, kSize / 2) == 0);
        CHECK(found(2, 2) > 0.9f);
    }

    // Near the contact point the sphere covers only a few shadow map texels between the floor's lit part and the
    // light.
    TEST_CASE("no light in the umbra: a slanting light beside a ball that nearly touches the floor") {
        constexpr double kRadius = 0.86, kMiddle = 0.98;
        Scene scene;
        add(scene, QuadList{{{Vec3(-6, 0, 6), Vec3(12, 0, 0), Vec3(0, 0, -9)}}});
        add(scene, Sphere{Vec3(0, 0.98f, 0), 0.86f});
        add(scene, QuadList{{{Vec3(-3.2f, 2, 0.3f), Vec3(1.2f, 1.6f, 0), Vec3(0, 0, 2)}}}, Mat4(), Emissive{Rgb(12)});
        scene.camera = look({0, 1.9, 5.2}, {0, 0.86, 0});
        finish_scene(scene);
        const ImageFloat found = visible(scene, over_floor(0.1));
        int umbra = 0, lit = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const Vec3d p = floor_point(x, y);
                bool dark = true; // for all points of the light
                for (int i = 0; i < 81 && dark; ++i) {
                    const Vec3d area_light =
                        Vec3d(-3.2, 2, 0.3) + Vec3d(1.2, 1.6, 0) * (i % 9 / 8.0) + Vec3d(0, 0, 2) * (i / 9 / 8.0);
                    const Vec3d way = normalize(area_light - p);
                    const Vec3d to = Vec3d(0, kMiddle, 0) - p;
                    dark = dot(to, way) > 0 && length(to - way * dot(to, way)) < 0.95 * kRadius;
                }
                umbra += dark;
                lit += dark && found(x, y) > 0.15f; // less than one of the light's four pieces
            }
        CHECK(umbra > 1000);
        CHECK(lit == 0);
    }

    TEST_CASE("no grain, no dots at contacts: soft shadows change from pixel to pixel as little as their penumbra "
              "is wide") {
        Scene scene = floor_scene();
        add(scene, QuadList{{{Vec3(-0.5f, 3, -0.5f), Vec3(1, 0, 0), Vec3(0, 0, 1)}}}, Mat4(), Emissive{Rgb(5)});
        add(scene, Sphere{Vec3(0.9f, 0.3f, 0), 0.3f});
        add(scene, QuadList{box_quads(Vec3(-1.2f, 0, -0.3f), Vec3(-0.6f, 0.6f, 0.3f))});
        finish_scene(scene);
        raster::RasterSettings settings = direct_light_only();
        settings.shadow_map_side = 1024;
        for (const int spp : {1, 4}) {
            settings.samples_per_pixel = spp;
            View from_above = over_floor(2);
            const ImageFloat found = visible(scene, from_above, settings);
            int dots = 0, shaded = 0;
            for (int y = 1; y + 1 < kSize; ++y)
                for (int x = 1; x + 1 < kSize; ++x) {
                    float least = 1, most = 0; // of the surrounding pixels
                    for (int i = 0; i < 9; ++i)
                        if (i != 4) {
                            const float other = found(x + i % 3 - 1, y + i / 3 - 1);
                            least = std::min(least, other), most = std::max(most, other);
                        }
                    dots += found(x, y) < least - 0.1f || found(x, y) > most + 0.1f;
                    shaded += found(x, y) < 0.99f;
                }
            CAPTURE(spp);
            CHECK(shaded > 500);
            CHECK(dots == 0);
        }
    }

    // The bowl is a box without a lid. For the wall its rim is the edge of a half-plane, so that what it hides of the
    // light's disk has a closed form.
    TEST_CASE("a light in a bowl: the rim's penumbra to 0.03 in the mean; none below it or behind a second wall") {
        constexpr float kRadius = 0.06f, kSide = 0.3f, kRim = 0.05f, kWall = 3;
        const auto scene_with = [&](bool second_wall) {
            Scene scene;
            QuadList bowl = box_quads(Vec3(-kSide, -0.1f, -kSide), Vec3(kSide, kRim, kSide));
            std::erase_if(bowl.quads, [&](const Quad& quad) {
                return quad.corner.y > 0 && quad.u.y == 0 && quad.v.y == 0; // its lid
            });
            CHECK(bowl.quads.size() == 5);
            add(scene, bowl);
            add(scene, Sphere{Vec3(0, 0, 0), kRadius}, Mat4(), Emissive{Rgb(100)});
            add(scene, QuadList{{{Vec3(kWall, -2, -2), Vec3(0, 0, 4), Vec3(0, 4, 0)}}});
            if (second_wall) add(scene, QuadList{{{Vec3(1, -3, -3), Vec3(0, 0, 6), Vec3(0, 6, 0)}}});
            scene.camera = look({1.5, 0, 0}, {3, 0, 0}, 90);
            finish_scene(scene);
            return scene;
        };
        Scene open = scene_with(false), closed = scene_with(true);
        const View view{open.camera, 64, 300};
        const ImageFloat found = visible(open, view), behind = visible(closed, view);
        CHECK(std::ranges::max(behind) == 0);
        double sum = 0;
        int penumbra = 0;
        for (int y = 0; y < view.height; ++y) {
            // The line from the wall past the rim passes the light's center at this height.
            const double h = (150 - y - 0.5) / 100, at = h + (static_cast<double>(kRim) - h) * 3 / 2.7;
            const double cut = std::clamp(at / static_cast<double>(kRadius), -1.0, 1.0);
            const double expected = (std::acos(cut) - cut * std::sqrt(1 - cut * cut)) / kPiDouble;
            const auto seen = static_cast<double>(found(32, y));
            CAPTURE(h);
            if (expected == 0 && h < 0) CHECK(seen < 0.02);
            sum += std::abs(seen - expected);
            penumbra += expected > 0.05 && expected < 0.95;
        }
        CHECK(penumbra > 50);
        CHECK(sum / view.height < 0.03);
    }

    TEST_CASE("a floor that a glowing ball touches is lit by all of it, in two pieces too") {
        Scene scene;
        add(scene, Sphere{Vec3(0, 0.1f, 0), 0.1f}, Mat4(), Emissive{Rgb(100)});
        add(scene, QuadList{{{Vec3(-5, 0, 5), Vec3(5, 0, 0), Vec3(0, 0, -10)}}});
        add(scene, QuadList{{{Vec3(0, 0, 5), Vec3(5, 0, 0), Vec3(0, 0, -10)}}});
        scene.camera = look({1.6, 1.5, 0.01}, {1.6, 0, 0}, 40);
        finish_scene(scene);
        CHECK(std::ranges::min(visible(scene, {scene.camera, 80, 80})) > 0.99f);
    }

    // Two walls at different distances overlap. The near one hides from the light's center where the other one begins.
    TEST_CASE("no light between two walls that overlap as seen from every point of it") {
        Scene scene;
        add(scene, Sphere{Vec3(0, 0, 0), 0.1f}, Mat4(), Emissive{Rgb(100)});
        add(scene, QuadList{{{Vec3(1, -3, -3), Vec3(0, 0, 3.05f), Vec3(0, 6, 0)}}});
        add(scene, QuadList{{{Vec3(1.4f, -4, -0.02f), Vec3(0, 0, 4), Vec3(0, 8, 0)}}});
        add(scene, QuadList{{{Vec3(4, -9, -9), Vec3(0, 0, 18), Vec3(0, 18, 0)}}});
        scene.camera = look({2.5, 0, 0}, {4, 0, 0}, 40);
        finish_scene(scene);
        CHECK(std::ranges::max(visible(scene, {scene.camera, 160, 80})) == 0);
    }
}
