#include "raster/lighting/environment_sun.h"

#include "common/scene/scene.h"
#include "raster/lighting/environment_irradiance.h"
#include "raster/lighting/latlong_grid.h"
#include "raster/render.h"
#include "tests/raster/path_traced.h"

#include <doctest/doctest.h>

#include <string>
#include <utility>

using namespace duet;
using namespace duet::raster;
using test::mean_green;

namespace {

constexpr int kWidth = 1024; ///< a pixel has 0.35 degrees

/// Returns an image of a function of the direction.
template <typename F> Environment shown_image(F radiance_of, float rotation = 0) {
    const LatlongGrid grid{kWidth, kWidth / 2};
    ImageRgb image(grid.width, grid.height);
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) image(x, y) = radiance_of(grid.direction(x, y));
    return make_image_environment(std::move(image), 1, rotation);
}

/// Returns a sky with a disk of added radiance around a unit direction, whose radius is given in degrees.
Environment sky_with_disk(const Vec3d& sun, double degrees, Rgb added, float rotation = 0) {
    return shown_image([&, cosine = std::cos(radians(degrees))](const Vec3d& w) {
        return Rgb(0.5f, 0.6f, 0.9f) + (dot(w, sun) > cosine ? added : Rgb());
    }, rotation);
}

std::optional<EnvironmentSun> sun_of(const Environment& environment) { return find_sun(environment, 2); }

double solid_angle_of_disk(double degrees) { return 2 * kPiDouble * (1 - std::cos(radians(degrees))); }

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the sun of an image has its direction and irradiance") {
        const Vec3d toward = normalize(Vec3d(0.3, 0.5, -0.7));
        const auto sun = sun_of(sky_with_disk(toward, 4, Rgb(100, 80, 60)));
        REQUIRE(sun);
        CHECK(dot(-Vec3d(sun->light.direction), toward) > std::cos(radians(0.05)));
        CHECK(sun->sine == doctest::Approx(std::sin(radians(4.0))).epsilon(0.005).scale(0));
        for (std::size_t c = 0; c < 3; ++c) {
            const double expected = solid_angle_of_disk(4) * static_cast<double>(Rgb(100, 80, 60)[c]);
            // The pixels at the disk's edge lie either in it or not.
            CHECK(sun->light.irradiance[c] == doctest::Approx(expected).epsilon(0.006).scale(0));
            CHECK(sun->around[c] == doctest::Approx(Rgb(0.5f, 0.6f, 0.9f)[c]).epsilon(1e-5));
        }
    }

    TEST_CASE("the sun turns with the image") {
        const auto sun = sun_of(sky_with_disk({0, 0, -1}, 4, Rgb(100.0f), kPi / 2));
        REQUIRE(sun);
        // The image's middle column is −z. A quarter turn, counter-clockwise seen from above, leads to −x.
        CHECK(dot(-sun->light.direction, Vec3(-1, 0, 0)) > 0.9999f);
    }

    TEST_CASE("without a small bright disk there is no sun") {
        CHECK_FALSE(sun_of(Environment(ConstantEnvironment{Rgb(1.0f)})));
        CHECK_FALSE(sun_of(Environment(SkyEnvironment{})));
        CHECK_FALSE(sun_of(shown_image([](const Vec3d&) { return Rgb(); })));
        CHECK_FALSE(sun_of(shown_image([](const Vec3d&) { return Rgb(1.0f); })));
        CHECK_FALSE(sun_of(shown_image([](const Vec3d& w) { return Rgb(static_cast<float>(1 + w.y)); })));
        CHECK_FALSE(sun_of(sky_with_disk({0, 1, 0}, 4, Rgb(1.0f))));   // adds 0.2 % of the light
        CHECK_FALSE(sun_of(sky_with_disk({0, 1, 0}, 30, Rgb(100.0f)))); // casts no sharp shadow
        for (const auto& [width, height] : {std::pair(1, 1), std::pair(2, 1), std::pair(8, 4), std::pair(40, 20)})
            CHECK_FALSE(sun_of(make_image_environment(ImageRgb(width, height, Rgb(1.0f)), 1, 0)));
    }

    TEST_CASE("the sun and the rest together are the whole environment") {
        const Vec3d toward = normalize(Vec3d(0.4, 0.8, 0.1));
        const Environment environment = sky_with_disk(toward, 2, Rgb(300.0f));
        const auto sun = sun_of(environment);
        REQUIRE(sun);
        const LatlongGrid grid{kWidth, kWidth / 2};
        Rgbd whole, rest;
        for (int y = 0; y < grid.height; ++y)
            for (int x = 0; x < grid.width; ++x) {
                const Vec3 w(grid.direction(x, y));
                const Rgb arriving = radiance(environment, w);
                whole += Rgbd(arriving) * grid.solid_angle(y);
                rest += Rgbd(sun->without_sun(w, arriving)) * grid.solid_angle(y);
            }
        for (std::size_t c = 0; c < 3; ++c)
            CHECK(rest[c] + static_cast<double>(sun->light.irradiance[c]) ==
                  doctest::Approx(whole[c]).epsilon(1e-6).scale(0));
        // Without the sun, second-order harmonics represent this sky exactly.
        const IrradianceHarmonics harmonic = environment_irradiance(environment, &*sun, 2);
        for (const Vec3 n : {Vec3(0, 1, 0), Vec3(toward), Vec3(-toward)})
            CHECK(irradiance_at(harmonic, harmonics(n)).g == doctest::Approx(0.6 * kPiDouble).epsilon(1e-3).scale(0));
    }

    TEST_CASE("the sun of an image casts a shadow") {
        // These are the middle of the ball's shadow, its penumbra, which is from 0.37 to 0.63, and a place beside it.
        for (const char* at : {"0", "0.44", "0.5", "0.56", "2"}) {
            CAPTURE(at);
            Scene scene = parse_scene("test.json", std::string(R"({
                "camera": {"eye": [0, 3, 8], "look_at": [)") + at + R"(, 0, 0], "fov_degrees": 2},
                "image": {"width": 24, "height": 24}, "environment": {"type": "constant", "radiance": 1},
                "materials": {"white": {"type": "diffuse", "albedo": 0.5}},
                "objects": [{"type": "quad", "corner": [-9, 0, 9], "u": [18, 0, 0], "v": [0, 0, -18],
                             "material": "white"},
                            {"type": "sphere", "center": [0, 1.5, 0], "radius": 0.5, "material": "white"}]})");
            scene.environment = sky_with_disk({0, 1, 0}, 5, Rgb(48.0f));
            const View view{scene.camera, scene.width, scene.height};
            const raster::RasterSettings settings;
            Control control;
            const ImageRgb image = raster::render(raster::prepare(scene, settings), view, settings, control).radiance;
            const double found = mean_green(image), expected = mean_green(test::path_traced(scene, view, 64));
            // The measured error is 8 % in the middle of the shadow, and 3 % elsewhere.
            CHECK(found == doctest::Approx(expected).epsilon(0.1).scale(0));
        }
    }

    TEST_CASE("fog scatters the light of the sun and of the sky, each once") {
        Scene scene = parse_scene("test.json", R"({
            "camera": {"eye": [0, 0, 8], "look_at": [0, 0, 0], "fov_degrees": 4}, "image": {"width": 24, "height": 24},
            "environment": {"type": "constant", "radiance": 1},
            "materials": {"black": {"type": "diffuse", "albedo": 0}},
            "objects": [{"type": "quad", "corner": [-2, -2, -20], "u": [4, 0, 0], "v": [0, 4, 0], "material": "black"}],
            "media": [{"type": "fog", "low": [-2, -2, -2], "high": [2, 2, 2], "scattering": 0.05}]})");
        scene.environment = sky_with_disk(normalize(Vec3d(0.2, 1, 0.3)), 5, Rgb(480.0f));
        const View view{scene.camera, scene.width, scene.height};
        const double expected = mean_green(test::path_traced(scene, view, 256));
        for (const bool indirect : {false, true}) {
            CAPTURE(indirect);
            raster::RasterSettings settings;
            settings.indirect_light = indirect;
            Control control;
            const ImageRgb image = raster::render(raster::prepare(scene, settings), view, settings, control).radiance;
            // The measured value is 10 % less, because some light that fog scatters more than once is left out.
            CHECK(mean_green(image) == doctest::Approx(expected).epsilon(0.12).scale(0));
        }
    }
}
