// These tests check the mapping, the sampling and the irradiance of environments.
#include "common/geometry/sphere.h"
#include "common/light/environment.h"
#include "common/sampling/warp.h"
#include "common/vec/matrix.h"
#include "compare/stress/chi_squared.h"
#include "raytrace/sampling/sampler.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace duet;

namespace {

/// Returns the unit direction at (u, v) of a lat-long image. This is the inverse of latlong_uv.
Vec3 latlong_direction(Vec2 uv) {
    const Vec3 d = sphere_direction(uv);
    return {d.x, d.y, -d.z};
}

/// Returns an image with smooth variation, a black region, a bright sun and a bright pixel at the seam.
ImageRgb shown_image(int width, int height) {
    ImageRgb image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float s = static_cast<float>(x) / static_cast<float>(width),
                        t = static_cast<float>(y) / static_cast<float>(height);
            const float hill = s > 0.5f && s < 0.7f ? 0.0f : 0.5f + 0.4f * std::sin(9 * s) * std::cos(5 * t);
            image(x, y) = {hill, 0.7f * hill, 0.3f};
            if (s > 0.5f && s < 0.7f) image(x, y) = {};
        }
    image(width / 4, height / 3) = Rgb(40.0f);
    image(0, height / 2) = {0, 0, 20};
    return image;
}

struct Named {
    std::string name;
    Environment environment;
    bool sampled = true; // true if its variation is large enough for importance sampling
};
std::vector<Named> environments() {
    std::vector<Named> all;
    all.push_back({"constant", ConstantEnvironment{Rgb(1, 2, 3)}, false});
    all.push_back({"sky", SkyEnvironment{}, false});
    all.push_back({"sky, black below", SkyEnvironment{Rgb(0.0f), Rgb(0.1f, 0.2f, 5)}, false});
    all.push_back({"sky, black above", SkyEnvironment{Rgb(3.0f), Rgb(0.0f)}, false});
    all.push_back({"picture", make_image_environment(shown_image(32, 16), 2, 0)});
    all.push_back({"image, turned", make_image_environment(shown_image(24, 9), 0.5f, 1.1f)});
    all.push_back({"one pixel", make_image_environment(ImageRgb(1, 1, Rgb(0.25f)), 4, 2), false});
    return all;
}

/// Calls f(u, corner) for 64 × 64 points inside the unit square and for points along its border.
template <typename F> void for_numbers(F f) {
    for (int i = 0; i < 64; ++i) {
        const float x = (static_cast<float>(i) + 0.37f) / 64, last = kOneMinusEpsilon;
        for (int j = 0; j < 64; ++j) f(Vec2{x, (static_cast<float>(j) + 0.59f) / 64}, false);
        for (const Vec2 u : {Vec2{x, 0}, Vec2{x, last}, Vec2{0, x}, Vec2{last, x}, Vec2{0, 0}, Vec2{last, last}})
            f(u, true);
    }
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a sample's radiance and density are those of its direction; corners of the square are safe") {
        for (const Named& named : environments()) {
            const Environment& e = named.environment;
            CAPTURE(named.name);
            CHECK_FALSE(is_black(e));
            int mismatches = 0;
            CHECK((sampled_irradiance(e) > 0) == named.sampled);
            for_numbers([&](Vec2 u, bool corner) {
                const auto s = sample(e, u);
                REQUIRE(s.has_value() == named.sampled);
                if (!s) return;
                REQUIRE(length(s->wi) == doctest::Approx(1).epsilon(1e-6));
                REQUIRE((s->pdf > 0 && std::isfinite(s->pdf)));
                REQUIRE(s->radiance == radiance(e, s->wi));
                mismatches += !corner && std::abs(pdf(e, s->wi) - s->pdf) > 1e-4f * s->pdf;
            });
            // Rounding may move a sample that is next to a cell's border into the neighboring cell.
            CHECK(mismatches <= 2);
        }
    }

    TEST_CASE("the density is positive just where there is more light than the mean, also at the poles and the seam") {
        for (const Named& named : environments()) {
            const Environment& e = named.environment;
            CAPTURE(named.name);
            int dark = 0, dark_sampled = 0;
            for (int i = 0; i < 200; ++i)
                for (int j = 0; j <= 200; ++j) {
                    const Vec3 w = latlong_direction({static_cast<float>(i) / 200, static_cast<float>(j) / 200});
                    const float density = pdf(e, w);
                    REQUIRE((std::isfinite(density) && density >= 0));
                    REQUIRE(is_finite(radiance(e, w)));
                    const float light = luminance(radiance(e, w)), mean = luminance(mean_radiance(e));
                    if (!named.sampled)
                        REQUIRE(density == 0);
                    else if (light > 20 * mean)
                        REQUIRE(density > 0);
                    dark += light < 0.5f * mean;
                    dark_sampled += light < 0.5f * mean && density > 0;
                }
            CHECK(dark_sampled * 10 <= dark); // except for cells that bilinear filtering mixes with brighter neighbors
            CHECK(std::isfinite(pdf(e, {0, 1, 0})));
            CHECK(std::isfinite(pdf(e, {0, -1, 0})));
        }
    }

    TEST_CASE("the image: row 0 on top, its middle column at −z, counter-clockwise turns, no seam") {
        ImageRgb image(8, 4, Rgb(0.0f));
        image(4, 0) = Rgb(1.0f); // just right of the center, in the top row
        image(6, 2) = Rgb(2.0f);
        const Environment e = make_image_environment(image, 3, 0);
        const auto at = [](int x, int y) { // the direction of a pixel's center
            return latlong_direction({(static_cast<float>(x) + 0.5f) / 8, 1 - (static_cast<float>(y) + 0.5f) / 4});
        };
        CHECK(radiance(e, at(4, 0)).r == doctest::Approx(3).epsilon(1e-5));
        CHECK(radiance(e, at(6, 2)).r == doctest::Approx(6).epsilon(1e-5));
        CHECK(at(4, 0).y > 0);
        CHECK(at(4, 0).z < 0);
        CHECK(at(6, 2).x > 0); // u = ½ + atan2(x, −z)/2π, so right of the center is +x
        const float turn = 0.8f;
        const Environment turned = make_image_environment(image, 3, turn);
        const Mat4 rotate = rotation(Vec3(0, 1, 0), turn);
        for (int i = 0; i < 100; ++i) {
            const Vec3 w = latlong_direction({static_cast<float>(i) / 100, static_cast<float>((i * 37) % 100) / 100});
            CHECK(radiance(turned, transform_vector(rotate, w)).r == doctest::Approx(radiance(e, w).r).epsilon(1e-4));
        }
        ImageRgb ramp(16, 8);
        for (int x = 0; x < 16; ++x)
            for (int y = 0; y < 8; ++y) ramp(x, y) = Rgb(1 + std::abs(7.5f - static_cast<float>(x)));
        const Environment seam = make_image_environment(ramp, 1, 0);
        CHECK(radiance(seam, normalize(Vec3(1e-5f, 0, 1))).r ==
              doctest::Approx(radiance(seam, normalize(Vec3(-1e-5f, 0, 1))).r));
        CHECK(radiance(seam, {0, 0, 1}).r == doctest::Approx(8.5));
    }

    TEST_CASE("black environments give no samples; a bad image is refused") {
        const Environment dark[] = {ConstantEnvironment{}, SkyEnvironment{Rgb(0.0f), Rgb(0.0f)},
                                    make_image_environment(ImageRgb(4, 2), 1, 0),
                                    make_image_environment(ImageRgb(4, 2, Rgb(1.0f)), 0, 0), ImageEnvironment{}};
        for (const Environment& e : dark) {
            CHECK(is_black(e));
            CHECK_FALSE(sample(e, {0.5f, 0.5f}).has_value());
            CHECK(pdf(e, {0, 1, 0}) == 0);
            CHECK(is_black(radiance(e, {0, 1, 0})));
            CHECK(is_black(mean_radiance(e)));
        }
        CHECK_THROWS_AS(make_image_environment({}, 1, 0), Error);
        CHECK_THROWS_AS(make_image_environment(ImageRgb(2, 2, Rgb(std::nanf(""))), 1, 0), Error);
        CHECK_THROWS_AS(make_image_environment(ImageRgb(2, 2, Rgb(kInfinity)), 1, 0), Error);
        CHECK_THROWS_AS(make_image_environment(ImageRgb(2, 2), -1, 0), Error);
        CHECK_THROWS_AS(make_image_environment(ImageRgb(2, 2), 1, kInfinity), Error);
        CHECK(radiance(make_image_environment(ImageRgb(2, 2, Rgb(-1, 2, 3)), 1, 0), {0, 1, 0}) == Rgb(0, 2, 3));
    }
}

TEST_SUITE("statistical") {
    TEST_CASE("directions are distributed as pdf says, which integrates to 1") {
        const auto all = environments();
        for (const Named& named : all) { // significance 1e-4 for all environments together
            if (!named.sampled) continue;
            compare::DirectionTest setup;
            setup.axis = {0, 1, 0};
            setup.subdivisions = 12; // an image's density has steps within cells
            const auto result = compare::test_directions(
                setup,
                [&](Vec2 u) -> std::optional<Vec3> {
                    const auto s = sample(named.environment, u);
                    return s ? std::optional<Vec3>(s->wi) : std::nullopt;
                },
                [&](Vec3 w) { return static_cast<double>(pdf(named.environment, w)); });
            CAPTURE(named.name);
            CHECK(result.integral == doctest::Approx(1).epsilon(3e-3));
            CHECK_MESSAGE(result.chi_squared.p_value > compare::sidak_level(1e-4, static_cast<int>(all.size())),
                          result.chi_squared.details);
        }
    }

    TEST_CASE("irradiance and mean radiance agree with sampling") {
        // The tolerance is 4.5 standard errors, so a false alarm has odds of 7e-6 per comparison.
        for (const Named& named : environments())
            for (const Vec3 n : {Vec3(0, 1, 0), normalize(Vec3(0.5f, -0.7f, 0.2f))}) {
                const Environment& e = named.environment;
                CAPTURE(named.name);
                constexpr int kSamples = 100'000;
                Sampler sampler(SamplerKind::kIndependent, 9, kSamples);
                double sum = 0, squares = 0, mean = 0, mean_squares = 0, uniform = 0, uniform_squares = 0;
                for (int i = 0; i < kSamples; ++i) {
                    sampler.start(0, 0, static_cast<std::uint32_t>(i));
                    // Every second direction is sampled from the environment and the others uniformly, weighted by
                    // the balance heuristic. The uniform ones are needed because radiance at or below the mean is
                    // never sampled from the environment.
                    const Vec2 u = sampler.get_2d();
                    const auto s = i % 2 == 0 && named.sampled ? sample(e, u) : std::nullopt;
                    const Vec3 wi = s ? s->wi : uniform_sphere(u);
                    const float density = named.sampled ? 0.5f * (pdf(e, wi) + kUniformSpherePdf) : kUniformSpherePdf;
                    const double whole = static_cast<double>(radiance(e, wi).g / density);
                    const double value = whole * static_cast<double>(std::max(0.0f, dot(wi, n)));
                    sum += value / kSamples, squares += value * value / kSamples;
                    mean += whole / kSamples, mean_squares += whole * whole / kSamples;
                    // Uniform directions do not depend on the environment's sampling.
                    const Vec3 w = uniform_sphere(sampler.get_2d());
                    const double other =
                        static_cast<double>(radiance(e, w).g * std::max(0.0f, dot(w, n)) / kUniformSpherePdf);
                    uniform += other / kSamples, uniform_squares += other * other / kSamples;
                }
                const double variance = (squares - sum * sum) / kSamples;
                const double mean_variance = std::max(0.0, mean_squares - mean * mean) / kSamples;
                const double uniform_variance = (uniform_squares - uniform * uniform) / kSamples;
                CHECK(std::abs(sum - uniform) < 4.5 * std::sqrt(variance + uniform_variance));
                if (const auto exact = irradiance_closed_form(e, n))
                    CHECK(std::abs(sum - static_cast<double>(exact->g)) < 4.5 * std::sqrt(variance));
                else
                    CHECK(std::holds_alternative<ImageEnvironment>(e));
                // The mean radiance of an image is that of its pixels without the bilinear blur, which makes a
                // difference of 2 % here.
                const double blur = std::holds_alternative<ImageEnvironment>(e) ? 0.02 * mean : 1e-6 * mean;
                CHECK(std::abs(mean - 4 * kPiDouble * static_cast<double>(mean_radiance(e).g)) <
                      4.5 * std::sqrt(mean_variance) + blur);
            }
    }
}
