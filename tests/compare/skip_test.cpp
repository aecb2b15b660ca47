#include "compare/skip/skip.h"

#include "common/system/file.h"
#include "raytrace/render.h"
#include "tests/raster/scenes.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <random>
#include <set>

using namespace duet;
using namespace duet::compare;
using nlohmann::json;

namespace {

namespace fs = std::filesystem;

const fs::path kModels = fs::path(DUET_SOURCE_DIR) / "models";

/// Returns four tori, one of them not visible, and some triangles that degenerate to a line on the grid.
Scene tori() {
    Scene scene;
    test::add(scene, test::torus(60, 30));
    test::add_instance(scene, 0, Mat4(translation(Vec3(1.2f, 0.5f, 0)) * rotation(Vec3(1, 0, 0), 1.2f)));
    test::add_instance(scene, 0, Mat4(translation(Vec3(-1, 0.2f, 0.5f)) * scaling(Vec3(-0.7f, 0.7f, 0.7f))));
    test::add_instance(scene, 0, Mat4(translation(Vec3(0, 80, 0))));
    Mesh slivers;
    for (std::uint32_t i = 0; i < 5; ++i) {
        const float x = 0.1f * static_cast<float>(i);
        for (const Vec3 p : {Vec3(x, 1, 0), Vec3(x, 1.5f, 0), Vec3(x + 1e-7f, 1.2f, 0)}) slivers.positions.push_back(p);
        slivers.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    test::add(scene, slivers);
    Light area_light = PointLight{};
    std::get<PointLight>(area_light).position = {0, 4, 4};
    std::get<PointLight>(area_light).intensity = Rgb(20);
    scene.lights.push_back(area_light);
    scene.camera.eye = {4, 1.5, 0.3};
    scene.camera.look_at = {0, 0, 0};
    finish_scene(scene);
    return scene;
}

SkipCase find_case(const std::vector<SkipCase>& cases, const std::string& pipeline, const std::string& name) {
    for (const SkipCase& skip : cases)
        if (skip.pipeline == pipeline && skip.name == name) return skip;
    FAIL("no skip " << pipeline << "/" << name);
    return {};
}

std::int64_t count_of(const Rendering& rendering, const std::string& what) {
    for (const SkippedWork& s : rendering.statistics.skipped)
        if (s.what == what) return s.count;
    return 0;
}

SkipMeasureSettings quick() {
    SkipMeasureSettings options;
    options.repeats = 2;
    return options;
}

SkipMeasurement measured(const SkipCase& skip, const View& view, const SkipMeasureSettings& options) {
    Control control;
    return measure_skip(skip, view, options, control);
}

/// Returns the same skip case, but applies `change` to the image that is rendered with the skip.
template <typename Change> SkipCase planted(const SkipCase& skip, const Change& change) {
    SkipCase result = skip;
    result.render = [skip, change](const View& view, std::uint64_t seed, bool with, Control& control) {
        Rendering rendering = skip.render(view, seed, with, control);
        if (with) change(rendering.radiance);
        return rendering;
    };
    return result;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("each skip that promises the same bits keeps them, in every scene") {
        for (const char* const name : {"cornell", "everything", "spheres", "amphora", "furnace"}) {
            const Scene scene = load_scene(kModels / (std::string(name) + ".json"));
            const View view{scene.camera, 40, 30};
            for (const SkipCase& skip : skip_cases(scene, {2, 2})) {
                if (skip.proof != SkipProof::kSameBits) continue;
                CAPTURE(name);
                CAPTURE(skip.pipeline);
                CAPTURE(skip.name);
                const SkipMeasurement m = measured(skip, view, quick());
                CHECK(m.proved);
                CHECK(m.pixels_differ == 0);
                CHECK(m.image_pairs == 2);
            }
        }
    }

    TEST_CASE("the rasterizer's switches do switch: with them off nothing is left out, and the bits are the same") {
        const Scene scene = tori();
        const View view{scene.camera, 60, 45};
        Control control;
        for (const char* const name : {"frustum", "back_faces", "subpixel", "degenerate"}) {
            CAPTURE(name);
            const SkipCase skip = find_case(skip_cases(scene, {4, 4}), "raster", name);
            const std::int64_t without = count_of(skip.render(view, 0, false, control), skip.statistic);
            CHECK(count_of(skip.render(view, 0, true, control), skip.statistic) > without);
            // Clipping removes some triangles, too.
            if (std::string(name) != "frustum") CHECK(without == 0);
            if (skip.proof == SkipProof::kSameBits) CHECK(measured(skip, view, quick()).pixels_differ == 0);
        }
        for (const char* const name : {"lens", "motion"}) { // one pass for all samples, or one pass per sample
            const SkipCase skip = find_case(skip_cases(scene, {4, 4}), "raster", name);
            CHECK(skip.render(view, 0, true, control).statistics.passes == 1);
            CHECK(skip.render(view, 0, false, control).statistics.passes == 4);
        }
    }

    TEST_CASE("the path tracer's switches do switch: rays are saved where the skip is of rays") {
        const Scene cornell = load_scene(kModels / "cornell.json");
        const View view{cornell.camera, 24, 24};
        for (const char* const name : {"shadow_rays", "russian_roulette"})
            CHECK(measured(find_case(skip_cases(cornell, {4, 4}), "raytrace", name), view,
                           [] {
                               SkipMeasureSettings options = quick();
                               options.budget = 0;
                               return options;
                           }())
                      .rays_saved > 0);
        // Only light samples find a point light, so a depth of one needs no indirect rays.
        const Scene scene = tori();
        raytrace::PathTracerSettings settings;
        settings.samples_per_pixel = 2;
        settings.max_depth = 1;
        const raytrace::PathTracerScene prepared = raytrace::prepare(scene, settings);
        Control control;
        const Rendering with = render(prepared, view, settings, control);
        settings.skips.last_bounce = false;
        const Rendering without = render(prepared, view, settings, control);
        CHECK(with.statistics.indirect_rays == 0);
        CHECK(without.statistics.indirect_rays > 0);
        CHECK(with.radiance.pixels() == without.radiance.pixels());
    }

    TEST_CASE("a skip that changes one bit of one pixel is found") {
        const Scene scene = load_scene(kModels / "cornell.json");
        const View view{scene.camera, 16, 16};
        const SkipCase wrong =
            planted(find_case(skip_cases(scene, {1, 1}), "raytrace", "lens"), [](ImageRgb& radiance) {
                float& value = radiance(7, 11).g;
                value = std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) ^ 1u);
            });
        const SkipMeasurement m = measured(wrong, view, quick());
        CHECK_FALSE(m.proved);
        CHECK(m.pixels_differ == 2); // one per image
        CHECK_FALSE(m.bias.has_value());
    }

    TEST_CASE("the bias test, computed by hand") {
        BiasTest test;
        CHECK(std::isinf(test.detectable()));
        // Red differences are ±0.02 around 0.01, green ones are 0, and blue is black.
        for (int i = 0; i < 200; ++i) {
            test.add({1.01 + (i % 2 == 0 ? 0.02 : -0.02), 2, 0}, {1, 2, 0});
            if (i < kMinPairs - 1) CHECK(std::isinf(test.detectable()));
        }
        CHECK(test.bias().r == doctest::Approx(0.01));
        CHECK(test.bias().g == 0);
        CHECK(test.bias().b == 0);
        // Without skewness, T = √200 · 0.01 / σ and S = T / √(1 + T²/200).
        const double sigma = 0.02 * std::sqrt(200.0 / 199), t = std::sqrt(200.0) * 0.01 / sigma;
        CHECK(test.p() ==
              doctest::Approx(3 * std::erfc(t / std::sqrt(1 + t * t / 200) / std::sqrt(2.0))).epsilon(1e-6));
        // S exceeds 2.9342 if T is above T₀ = 2.9342 / √(1 − 2.9342²/200).
        const double t0 = 2.9342 / std::sqrt(1 - 2.9342 * 2.9342 / 200), upper = 1 + 2.3263 / std::sqrt(398.0);
        CHECK(test.detectable() == doctest::Approx((t0 + 2.3263) * sigma * upper / std::sqrt(200)).epsilon(1e-4));
        CHECK(test.pairs_needed(test.detectable()) == doctest::Approx(200));
    }

    TEST_CASE("a bias without noise, and no difference at all") {
        BiasTest same, darker;
        for (int i = 0; i < 64; ++i) {
            same.add({1, 1, 0}, {1, 1, 0});
            darker.add({0.875, 1, 0}, {1, 1, 0});
        }
        CHECK(same.p() == 1);
        CHECK(same.detectable() == 0);
        CHECK(darker.p() < 1e-10);
        CHECK(darker.bias().r == -0.125);
    }

    TEST_CASE("too little time for the power is no proof") {
        const Scene scene = load_scene(kModels / "cornell.json");
        SkipMeasureSettings options = quick();
        options.budget = 0;
        const SkipMeasurement m = measured(find_case(skip_cases(scene, {1, 1}), "raytrace", "russian_roulette"),
                                           {scene.camera, 16, 16}, options);
        CHECK(m.pixels_differ > 0);
        CHECK_FALSE(m.proved);
        REQUIRE(m.bias.has_value());
        CHECK(std::isinf(m.bias->detectable()));
    }

    TEST_CASE("compare skip: figures as JSON, the exit code, names") {
        const test::ScratchFolder scratch;
        const fs::path stats = scratch / "stats.json";
        SkipOptions options;
        options.scene = kModels / "cornell.json";
        options.size = {16, 16};
        options.settings = {1, 1};
        options.measure.repeats = 1;
        options.only = {"lens", "raytrace/textures"};
        options.stats = stats.string();
        options.quiet = true;
        CHECK(skip(options) == 0);
        const json report = json::parse(read_file(stats));
        REQUIRE(report["skips"].size() == 3);
        std::set<std::string> names;
        for (const json& row : report["skips"]) {
            names.insert(row["pipeline"].get<std::string>() + "/" + row["name"].get<std::string>());
            CHECK(row["proved"] == true);
            CHECK(row["proof"] == "same bits");
            CHECK(row["seconds_with"]["median"].get<double>() > 0);
            CHECK(row["seconds_without"]["min"].get<double>() > 0);
        }
        CHECK(names == std::set<std::string>{"raster/lens", "raytrace/lens", "raytrace/textures"});
        options.only = {"russian_roulette"};
        options.measure.budget = 0;
        CHECK(skip(options) == 1);
        options.only = {"nothing"};
        CHECK_THROWS_AS(skip(options), Error);
    }
}

TEST_SUITE("statistical") {

    // There are 1000 tests each at level 0.01, with normal noise and with noise as skewed as that of Russian roulette
    // in small images (γ = 1.4). At most 10 false alarms are expected; more than 25 have odds below 2e-5.
    TEST_CASE("the bias test gives few false alarms") {
        std::mt19937_64 random(21);
        std::normal_distribution<double> normal;
        std::gamma_distribution<double> skewed(2);
        int alarms = 0, skewed_alarms = 0;
        for (int i = 0; i < 1000; ++i) {
            BiasTest even, uneven;
            for (int pair = 0; pair < 64; ++pair) {
                const auto noise = [&] { return 1 + 0.01 * normal(random); };
                const auto right = [&] { return 1 + 0.01 * (skewed(random) - 2); };
                even.add({noise(), noise(), noise()}, {1, 1, 1});
                uneven.add({right(), right(), right()}, {1, 1, 1});
            }
            alarms += even.p() < kFalseAlarmProbability;
            skewed_alarms += uneven.p() < kFalseAlarmProbability;
        }
        CHECK(alarms <= 25);
        CHECK(skewed_alarms <= 25);
    }

    // Of 300 tests of each sign, at most 3 are expected to miss a bias of the detectable size. More than 10 misses
    // have odds below 3e-4.
    TEST_CASE("a bias of the size called detectable is found, with skewed noise, too") {
        std::mt19937_64 random(22);
        std::gamma_distribution<double> skewed(2);
        for (const double sign : {-1.0, 1.0}) {
            int missed = 0;
            for (int i = 0; i < 300; ++i) {
                BiasTest noise, biased;
                std::vector<double> draws;
                for (int pair = 0; pair < 64; ++pair) draws.push_back(0.01 * (skewed(random) - 2));
                for (const double d : draws) noise.add({1 + d, 1, 1}, {1, 1, 1});
                for (const double d : draws) biased.add({1 + d + sign * noise.detectable(), 1, 1}, {1, 1, 1});
                missed += !(biased.p() < kFalseAlarmProbability);
            }
            CHECK(missed <= 10);
        }
    }

    // A false alarm has odds of 0.01 for each of the two unbiased cases; the seeds are fixed.
    TEST_CASE("Russian roulette and culled back faces are proved, with a planted bias of 0.3 % they are found out") {
        const Scene cornell = load_scene(kModels / "cornell.json");
        const SkipCase roulette = find_case(skip_cases(cornell, {1, 4}), "raytrace", "russian_roulette");
        SkipMeasureSettings options = quick();
        options.bias = 0.003;
        options.seed = 7000;
        options.budget = 1e4;
        const View view{cornell.camera, 32, 32};
        const SkipMeasurement right = measured(roulette, view, options);
        CHECK(right.proved);
        CHECK(right.pixels_differ > 0);
        const SkipMeasurement wrong = measured(planted(roulette,
                                                       [](ImageRgb& radiance) {
                                                           for (Rgb& pixel : radiance.pixels()) pixel *= 0.997f;
                                                       }),
                                               view, options);
        CHECK_FALSE(wrong.proved);
        REQUIRE(wrong.bias.has_value());
        CHECK(wrong.bias->p() < kFalseAlarmProbability);
        CHECK(wrong.bias->bias().g == doctest::Approx(-0.003).epsilon(0.5));

        const Scene scene = tori();
        const SkipCase back_faces = find_case(skip_cases(scene, {1, 1}), "raster", "back_faces");
        const SkipMeasurement faces = measured(back_faces, {scene.camera, 240, 180}, options);
        CHECK(faces.proved);
        MESSAGE("back faces: ", faces.pixels_differ, " pixels of ", faces.image_pairs, " images differ");
    }
}
