// These tests check how many samples pixels get: passes, limits, and adaptive sampling by error.
#include "raytrace/render.h"
#include "raytrace/sample_schedule.h"

#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace duet;
using namespace duet::raytrace;

namespace {

// Returns the next sample count if it is the same for all pixels, or −1 if the limit is reached.
int planned(const PathTracerSettings& settings, std::uint32_t done, const SpentBudget& spent = {}) {
    Film film(1, 1);
    for (std::uint32_t i = 0; i < done; ++i) film.add(0, 0, i & 1u, Rgb(i % 2 ? 1.0f : 2.0f));
    return plan_pass(settings, spent, film) ? static_cast<int>(film.pixels()(0, 0).target) : -1;
}

// Adds samples with the standard deviation `spread` of the pixel until each pixel has its target count.
template <typename Allocate> void take(Film& film, const Allocate& allocate, std::uint64_t seed) {
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            std::mt19937_64 random(seed + static_cast<std::uint64_t>(y * film.width() + x) * 1000 +
                                   film.samples_taken(x, y));
            std::uniform_real_distribution<float> uniform(-1, 1);
            for (std::uint32_t i = film.samples_taken(x, y); i < film.pixels()(x, y).target; ++i)
                film.add(x, y, i & 1u, Rgb(1 + allocate(x, y) * uniform(random)));
        }
}

void set_all_targets(Film& film, std::uint32_t samples) {
    for (std::size_t i = 0; i < film.pixels().size(); ++i) film.pixels()[i].target = samples;
}

// Returns a light whose edges cause most of the error, in a corner of a dim room.
Scene light_scene(float radiance = 10) {
    SceneBuilder builder;
    const std::uint32_t grey = builder.material(Diffuse{{Rgb(0.5f)}});
    const std::uint32_t area_light = builder.material(Emissive{Rgb(radiance)});
    builder.add(quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}), grey);
    builder.add(quad({-0.5f, 0.4f, 0.2f}, {0.6f, 0.1f, 0}, {0, 0.4f, 0}), area_light);
    return builder.finish();
}

constexpr int kWidth = 32, kHeight = 24;

Rendering rendered(const Scene& scene, const PathTracerSettings& settings, int scale = 1) {
    Control control;
    return render(prepare(scene, settings), View{scene.camera, scale * kWidth, scale * kHeight}, settings, control);
}

double relmse(const ImageRgb& image, const ImageRgb& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < image.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            sum += sqr(static_cast<double>(image[i][c]) - static_cast<double>(truth[i][c])) /
                   (sqr(static_cast<double>(truth[i][c])) + 0.01);
    return sum / (3.0 * static_cast<double>(image.size()));
}

ImageRgb reference(const Scene& scene, int scale = 1) {
    PathTracerSettings settings;
    settings.samples_per_pixel = 16384;
    settings.seed = 4711;
    return rendered(scene, settings, scale).radiance;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a pass over a single pixel that is hardly above the error takes samples") {
        for (const bool adaptive : {false, true}) {
            Film film(1, 1);
            for (std::uint32_t i = 0; i < 16; ++i) film.add(0, 0, i & 1u, Rgb(i % 2 ? 1.0f : 2.0f));
            PathTracerSettings settings;
            settings.samples_per_pixel = 1 << 20;
            settings.adaptive = adaptive;
            settings.error_limit = 0.999 * film.estimated_relmse();
            CHECK(planned(settings, 16) > 16);
        }
    }

    TEST_CASE("passes grow, stop at the limits, and end at the samples requested") {
        PathTracerSettings settings;
        settings.samples_per_pixel = 100;
        CHECK(planned(settings, 0) == 16);
        CHECK(planned(settings, 96) == 100);
        CHECK(planned(settings, 100) == -1);
        settings.samples_per_pixel = 1000000;
        settings.time_limit = 10;
        CHECK(planned(settings, 0) == 2);
        CHECK(planned(settings, 64, {1, 64}) == 80);
        CHECK(planned(settings, 4096, {1, 4096}) == 4096 + 32);
        CHECK(planned(settings, 100, {8.9, 100}) == 112);  // the remaining 1.1 s are enough for 12.4 more
        CHECK(planned(settings, 100, {9.5, 100}) == 106);  // enough for 5.3 more: 6 is closer than 4
        CHECK(planned(settings, 100, {9.95, 100}) == -1);  // enough for only 0.5 more
        CHECK(planned(settings, 100, {12, 100}) == -1);
        CHECK(planned(settings, 200, {8.9, 100}) == 212); // at this render's own sampling rate
        settings.time_limit = 0;
        settings.error_limit = 1e6;
        CHECK(planned(settings, 1) == 17); // the error is still unknown
        CHECK(planned(settings, 2) == 18); // two samples are not enough evidence
        CHECK(planned(settings, 16) == -1);
        settings.error_limit = 1e-12;
        CHECK(planned(settings, 64) == 80); // grows by at most a quarter
    }

    TEST_CASE("samples are spread as the square root of the variance, in even numbers, and all are spent") {
        Film film(40, 20);
        const auto allocate = [](int x, int) { return x < 20 ? 1.0f : 0.1f; };
        std::int64_t sum = 0;
        set_all_targets(film, 32);
        take(film, allocate, 1);
        for (int pass = 0; pass < 12; ++pass) {
            allocate_samples(film, 40 * 20 * 16);
            sum = 0;
            for (int y = 0; y < 20; ++y)
                for (int x = 0; x < 40; ++x) {
                    const std::uint32_t more = film.pixels()(x, y).target - film.samples_taken(x, y);
                    CHECK(more % 2 == 0);
                    CHECK(more <= 2 * film.samples_taken(x, y)); // rounding among neighbors may add a pair
                    sum += more;
                }
            CHECK(std::abs(sum - 40 * 20 * 16) <= 2);
            take(film, allocate, 2 + static_cast<std::uint64_t>(pass));
        }
        double left = 0, right = 0;
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 40; ++x) {
                if (x < 18) left += film.samples_taken(x, y);
                if (x >= 22) right += film.samples_taken(x, y);
            }
        CHECK(left / right == doctest::Approx(10).epsilon(0.35)); // approximate: variances from two replicates scatter
    }

    TEST_CASE("no pixel's number depends on its own samples, and one alone gets as many as are asked") {
        const auto planned_after = [](float value) {
            Film film(9, 9);
            set_all_targets(film, 32);
            take(film, [](int x, int y) { return 0.1f * static_cast<float>(1 + x + y); }, 5);
            film.pixels()(4, 4).sum[0] = Rgbd(static_cast<double>(value)); // as if its samples had been different
            allocate_samples(film, 81 * 8);
            return film;
        };
        const Film quiet = planned_after(16.0f), loud = planned_after(400.0f);
        // The total over all pixels is fixed, so compare the pixel's target with its share.
        const auto need = [](const Film& film, int x, int y) { return film.pixels()(x, y).target; };
        CHECK(need(loud, 3, 4) > need(quiet, 3, 4));
        CHECK(need(loud, 4, 4) <= need(quiet, 4, 4)); // less, because its neighbors get more
        PathTracerSettings settings;
        settings.adaptive = true;
        CHECK(planned(settings, 32) == 40);
    }

    TEST_CASE("an adaptive render has the samples requested in the mean, the same bits for any threads, and goes on") {
        const Scene scene = light_scene();
        PathTracerSettings settings;
        settings.adaptive = true;
        settings.samples_per_pixel = 64;
        settings.aovs.samples = true;
        settings.threads = 1;
        const Rendering one = rendered(scene, settings);
        settings.threads = 2;
        const Rendering two = rendered(scene, settings);
        CHECK(one.radiance.pixels() == two.radiance.pixels());
        CHECK(one.samples.pixels() == two.samples.pixels());
        std::int64_t sum = 0;
        for (const std::uint32_t n : one.samples) sum += n;
        CHECK(static_cast<double>(sum) / (kWidth * kHeight) == doctest::Approx(64).epsilon(0.01));
        CHECK(*std::max_element(one.samples.begin(), one.samples.end()) > 128);
        CHECK(*std::min_element(one.samples.begin(), one.samples.end()) < 48);
    }
}

TEST_SUITE("statistical") {

    TEST_CASE("adaptive samples: less error than the same number spread evenly, and no bias") {
        const Scene scene = light_scene();
        const ImageRgb truth = reference(scene);
        constexpr int kSeeds = 24;
        double even = 0, spread = 0;
        Image<Rgbd> sum(kWidth, kHeight), squares(kWidth, kHeight);
        for (int seed = 0; seed < kSeeds; ++seed) {
            PathTracerSettings settings;
            settings.samples_per_pixel = 64;
            settings.seed = static_cast<std::uint64_t>(seed);
            even += relmse(rendered(scene, settings).radiance, truth);
            settings.adaptive = true;
            const ImageRgb image = rendered(scene, settings).radiance;
            spread += relmse(image, truth);
            for (std::size_t i = 0; i < image.size(); ++i) {
                sum[i] += Rgbd(image[i]);
                squares[i] += Rgbd(image[i]) * Rgbd(image[i]);
            }
        }
        MESSAGE("error of even over spread samples: ", even / spread);
        CHECK(spread < 0.7 * even);
        // The pixels' mean difference from the exact value, in standard errors, is approximately normal. The bound of
        // 5 gives a false alarm in 2 million runs.
        double difference = 0, variance = 0;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const double mean = sum[i].g / kSeeds;
            difference += mean - static_cast<double>(truth[i].g);
            variance += max(squares[i].g / kSeeds - sqr(mean), 0.0) / (kSeeds - 1);
        }
        CHECK(std::abs(difference) < 5 * std::sqrt(variance));
    }

    // A few pixels on the light's silhouette have most of the error. It scatters by more than a factor of ten, with a
    // median far below its mean, so the render ends near the target but not exactly there. The command compare stop
    // tests the scenes of models/.
    TEST_CASE("the error got is no more than the error requested, and not much less") {
        const Scene scene = light_scene(1);
        constexpr int kScale = 3;
        const ImageRgb truth = reference(scene, kScale);
        for (const double asked : {0.0004, 0.0001}) { // with more than the minimum number of samples
            std::vector<double> got;
            for (int seed = 0; seed < 20; ++seed) {
                PathTracerSettings settings;
                settings.samples_per_pixel = 1 << 20;
                settings.error_limit = asked;
                settings.adaptive = true;
                settings.seed = static_cast<std::uint64_t>(seed);
                got.push_back(relmse(rendered(scene, settings, kScale).radiance, truth));
            }
            std::sort(got.begin(), got.end());
            const double median = (got[9] + got[10]) / 2;
            MESSAGE("asked ", asked, ", got ", median, " (", got.front(), " to ", got.back(), ")");
            CHECK(median > 0.4 * asked);
            CHECK(median < 1.2 * asked);
        }
    }
}
