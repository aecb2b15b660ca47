// These tests check --pixel: it must trace the same sample as the render and log its events.
#include "raytrace/pixel_debug.h"

#include "common/system/error.h"
#include "raytrace/render.h"
#include "tests/raytrace/scene_builder.h"
#include "tests/support/errors.h"

#include <doctest/doctest.h>

#include <limits>
#include <sstream>

using namespace duet;
using namespace duet::raytrace;
using namespace duet::test;

namespace {

Scene lit_room() {
    SceneBuilder builder;
    const std::uint32_t grey = builder.material(Diffuse{{Rgb(0.5f, 0.6f, 0.7f)}});
    const std::uint32_t glass = builder.material(Dielectric{});
    const std::uint32_t area_light = builder.material(Emissive{Rgb(4.0f)});
    builder.add(quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}), grey);
    builder.add(Sphere{{-0.7f, 0, 0}, 1}, glass);
    builder.add(quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), area_light);
    builder.scene.environment = SkyEnvironment{};
    return builder.finish();
}

Rgb logged_radiance(const std::string& text) {
    std::istringstream last(text.substr(text.rfind(": ") + 2));
    Rgb radiance;
    last >> radiance.r >> radiance.g >> radiance.b;
    return radiance;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the first invalid sample is reported, and explained") {
        SceneBuilder builder;
        const std::uint32_t grey = builder.material(Diffuse{{Rgb(0.5f)}});
        const std::uint32_t broken = builder.material(Emissive{Rgb(1.0f)});
        builder.add(quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}), grey);
        builder.add(Sphere{{0.5f, 0.2f, 0}, 0.2f}, broken); // some samples of its silhouette pixels hit it, some do not
        Scene scene = builder.finish();
        scene.materials[broken] = Emissive{Rgb(std::numeric_limits<float>::infinity())}; // finish() would reject it
        const View view{scene.camera, 24, 40};
        PathTracerSettings settings;
        settings.samples_per_pixel = 5;
        settings.first_sample = 2;
        settings.integrator = Integrator::kNaive;
        const PathTracerScene prepared = prepare(scene, settings);
        for (const int threads : {1, 2}) {
            settings.threads = threads;
            Control control;
            const RenderStatistics statistics = render(prepared, view, settings, control).statistics;
            CHECK(statistics.invalid_samples > 0);
            REQUIRE(statistics.first_invalid);
            const auto [sample, y, x] = *statistics.first_invalid;
            CHECK(sample == 2);
            const auto invalid = [&, sample = sample](int i, int j) {
                return debug_pixel(prepared, view, settings, {i, j, sample}).find("invalid: ") != std::string::npos;
            };
            CHECK(invalid(x, y));
            for (int j = 0; j <= y; ++j)
                for (int i = 0; i < (j == y ? x : view.width); ++i) CHECK_FALSE(invalid(i, j));
        }
        Control control;
        const Scene sound = lit_room();
        CHECK_FALSE(render(prepare(sound, settings), view, settings, control).statistics.first_invalid);
    }

    TEST_CASE("the sample that is told is the one that the image has, to the bit") {
        const Scene scene = lit_room();
        const View view{scene.camera, 24, 16};
        for (const Integrator integrator : {Integrator::kPath, Integrator::kNaive, Integrator::kNormal}) {
            PathTracerSettings settings;
            settings.integrator = integrator;
            settings.samples_per_pixel = 1;
            const PathTracerScene prepared = prepare(scene, settings);
            for (const std::uint32_t index : {0u, 5u}) {
                settings.first_sample = index;
                Control control;
                const Rendering rendering = render(prepared, view, settings, control);
                for (int y = 0; y < view.height; ++y)
                    for (int x = 0; x < view.width; ++x)
                        CHECK(logged_radiance(debug_pixel(prepared, view, settings, {x, y, index})) ==
                              rendering.radiance(x, y));
            }
        }
    }

    TEST_CASE("what is told adds up, and names what was hit") {
        const Scene scene = lit_room();
        const View view{scene.camera, 24, 16};
        PathTracerSettings settings;
        const PathTracerScene prepared = prepare(scene, settings);
        bool escaped = false, through = false, hidden = false;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const std::string text = debug_pixel(prepared, view, settings, {x, y, 3});
                Rgbd sum;
                for (std::size_t at = text.find(": adds ("); at != std::string::npos;
                     at = text.find(": adds (", at + 1)) {
                    std::istringstream numbers(text.substr(at + 8));
                    Rgbd light;
                    char comma = 0;
                    numbers >> light.r >> comma >> light.g >> comma >> light.b;
                    sum += light;
                }
                const Rgb radiance = logged_radiance(text);
                for (std::size_t c = 0; c < 3; ++c) CHECK(sum[c] == doctest::Approx(radiance[c]).epsilon(1e-4));
                escaped = escaped || text.find("the ray escapes") != std::string::npos;
                through = through || text.find("through the surface, as a mirror or lens does") != std::string::npos;
                hidden = hidden || text.find("hidden: adds nothing") != std::string::npos;
            }
        CHECK(escaped);
        CHECK(through);
        CHECK(hidden);
    }

    TEST_CASE("samples are named by pixel and number") {
        CHECK(parse_sample_id("12,34").x == 12);
        CHECK(parse_sample_id("12,34").y == 34);
        CHECK(parse_sample_id("12,34").index == 0);
        CHECK(parse_sample_id("0,7,65536").index == 65536);
        for (const char* bad : {"", "1", "1,", "1,2,", "1,2,3,4", "-1,2", "1;2", "a,b", "1,2,3x", "99999999,1"})
            CHECK_MESSAGE(error_of([&] { parse_sample_id(bad); }) == Containing("expected x,y or x,y,sample"), bad);
        const Scene scene = lit_room();
        const PathTracerScene prepared = prepare(scene, {});
        CHECK(error_of([&] {
                  debug_pixel(prepared, View{scene.camera, 8, 8}, {}, {8, 0, 0});
              }) == Containing("expected a pixel"));
    }
}
