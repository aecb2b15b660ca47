// These tests check the statistics of compare stop and measure a scene.
#include "compare/stop/stop.h"

#include "raytrace/render.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;
using namespace duet::compare;

namespace {

StopTrial trial(double samples, double relmse, double mse, double uniform_relmse, double uniform_mse) {
    StopTrial t;
    t.samples = samples;
    t.seconds = 2;
    t.uniform_seconds = 1;
    t.relmse = relmse;
    t.mse = mse;
    t.uniform_relmse = uniform_relmse;
    t.uniform_mse = uniform_mse;
    return t;
}

Scene area_light_over_floor(bool with_mirror) {
    raytrace::SceneBuilder builder;
    builder.add(raytrace::quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}), builder.material(Diffuse{{Rgb(0.5f)}}));
    builder.add(raytrace::quad({-1, 1.4f, -1}, {2, 0, 0}, {0, 0, 2}), builder.material(Emissive{Rgb(1.0f)}));
    if (with_mirror) builder.add(Sphere{{0, -0.5f, 0}, 0.3f}, builder.material(Metal{{Rgb(0.9f)}, 0.0f}));
    return builder.finish();
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("medians, and adaptive over even sampling at equal time") {
        StopResult result;
        result.trials = {trial(40, 0.004, 2, 0.002, 8), trial(16, 0.001, 2, 0.002, 8), trial(64, 0.002, 2, 0.002, 8)};
        CHECK(result.median_error() == doctest::Approx(0.002));
        CHECK(result.mean_samples() == doctest::Approx(40));
        CHECK(result.cost_ratio_relmse() == doctest::Approx(2 * 0.007 / 0.006));
        CHECK(result.cost_ratio_mse() == doctest::Approx(2 * 0.25));
        CHECK_FALSE(result.stopped_at_minimum());
        result.trials.push_back(trial(16, 0.003, 2, 0.002, 8));
        CHECK(result.median_error() == doctest::Approx(0.0025));
        CHECK(result.stopped_at_minimum()); // half of the trials ended with the minimum number of samples
    }

    TEST_CASE("mirrors and lights together make caustics") {
        CHECK_FALSE(has_caustics(area_light_over_floor(false)));
        CHECK(has_caustics(area_light_over_floor(true)));
    }
}

TEST_SUITE("statistical") {

    TEST_CASE("the error that is measured is the one requested, and a stopped measurement is none") {
        const Scene scene = load_scene(std::filesystem::path(DUET_SOURCE_DIR) / "models/cornell.json");
        const View view{scene.camera, 64, 64};
        raytrace::PathTracerSettings settings;
        settings.samples_per_pixel = 2048;
        settings.seed = 99;
        settings.aovs.variance = true;
        Control control;
        Rendering truth = raytrace::render(raytrace::prepare(scene, settings), view, settings, control);
        const Reference reference{std::move(truth.radiance), std::move(truth.variance)};
        StopSettings stop;
        stop.error = 3e-3;
        stop.seeds = 10;
        double last = 0;
        Control counted{nullptr, [&](double fraction) { last = fraction; }};
        const auto result = measure_stop(scene, view, reference, stop, counted);
        REQUIRE(result);
        CHECK(last == doctest::Approx(1));
        CHECK(result->trials.size() == 10);
        CHECK(result->times.empty());
        MESSAGE("asked 3e-3, got ", result->median_error(), " with ", result->mean_samples(), " samples");
        CHECK(std::abs(result->median_error() / stop.error - 1) < 0.2);
        const std::atomic<bool> raised{true};
        Control stopped{&raised, {}};
        CHECK_FALSE(measure_stop(scene, view, reference, stop, stopped));
    }
}
