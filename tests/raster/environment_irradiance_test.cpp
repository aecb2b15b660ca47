#include "raster/lighting/environment_irradiance.h"

#include "raster/lighting/latlong_grid.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;
using namespace duet::raster;

namespace {

/// Returns a lat-long image of a function of direction.
template <typename F> Environment shown_image(int width, F radiance_of, float rotation = 0) {
    const LatlongGrid grid{width, width / 2};
    ImageRgb image(grid.width, grid.height);
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) image(x, y) = radiance_of(Vec3(grid.direction(x, y)));
    return make_image_environment(std::move(image), 1, rotation);
}

std::vector<Vec3> directions() {
    std::mt19937 engine(3);
    std::normal_distribution<float> normal;
    std::vector<Vec3> result{{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0, 0, -1}};
    for (int i = 0; i < 60; ++i) result.push_back(normalize(Vec3(normal(engine), normal(engine), normal(engine))));
    return result;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("an image of a constant gives π times it") {
        const Environment environment = shown_image(64, [](Vec3) { return Rgb(0.5f, 1.0f, 2.0f); });
        const IrradianceHarmonics coefficients = environment_irradiance(environment, nullptr, 2);
        for (const Vec3 n : directions()) {
            const Rgb e = irradiance_at(coefficients, harmonics(n));
            CHECK(e.r == doctest::Approx(0.5 * kPiDouble).epsilon(1e-3));
            CHECK(e.g == doctest::Approx(1.0 * kPiDouble).epsilon(1e-3));
            CHECK(e.b == doctest::Approx(2.0 * kPiDouble).epsilon(1e-3));
        }
    }

    TEST_CASE("an image of the sky gradient gives the sky's closed form") {
        const SkyEnvironment sky{{1.0f, 0.8f, 0.6f}, {0.2f, 0.5f, 1.0f}};
        const Environment closed = sky;
        const Environment environment = shown_image(256, [&](Vec3 w) { return lerp(sky.down, sky.up, (w.y + 1) / 2); });
        const IrradianceHarmonics exactly = environment_irradiance(closed, nullptr, 1);
        const IrradianceHarmonics coefficients = environment_irradiance(environment, nullptr, 2);
        // The radiance is linear in the direction, so spherical harmonics of the first order are exact except for the
        // image's resolution.
        for (const Vec3 n : directions())
            for (std::size_t c = 0; c < 3; ++c) {
                const float exact = (*irradiance_closed_form(closed, n))[c];
                CHECK(irradiance_at(exactly, harmonics(n))[c] == doctest::Approx(exact).epsilon(1e-5));
                CHECK(irradiance_at(coefficients, harmonics(n))[c] == doctest::Approx(exact).epsilon(2e-3));
            }
    }

    TEST_CASE("second-order detail, and the image's rotation, against the integral") {
        const auto light = [](Vec3 w) { return Rgb(1 + w.x * w.z + 0.5f * w.y * w.y, 1 + 0.4f * w.x, 1 - w.x * w.y); };
        const Environment environment = shown_image(256, light, 0.7f);
        const IrradianceHarmonics coefficients = environment_irradiance(environment, nullptr, 2);
        for (const Vec3 n : {Vec3(0, 1, 0), Vec3(1, 0, 0), normalize(Vec3(1, 2, 3)), normalize(Vec3(-1, -1, 0.5f))}) {
            Rgbd sum;
            constexpr int kRings = 200, kSectors = 400;
            for (int i = 0; i < kRings; ++i)
                for (int k = 0; k < kSectors; ++k) {
                    const double y = 1 - 2 * (i + 0.5) / kRings, phi = 2 * kPiDouble * (k + 0.5) / kSectors;
                    const double ring = std::sqrt(1 - y * y);
                    const Vec3 w(Vec3d(ring * std::cos(phi), y, ring * std::sin(phi)));
                    const double weight =
                        static_cast<double>(max(0.0f, dot(w, n))) * 4 * kPiDouble / (kRings * kSectors);
                    sum += Rgbd(radiance(environment, w)) * weight;
                }
            for (std::size_t c = 0; c < 3; ++c)
                CHECK(irradiance_at(coefficients, harmonics(n))[c] == doctest::Approx(sum[c]).epsilon(3e-3));
        }
    }

    TEST_CASE("a small bright sun never gives negative irradiance") {
        const Environment environment = shown_image(128, [](Vec3 w) { return w.y > 0.99f ? Rgb(1000.0f) : Rgb(0.0f); });
        const IrradianceHarmonics coefficients = environment_irradiance(environment, nullptr, 2);
        for (const Vec3 n : directions()) {
            const Rgb e = irradiance_at(coefficients, harmonics(n));
            CHECK(min(min(e.r, e.g), e.b) >= 0);
        }
    }

    TEST_CASE("the projection is the same for any number of threads") {
        const Environment environment = shown_image(128, [](Vec3 w) { return Rgb(1 + w.x, 1 + w.y, 1 + w.z); });
        CHECK(environment_irradiance(environment, nullptr, 1) == environment_irradiance(environment, nullptr, 7));
    }
}
