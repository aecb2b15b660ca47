// Shadow maps against shadows whose outline is known.
#include "tests/raster/scenes.h"

#include "common/light/lambert.h"
#include "raster/shadow_map.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

constexpr int kSize = 200;      ///< pixels
constexpr double kSquare = 4.0; ///< side of the floor's part in the picture, metres

/// Straight down on [−2, 2]² of the floor, from below all that casts shadows there.
View over_floor(double height = 0.25) {
    Camera camera = look({0, height, 0}, {0, 0, 0});
    camera.projection = Camera::Projection::kOrthographic;
    camera.up = {0, 0, -1};
    camera.height = kSquare;
    return {camera, kSize, kSize};
}
Vec3d floor_point(int x, int y) {
    return {(x + 0.5) * kSquare / kSize - kSquare / 2, 0, (y + 0.5) * kSquare / kSize - kSquare / 2};
}

Scene floor_scene(float half = 4) {
    Scene scene;
    add(scene, QuadList{{{Vec3(-half, 0, half), Vec3(2 * half, 0, 0), Vec3(0, 0, -2 * half)}}});
    scene.camera = over_floor().camera;
    return scene;
}

/// The part of the light that arrives at each pixel.
ImageFloat visible(const Scene& scene, const View& view, raster::Settings settings = {}) {
    const ImageRgb shaded = render(scene, view, settings).radiance;
    settings.shadows = false;
    const ImageRgb open = render(scene, view, settings).radiance;
    ImageFloat result(view.width, view.height);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = open[i].g > 0 ? shaded[i].g / open[i].g : 1;
    return result;
}

/// Visibility against an outline of which `inside` tells how far within it a point is (negative: without): all dark
/// or all lit farther than `reach` from it, and of the right area to `tolerance` metres along `perimeter`.
template <typename Inside>
void check_outline(const ImageFloat& found, const Inside& inside, double reach, double perimeter, double tolerance) {
    constexpr double kPixel = kSquare / kSize;
    double area = 0, expected = 0;
    int wrong = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const double depth = inside(floor_point(x, y));
            area += 1 - static_cast<double>(found(x, y));
            expected += depth > 0;
            if (depth > reach) wrong += found(x, y) > 0;
            if (depth < -reach) wrong += found(x, y) < 1;
        }
    CHECK(wrong == 0);
    // Pixels whose centres decide are themselves off by up to half a pixel along the outline; by 1/8 in the mean.
    CHECK(std::abs(area - expected) * kPixel * kPixel < perimeter * (tolerance + kPixel / 8));
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a sphere under a point light: the shadow is the disk that its tangents draw, to a texel") {
        const double height = 3, center = 1, radius = 0.4;
        Scene scene = floor_scene();
        add(scene, Sphere{Vec3(0, 1, 0), 0.4f});
        scene.lights.push_back(PointLight{Vec3(0, 3, 0), Rgb(20)});
        finish_scene(scene);
        raster::Settings settings;
        settings.shadow_map_side = 1024;
        const double sine = radius / (height - center), edge = height * sine / std::sqrt(1 - sine * sine);
        const double texel = 2 * height / (settings.shadow_map_side / 2 - 8);
        check_outline(visible(scene, over_floor(), settings), [&](Vec3d p) { return edge - length(p); },
                      (raster::ShadowMap::kFilterRadius + 1) * texel, 2 * kPiDouble * edge, texel / 2);
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
            raster::Settings settings;
            settings.shadow_map_side = 1024;
            const double half = sun ? 0.5 : 0.75;
            const Vec3d middle = sun ? Vec3d(0.4, 0, 0.2) : Vec3d();
            const double texel = 8.0 / settings.shadow_map_side; // of the sun's map over all; the spot's is finer
            check_outline(visible(scene, over_floor(), settings),
                          [&](Vec3d p) {
                              const Vec3d d = abs(p - middle);
                              return half - max(d.x, d.z);
                          },
                          (raster::ShadowMap::kFilterRadius + 1) * texel, 8 * half, texel / 2);
        }
    }

    TEST_CASE("no acne: flat and convex surfaces under steep and grazing light are lit as if shadows were off") {
        for (const float lift : {1.0f, 0.1f, 0.01f})
            for (const int side : {64, 2048}) {
                Scene scene = floor_scene();
                add(scene, Sphere{Vec3(1, 3, 0), 0.5f});
                const Vec3 way = normalize(Vec3(-1, -lift, 0.3f));
                scene.lights.push_back(SunLight{way, Rgb(2)});
                scene.lights.push_back(PointLight{way * -20.0f, Rgb(20)});
                scene.lights.push_back(SpotLight{way * -20.0f, way, Rgb(20), 0.99f, 0.98f});
                finish_scene(scene);
                raster::Settings settings;
                settings.shadow_map_side = side;
                // The sphere's own shadow falls beyond the floor or onto it: the sphere is looked at, and the floor
                // where it is in no shadow.
                const View ball{look({4, 3, 4}, {1, 3, 0}, 12), 64, 64};
                for (const float part : visible(scene, ball, settings)) CHECK(part == 1);
                if (lift == 1.0f) continue;
                for (const float part : visible(scene, over_floor(), settings)) CHECK(part == 1);
            }
    }

    TEST_CASE("no leaks: a smooth mesh of coarse facets in the shade of a roof is dark, facets that are turned away, too") {
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
            raster::Settings settings;
            settings.shadow_map_side = 512;
            for (const Vec3d eye : {Vec3d(4, 3, 4), Vec3d(-4, 3, -4)}) {
                const View view{look(eye, {0, 0.2, 0}, 30), 160, 120};
                const ImageRgb shaded = render(scene, view, settings).radiance;
                float brightest = 0;
                for (const Rgb& c : shaded) brightest = max(brightest, c.g);
                CHECK(brightest < 1e-3); // where light grazes by less than a thousandth, filters see past the roof
                raster::Settings open = settings;
                open.shadows = false;
                CHECK(std::ranges::count_if(render(scene, view, open).radiance, [](Rgb c) { return c.g > 0; }) > 5000);
            }
        }
    }

    TEST_CASE("no peter-panning: behind a box that stands on the floor the shadow begins at its foot") {
        Scene scene = floor_scene();
        add(scene, QuadList{box_quads(Vec3(-0.5f, 0, -0.5f), Vec3(0.5f, 1, 0.5f))});
        scene.lights.push_back(SunLight{normalize(Vec3(1, -1, 0)), Rgb(2)}); // the shadow reaches to x = 1.5
        finish_scene(scene);
        raster::Settings settings;
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

    // What a square hides of a square lamp, both parallel to the floor, is where the lines through its corners meet the
    // lamp: the irradiance that arrives is in closed form, too.
    TEST_CASE("a square before a square lamp: the penumbra of the closed form, to 1 % in the mean") {
        Scene scene = floor_scene();
        constexpr float kLamp = 0.5f, kHeight = 3, kSide = 0.6f, kAbove = 1;
        add(scene, QuadList{{{Vec3(-kLamp, kHeight, -kLamp), Vec3(2 * kLamp, 0, 0), Vec3(0, 0, 2 * kLamp)}}}, Mat4(),
            Emissive{Rgb(5)});
        add(scene, QuadList{{{Vec3(-kSide, kAbove, kSide), Vec3(2 * kSide, 0, 0), Vec3(0, 0, -2 * kSide)}}});
        finish_scene(scene);
        for (const int cells : {1, 2, 4}) {
            raster::Settings settings;
            settings.shadow_cells = cells;
            settings.shadow_map_side = 1024;
            const ImageFloat found = visible(scene, over_floor(), settings);
            double sum = 0;
            int penumbra = 0;
            for (int y = 0; y < kSize; y += 4)
                for (int x = 0; x < kSize; x += 4) {
                    const Vec3d p = floor_point(x, y);
                    const auto hidden = [&](double at) { // an interval of the lamp, along one axis
                        const double a = at + (-static_cast<double>(kSide) - at) * static_cast<double>(kHeight / kAbove),
                                     b = at + (static_cast<double>(kSide) - at) * static_cast<double>(kHeight / kAbove);
                        const double lamp = static_cast<double>(kLamp);
                        return Vec2d(std::clamp(a, -lamp, lamp), std::clamp(b, -lamp, lamp));
                    };
                    const Vec2d u = hidden(p.x), v = hidden(p.z);
                    const auto factor = [&](Vec2d a, Vec2d b) {
                        const double h = static_cast<double>(kHeight);
                        const std::array<Vec3, 4> q = {Vec3(Vec3d(a.x, h, b.x)), Vec3(Vec3d(a.y, h, b.x)),
                                                       Vec3(Vec3d(a.y, h, b.y)), Vec3(Vec3d(a.x, h, b.y))};
                        return polygon_form_factor_times_pi(Vec3(p), Vec3(0, 1, 0), q);
                    };
                    const double lamp = static_cast<double>(kLamp), all = factor({-lamp, lamp}, {-lamp, lamp});
                    const double part = u.x < u.y && v.x < v.y ? 1 - factor(u, v) / all : 1;
                    sum += std::abs(static_cast<double>(found(x, y)) - part);
                    penumbra += part > 0.05 && part < 0.95;
                }
            const double error = sum / (kSize * kSize / 16);
            CAPTURE(cells);
            CHECK(penumbra > 100);
            CHECK(error < 0.01);
        }
    }

    // What a square hides of a lamp of any shape, by points all over that.
    TEST_CASE("shadows of squares, slivers of 1 : 10,000, straight and slanting, and thin triangles, from a micrometre to 1000 km") {
        struct Lamp {
            Vec3 u, v;
            bool triangle;
        };
        const std::array<Lamp, 4> lamps{Lamp{Vec3(1, 0, 0), Vec3(0, 0, 1), false}, Lamp{Vec3(1, 0, 0), Vec3(0, 0, 1e-4f), false},
                                        Lamp{Vec3(1, 0, 0), Vec3(1, 0, 1e-4f), false}, Lamp{Vec3(1, 0, 0), Vec3(1, 0, 1e-4f), true}};
        constexpr double kHeight = 3, kSide = 0.6;
        for (const double size : {1e-6, 1.0, 1e6})
            for (const Lamp& lamp : lamps) {
                const float s = static_cast<float>(size);
                Scene scene;
                add(scene, QuadList{{{Vec3(-4, 0, 4) * s, Vec3(8, 0, 0) * s, Vec3(0, 0, -8) * s}}});
                add(scene, QuadList{{{Vec3(-0.6f, 1, 0.6f) * s, Vec3(1.2f, 0, 0) * s, Vec3(0, 0, -1.2f) * s}}});
                const Vec3 corner = (Vec3(0, 3, 0) - (lamp.u + lamp.v) * 0.5f) * s, u = lamp.u * s, v = lamp.v * s;
                Mesh mesh;
                mesh.positions = {corner, corner + u, corner + v};
                mesh.triangles = {{0, 1, 2}};
                add(scene, lamp.triangle ? Shape(mesh) : Shape(QuadList{{{corner, u, v}}}), Mat4(), Emissive{Rgb(5)});
                View view = over_floor();
                view.camera.eye *= size, view.camera.height *= size;
                scene.camera = view.camera;
                finish_scene(scene);
                raster::Settings settings;
                settings.shadow_map_side = 1024;
                settings.shadow_cells = 1;
                const ImageFloat found = visible(scene, view, settings);
                const auto expected = [&](Vec3d p) {
                    constexpr int kSteps = 32;
                    double all = 0, open = 0;
                    for (int i = 0; i < kSteps * kSteps; ++i) {
                        const double a = (i % kSteps + 0.5) / kSteps, b = (i / kSteps + 0.5) / kSteps;
                        if (lamp.triangle && a + b > 1) continue;
                        const Vec3d at = Vec3d(0, kHeight, 0) + Vec3d(lamp.u) * (a - 0.5) + Vec3d(lamp.v) * (b - 0.5), way = at - p;
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
                CAPTURE(lamp.v.x);
                CAPTURE(lamp.triangle);
                CHECK(dark > 50);
                CHECK(sum / (kSize * kSize / 16) < 0.02);
            }
    }

    TEST_CASE("a lamp too thin to have an outline, 1 : 10,000,000, still throws a shadow") {
        Scene scene = floor_scene();
        add(scene, QuadList{{{Vec3(-1, 3, -0.5e-7f), Vec3(1, 0, 0), Vec3(1, 0, 1e-7f)}}}, Mat4(), Emissive{Rgb(1e7f)});
        add(scene, QuadList{{{Vec3(-1, 1, 1), Vec3(2, 0, 0), Vec3(0, 0, -2)}}});
        finish_scene(scene);
        const ImageFloat found = visible(scene, over_floor());
        CHECK(found(kSize / 2, kSize / 2) == 0);
        CHECK(found(2, 2) > 0.9f);
    }

    // From close under the ball it covers but a few of the texels between the floor's lit part and the lamp.
    TEST_CASE("no light in the umbra: a slanting lamp beside a ball that nearly touches the floor") {
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
                bool dark = true; // however many points of the lamp
                for (int i = 0; i < 81 && dark; ++i) {
                    const Vec3d way = normalize(Vec3d(-3.2, 2, 0.3) + Vec3d(1.2, 1.6, 0) * (i % 9 / 8.0) + Vec3d(0, 0, 2) * (i / 9 / 8.0) - p);
                    const Vec3d to = Vec3d(0, kMiddle, 0) - p;
                    dark = dot(to, way) > 0 && length(to - way * dot(to, way)) < 0.95 * kRadius;
                }
                umbra += dark;
                lit += dark && found(x, y) > 0.15f; // less than one of the lamp's four pieces
            }
        CHECK(umbra > 1000);
        CHECK(lit == 0);
    }

    TEST_CASE("no grain, no dots at contacts: soft shadows change from pixel to pixel as little as their penumbra is wide") {
        Scene scene = floor_scene();
        add(scene, QuadList{{{Vec3(-0.5f, 3, -0.5f), Vec3(1, 0, 0), Vec3(0, 0, 1)}}}, Mat4(), Emissive{Rgb(5)});
        add(scene, Sphere{Vec3(0.9f, 0.3f, 0), 0.3f});
        add(scene, QuadList{box_quads(Vec3(-1.2f, 0, -0.3f), Vec3(-0.6f, 0.6f, 0.3f))});
        finish_scene(scene);
        raster::Settings settings;
        settings.shadow_map_side = 1024;
        for (const int spp : {1, 4}) {
            settings.samples_per_pixel = spp;
            View from_above = over_floor(2);
            const ImageFloat found = visible(scene, from_above, settings);
            int dots = 0, shaded = 0;
            for (int y = 1; y + 1 < kSize; ++y)
                for (int x = 1; x + 1 < kSize; ++x) {
                    float least = 1, most = 0; // of the pixels around
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

    TEST_CASE("a cut-out lattice under each kind of light: dark and light cells where the light's rays take them, to a texel") {
        enum { kSun, kSpot, kPoint };
        for (const int kind : {kSun, kSpot, kPoint}) {
            Scene scene = floor_scene();
            add(scene, QuadList{{{Vec3(-0.5f, 1, 0.5f), Vec3(1, 0, 0), Vec3(0, 0, -1)}}});
            scene.textures.textures = {CheckerTexture{Rgb(1), Rgb(0), 4}};
            scene.maps.resize(2);
            scene.maps[1].opacity = {1, 0};
            scene.maps[1].cutoff = 0.5f;
            const Vec3 way = normalize(Vec3(0.4f, -1, 0.2f));
            if (kind == kSun) scene.lights.push_back(SunLight{way, Rgb(2)});
            if (kind == kSpot) scene.lights.push_back(SpotLight{Vec3(0, 3, 0), Vec3(0, -1, 0), Rgb(20), 0.8f, 0.7f});
            if (kind == kPoint) scene.lights.push_back(PointLight{Vec3(0, 3, 0), Rgb(20)});
            finish_scene(scene);
            raster::Settings settings;
            settings.shadow_map_side = 2048;
            const double half = kind == kSun ? 0.5 : 0.75, cell = half / 2;
            const Vec3d middle = kind == kSun ? Vec3d(0.4, 0, 0.2) : Vec3d();
            const double texel = 8.0 / (settings.shadow_map_side / (kind == kPoint ? 2 : 1));
            CAPTURE(kind);
            check_outline(visible(scene, over_floor(), settings),
                          [&](Vec3d p) {
                              const double x = p.x - middle.x + half, z = middle.z + half - p.z; // along u and v
                              const double beyond = half - max(std::abs(x - half), std::abs(z - half));
                              if (beyond < 0) return beyond;
                              const auto to_line = [&](double at) { return std::abs(at - std::round(at / cell) * cell); };
                              const bool even = (static_cast<int>(x / cell) + static_cast<int>(z / cell)) % 2 == 0;
                              return even ? min(to_line(x), to_line(z)) : -min(to_line(x), to_line(z));
                          },
                          (raster::ShadowMap::kFilterRadius + 1) * texel, 8 * 4 * cell, texel / 2);
        }
    }

    // The texels' numbers are a fixed dither, of which the filter of hard shadows leaves one rank of 16: half a sixteenth,
    // rms, at most. Soft shadows leave more. Were they as random as 0.2 rms of the light is wide, a mean of 3300 and more
    // pixels would be off by 0.017 or more with a chance of 10^-6.
    TEST_CASE("veils let the part of the light through that they do not stop, one or stacked, quads and balls, whatever the light") {
        enum { kSun, kSpot, kPoint, kLamp };
        struct Veils {
            int count;
            float opacity;
            bool ball;
        };
        for (const Veils veils : {Veils{1, 0.5f, false}, Veils{1, 0.45f, false}, Veils{1, 0.1f, false}, Veils{2, 0.5f, false},
                                  Veils{3, 0.3f, false}, Veils{1, 0.4f, true}})
            for (const int kind : {kSun, kSpot, kPoint, kLamp}) {
                Scene scene = floor_scene();
                for (int i = 0; i < veils.count; ++i) {
                    const float y = 1 + 0.1f * static_cast<float>(i);
                    add(scene, veils.ball ? Shape(Sphere{Vec3(0, 1, 0), 0.8f}) : Shape(QuadList{{{Vec3(-1, y, 1), Vec3(2, 0, 0), Vec3(0, 0, -2)}}}));
                    scene.maps.resize(scene.materials.size());
                    scene.maps.back().opacity = veils.opacity;
                }
                if (kind == kSun) scene.lights.push_back(SunLight{normalize(Vec3(0.1f, -1, 0.05f)), Rgb(2)});
                if (kind == kSpot) scene.lights.push_back(SpotLight{Vec3(0, 4, 0), Vec3(0, -1, 0), Rgb(20), 0.8f, 0.7f});
                if (kind == kPoint) scene.lights.push_back(PointLight{Vec3(0, 4, 0), Rgb(20)});
                if (kind == kLamp)
                    add(scene, QuadList{{{Vec3(-0.1f, 4, -0.1f), Vec3(0.2f, 0, 0), Vec3(0, 0, 0.2f)}}}, Mat4(), Emissive{Rgb(50)});
                finish_scene(scene);
                const ImageFloat found = visible(scene, over_floor(0.1));
                double sum = 0, squares = 0;
                int pixels = 0;
                for (int y = 0; y < kSize; ++y)
                    for (int x = 0; x < kSize; ++x) {
                        const Vec3d p = floor_point(x, y); // where both sides of the ball are between it and the light
                        if (veils.ball ? length(p) > 0.65 : max(std::abs(p.x), std::abs(p.z)) > 0.8) continue;
                        sum += static_cast<double>(found(x, y));
                        squares += sqr(static_cast<double>(found(x, y)));
                        ++pixels;
                    }
                const double mean = sum / pixels, rms = std::sqrt(max(squares / pixels - sqr(mean), 0.0));
                CAPTURE(kind);
                CAPTURE(veils.count);
                CAPTURE(veils.opacity);
                CAPTURE(veils.ball);
                CHECK(pixels >= 3300);
                CHECK(std::abs(mean - std::pow(1 - static_cast<double>(veils.opacity), veils.ball ? 2 : veils.count)) < 0.017);
                CHECK(rms < (kind == kLamp ? 0.22 : 1.0 / 32 + 0.002));
            }
    }

    TEST_CASE("what may be seen through does not shade itself, and a veil is shaded by what is whole before it") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-2, 0, 2), Vec3(4, 0, 0), Vec3(0, 0, -4)}}});
        scene.maps.resize(1);
        scene.maps[0].opacity = 0.5f;
        scene.camera = over_floor().camera;
        scene.lights.push_back(SunLight{normalize(Vec3(0.4f, -1, 0.2f)), Rgb(2)});
        Scene shaded = scene;
        finish_scene(scene);
        for (const float part : visible(scene, over_floor())) CHECK(part == 1);
        add(shaded, QuadList{{{Vec3(-3, 1, 3), Vec3(6, 0, 0), Vec3(0, 0, -6)}}});
        finish_scene(shaded);
        CHECK(visible(shaded, over_floor())(kSize / 2, kSize / 2) == 0);
    }

    TEST_CASE("what moves does not shade itself by its own motion, and leaves a blurred shadow") {
        Scene scene = floor_scene();
        Object& ball = add(scene, Sphere{Vec3(0, 0, 0), 0.3f}, translation(Vec3(-1, 1, 0)));
        ball.moving = true;
        ball.to_world_end = translation(Vec3(1, 1, 0));
        scene.lights.push_back(SunLight{normalize(Vec3(0.1f, -1, 0.1f)), Rgb(2)});
        finish_scene(scene);
        raster::Settings settings;
        settings.samples_per_pixel = 16;
        View from_above = over_floor(3);
        // In the middle of its way the ball covers its own shadow but for the slant; far beside it all is lit.
        const ImageFloat above = visible(scene, from_above, settings), floor = visible(scene, over_floor(), settings);
        double least = 1;
        for (int x = 60; x < 140; ++x) least = std::min(least, static_cast<double>(floor(x, kSize / 2 + 5)));
        CHECK(least > 0.3); // at most 0.6 m of 2 m at a time
        CHECK(least < 0.9);
        CHECK(above(10, 10) == 1);
        // The ball alone, no floor to be shaded: its light is all there.
        Scene alone;
        Object& other = add(alone, Sphere{Vec3(0, 0, 0), 0.3f}, translation(Vec3(-1, 1, 0)));
        other.moving = true;
        other.to_world_end = translation(Vec3(1, 1, 0));
        alone.lights = scene.lights;
        alone.camera = scene.camera;
        finish_scene(alone);
        for (const float part : visible(alone, from_above, settings)) CHECK(part == 1);
    }

    TEST_CASE("the same bits for any number of threads; a size or a number of pieces out of range is refused") {
        Scene scene = floor_scene();
        add(scene, torus(24, 12), translation(Vec3(0, 0.5f, 0)));
        add(scene, QuadList{{{Vec3(-0.5f, 3, -0.5f), Vec3(1, 0, 0), Vec3(0, 0, 1)}}}, Mat4(), Emissive{Rgb(5)});
        scene.lights.push_back(PointLight{Vec3(1, 2, 1), Rgb(3)});
        scene.lights.push_back(SunLight{normalize(Vec3(1, -1, 0)), Rgb(2)});
        finish_scene(scene);
        raster::Settings settings;
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
