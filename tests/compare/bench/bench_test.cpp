#include "compare/bench/bench.h"

#include "common/image/image_file.h"
#include "common/scene/scene_hash.h"
#include "common/system/file.h"
#include "compare/bench/baseline.h"
#include "compare/bench/bench_report.h"
#include "compare/bench/render_reference.h"
#include "compare/metrics/error_metrics.h"
#include "raytrace/render.h"
#include "tests/support/scratch.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <random>

using namespace duet;
using namespace duet::compare;
using duet::test::ScratchFolder;
using nlohmann::json;

namespace {

namespace fs = std::filesystem;

BenchOptions small_bench(const ScratchFolder& scratch) {
    BenchOptions options;
    options.scenes = {fs::path(DUET_SOURCE_DIR) / "models" / "cornell.json"};
    options.folder = scratch / "report";
    options.references = scratch / "references";
    options.size = {16, 16};
    options.choice.techniques = {"raster", "path"};
    options.choice.samplers = {"sobol"};
    options.choice.spps = {1, 4};
    options.choice.threads = 2;
    options.measure.repeats = 3;
    options.reference_spp = 64;
    options.quiet = true;
    return options;
}

/// Returns a renderer with a constant error: the reference plus normal noise and a bias.
BenchRenderer synthetic(const std::string& name, double bias, double seconds) {
    return {name, "", "", {1, 4}, [=](int spp, std::uint64_t seed, Control&) {
                std::mt19937_64 random(seed * 1000 + static_cast<std::uint64_t>(spp));
                std::normal_distribution<double> normal(0.5 + bias, 0.1 / std::sqrt(spp));
                TimedImage trial{ImageRgb(32, 32), seconds * spp, 0};
                for (Rgb& p : trial.image.pixels())
                    p = {static_cast<float>(normal(random)), static_cast<float>(normal(random)),
                         static_cast<float>(normal(random))};
                return trial;
            }};
}

std::vector<Measurement> measured(const std::vector<BenchRenderer>& renderers) {
    const Reference truth{ImageRgb(32, 32, Rgb(0.5f)), ImageRgb(32, 32)};
    Control control;
    return measure(renderers, truth, Image<std::uint8_t>(32, 32, 1), {6, 600, 0}, control);
}

SceneResult result_of(std::vector<Measurement> rows) {
    SceneResult result;
    result.scene = "a, \"b\".json";
    result.scene_hash = "0123456789abcdef";
    result.width = result.height = 32;
    result.reference.estimator = "path";
    result.reference.reference.mean = ImageRgb(32, 32);
    result.rows = std::move(rows);
    return result;
}

json report_of(const std::vector<Measurement>& rows) {
    BenchOptions options;
    options.choice.threads = 2;
    return json::parse(bench_json(options, {result_of(rows)}, std::nullopt).dump());
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("rectangles to leave out, in pixels and in parts") {
        const ExcludedRectangle pixels = parse_excluded_rectangle("1,0,3,2");
        CHECK_FALSE(pixels.fractions);
        const Image<std::uint8_t> counted = counted_pixels({pixels}, 4, 3);
        const Image<std::uint8_t>::Pixels expected = {1, 0, 0, 1, 1, 0, 0, 1, 1, 1, 1, 1};
        CHECK(counted.pixels() == expected);
        CHECK(counted_pixels({parse_excluded_rectangle("0.25,0,0.75,0.66")}, 4, 3).pixels() == expected);
        CHECK(counted_pixels({}, 2, 2).pixels() == Image<std::uint8_t>::Pixels(4, 1));
        for (const char* const bad : {"", "1,2,3", "1,2,3,4,5", "a,0,1,1", "0.5,0,3,2", "-1,0,3,2", "3,0,1,2",
                                      "1,1,1,2", "nan,0,1,1", "1,0,3,2 "}) {
            CAPTURE(bad);
            CHECK_THROWS_AS(parse_excluded_rectangle(bad), Error);
        }
        CHECK_THROWS_AS(counted_pixels({parse_excluded_rectangle("1,0,5,2")}, 4, 3), Error);
        // The rectangle covers all pixels.
        CHECK_THROWS_AS(counted_pixels({parse_excluded_rectangle("0,0,1,1")}, 4, 3), Error);
    }

    TEST_CASE("errors are error_metrics' own, and rectangles are left out") {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> uniform;
        ImageRgb a(16, 12), b(16, 12);
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                a[i][c] = uniform(random);
                b[i][c] = uniform(random);
            }
        const ImageError whole = image_error(a, b, counted_pixels({}, 16, 12));
        const ErrorMetrics expected = error_metrics(a, b);
        CHECK(whole.mse == doctest::Approx(expected.mse));
        CHECK(whole.relmse == doctest::Approx(expected.relmse));
        a(3, 4) = Rgb(1e6f);
        const auto without = counted_pixels({parse_excluded_rectangle("3,4,4,5")}, 16, 12);
        CHECK(image_error(a, b, without).mse < 1);
    }

    TEST_CASE("measure: error, variance and bias of a contender of known error; every seed once; the order changes") {
        std::vector<std::pair<int, std::uint64_t>> calls;
        BenchRenderer good = synthetic("good", 0, 0.01);
        const auto render = good.render;
        good.render = [&](int spp, std::uint64_t seed, Control& control) {
            calls.emplace_back(spp, seed);
            return render(spp, seed, control);
        };
        const std::vector<Measurement> rows = measured({good, synthetic("biased", 0.1, 0.02)});
        REQUIRE(rows.size() == 4);
        REQUIRE(calls.size() == 1 + 2 * 6); // the first call is a warm-up
        int swapped = 0;
        for (std::size_t round = 0; round < 6; ++round) {
            CHECK(calls[1 + 2 * round].second == round + 1);
            CHECK(calls[2 + 2 * round].second == round + 1);
            swapped += calls[1 + 2 * round].first > calls[2 + 2 * round].first;
        }
        CHECK(swapped > 0);
        CHECK(swapped < 6);
        // The mean of squares is over 6 × 3072 values, so its relative standard error is about 1 %.
        CHECK(rows[0].mse.value == doctest::Approx(0.01).epsilon(0.05));
        CHECK(rows[1].mse.value == doctest::Approx(0.0025).epsilon(0.05));
        CHECK(rows[2].mse.value == doctest::Approx(0.02).epsilon(0.05));
        CHECK(rows[2].variance == doctest::Approx(0.01).epsilon(0.05));
        CHECK(rows[2].bias_share() == doctest::Approx(0.5).epsilon(0.1));
        CHECK(rows[3].bias_share() == doctest::Approx(0.8).epsilon(0.1));
        CHECK(rows[0].seconds.value == doctest::Approx(0.01));
        CHECK(rows[1].efficiency.value == doctest::Approx(1 / (0.04 * 0.0025)).epsilon(0.05));
        CHECK(rows[0].mse.low() < 0.01);
        CHECK(rows[0].mse.high() > 0.01);
    }

    TEST_CASE("bands of efficiency hold what a machine does between runs") {
        std::vector<Measurement> rows = measured({synthetic("us", 0, 0.1)});
        const double own = rows[0].efficiency.relative_error, value = rows[0].efficiency.value;
        const double pace = std::hypot(std::log(1.15), std::log(2.0)) / 2;
        widen_efficiency(rows, 0.15, 0.5); // other processes used half of the CPU time
        CHECK(rows[0].efficiency.value == value);
        CHECK(rows[0].relmse_efficiency.value == doctest::Approx(1 / (rows[0].relmse.value * rows[0].seconds.value)));
        CHECK(rows[0].relmse_efficiency.relative_error ==
              doctest::Approx(std::hypot(rows[0].relmse.relative_error, rows[0].seconds.relative_error, pace)));
        CHECK(rows[0].efficiency.relative_error == doctest::Approx(std::hypot(own, pace)));
        CHECK(rows[0].seconds.relative_error < 0.01);
        CHECK(rows[0].efficiency.high() / value > 1.9);
    }

    TEST_CASE("a peer is counted by its best setting at each number of samples") {
        std::vector<Measurement> rows =
            measured({synthetic("us", 0, 0.1), synthetic("p", 0, 0.02), synthetic("p", 0, 0.01)});
        mark_best_settings(rows, "p");
        std::vector<bool> counted;
        for (const Measurement& m : rows) counted.push_back(m.counted);
        CHECK(counted == std::vector<bool>{true, true, false, false, true, true});
    }

    TEST_CASE("errors at equal time: between the measurements, over the peer's, nothing extrapolated") {
        // The samples are independent, so the error is inversely proportional to time: a line of slope −1 in log-log
        // scale.
        std::vector<Measurement> rows = measured({synthetic("us", 0, 0.1), synthetic("p", 0, 0.2)});
        const auto table = at_equal_times(rows, {0.2, 0.3, 9}, "p");
        REQUIRE(table.size() == 6);
        REQUIRE(table[0].mse);
        CHECK(table[0].mse->value == doctest::Approx(0.005).epsilon(0.05)); // the error of 2 samples
        CHECK(table[0].to_peer->value == doctest::Approx(0.5).epsilon(0.1));
        CHECK(table[2].to_peer->value == doctest::Approx(0.5).epsilon(0.1));
        CHECK(table[2].to_peer->low() < 0.5);
        CHECK(table[2].to_peer->high() > 0.5);
        CHECK_FALSE(table[3].to_peer); // the peer itself
        CHECK_FALSE(table[4].mse);
    }

    TEST_CASE("dominance: the path tracer's time to a row's error over the row's time, also beyond its measurements") {
        const std::vector<Measurement> rows =
            measured({synthetic("path", 0, 0.1), synthetic("raster", 0, 0.02), synthetic("wrong", 0.5, 0.02)});
        REQUIRE(rows.size() == 6);
        CHECK_FALSE(dominance(rows, rows[0]));
        for (const std::size_t i : {2u, 3u}) { // the same errors in a fifth of the time
            const std::optional<Dominance> found = dominance(rows, rows[i]);
            REQUIRE(found);
            CHECK(found->ratio.value == doctest::Approx(5).epsilon(0.1));
            CHECK(found->ratio.low() < 5);
            CHECK(found->ratio.high() > 5);
        }
        Measurement exact = rows[3]; // a tenth of the error of any row
        exact.relmse.value /= 10;
        CHECK(dominance(rows, exact)->ratio.value == doctest::Approx(50).epsilon(0.1));
        const std::optional<Dominance> wrong = dominance(rows, rows[4]);
        CHECK(wrong->at_most);
        CHECK(wrong->ratio.value == doctest::Approx(5)); // one sample of a pixel is the path tracer's fastest
    }

    TEST_CASE("the time limit ends the rounds, but two are made; a stop ends all") {
        const Reference truth{ImageRgb(32, 32, Rgb(0.5f)), ImageRgb(32, 32)};
        Control control;
        const auto rows = measure({synthetic("a", 0, 1)}, truth, Image<std::uint8_t>(32, 32, 1), {9, 1e-9, 0}, control);
        CHECK(rows.at(0).trials.size() == 2);
        const std::atomic<bool> stop{true};
        Control stopped{&stop, {}};
        CHECK(measure({synthetic("a", 0, 1)}, truth, Image<std::uint8_t>(32, 32, 1), {9, 1, 0}, stopped).empty());
    }

    TEST_CASE("the baseline flags what got slower or less accurate, and nothing else") {
        const std::vector<Measurement> then = measured({synthetic("a", 0, 0.01), synthetic("b", 0, 0.01)});
        const auto against = [&](const std::vector<BenchRenderer>& now) {
            return compare_with_baseline({result_of(measured(now))}, report_of(then), 0.15);
        };
        const BaselineComparison equal = against({synthetic("a", 0, 0.01), synthetic("b", 0, 0.011)});
        CHECK(equal.rows.size() == 4);
        CHECK_FALSE(equal.flagged()); // 10 % slower is within the drift of the CPU's speed
        const BaselineComparison slower = against({synthetic("a", 0, 0.013), synthetic("b", 0, 0.005)});
        CHECK(slower.flagged());
        CHECK(slower.rows[0].slower);
        CHECK_FALSE(slower.rows[0].less_accurate);
        CHECK(slower.rows[2].faster);
        CHECK_FALSE(slower.rows[2].slower);
        const BaselineComparison worse = against({synthetic("a", 0.03, 0.01), synthetic("new", 0, 0.01)});
        CHECK(worse.rows[0].less_accurate);
        CHECK_FALSE(worse.rows[0].slower);
        CHECK(worse.unmatched.size() == 2);

        // On a busy CPU a factor of two in time is accepted, but not a factor of three.
        for (const auto& [seconds, expected] : {std::pair(0.02, false), std::pair(0.03, true)}) {
            SceneResult busy = result_of(measured({synthetic("a", 0, seconds)}));
            busy.processor_share = 0.5;
            CHECK(compare_with_baseline({busy}, report_of(then), 0.15).flagged() == expected);
        }

        CHECK_THROWS_AS(against({synthetic("new", 0, 0.01)}), Error); // the check would cover nothing
        CHECK_NOTHROW(check_baseline(report_of(then), {64, 2, 0}));
        CHECK_THROWS_AS(check_baseline(report_of(then), {64, 4, 0}), Error);
        CHECK_THROWS_AS(check_baseline(report_of(then), {64, 2, 512}), Error);
        CHECK_THROWS_AS(check_baseline(report_of(then), {64, 2, 0, "vcm"}), Error);
        CHECK_THROWS_AS(check_baseline(json::array(), {64, 2, 0}), Error);
        CHECK_THROWS_AS(check_baseline(report_of(then), {8, 2, 0}), Error);
        CHECK_THROWS_AS(compare_with_baseline({result_of(then)}, json{{"scenes", 1}}, 0.15), Error);
        SceneResult changed = result_of(then);
        changed.scene_hash[0] = 'f';
        CHECK_THROWS_AS(compare_with_baseline({changed}, report_of(then), 0.15), Error);
    }

    TEST_CASE("CSV: a line a row, fields quoted, as many as the header has") {
        const std::string csv = bench_csv(report_of(measured({synthetic("a", 0, 0.01)})));
        std::vector<std::string> lines(1);
        for (const char c : csv) {
            if (c == '\n')
                lines.emplace_back();
            else
                lines.back() += c;
        }
        REQUIRE(lines.size() == 4); // header, two rows, end of file
        CHECK(lines[1].starts_with("\"a, \"\"b\"\".json\",32,32,64,2,a,,1,6,0.01,"));
        const auto commas = [](const std::string& line) {
            std::size_t count = 0;
            bool quoted = false;
            for (const char c : line) {
                quoted = c == '"' ? !quoted : quoted;
                count += !quoted && c == ',';
            }
            return count;
        };
        CHECK(commas(lines[1]) == commas(lines[0]));
    }

    TEST_CASE("a bench writes its three files, with the promised keys; the reference is rendered once") {
        const ScratchFolder scratch;
        BenchOptions options = small_bench(scratch);
        options.excluded = {parse_excluded_rectangle("0.3,0,0.7,0.3")};
        REQUIRE(bench(options) == 0);
        CHECK(read_file(options.folder / "index.html").find("cornell.json") != std::string::npos);
        const json report = json::parse(read_file(options.folder / "report.json"));
        const json& scene = report["scenes"][0];
        CHECK(scene["reference"]["rendered"] == true);
        CHECK(scene["checks"][0]["consistent"] == true);
        REQUIRE(scene["rows"].size() == 4);
        for (const json& row : scene["rows"]) {
            CHECK(row["trials"].size() == 3);
            for (const char* const key : {"mse", "relmse", "seconds", "efficiency", "relmse_efficiency"})
                CHECK(row[key]["low"] <= row[key]["high"]);
            CHECK(row["rest"]["mse"]["value"] < row["mse"]["value"]); // the light's edge is excluded
        }
        // The metrics do not depend on the thread count, because seeds and images are the same.
        options.choice.threads = 1;
        options.folder = scratch / "again";
        REQUIRE(bench(options) == 0);
        const json again = json::parse(read_file(options.folder / "report.json"));
        CHECK(again["scenes"][0]["reference"]["rendered"] == false);
        for (std::size_t i = 0; i < 4; ++i) CHECK(again["scenes"][0]["rows"][i]["mse"] == scene["rows"][i]["mse"]);
    }

    TEST_CASE("a wrong image of the independent estimator fails the bench") {
        const ScratchFolder scratch;
        BenchOptions options = small_bench(scratch);
        REQUIRE(bench(options) == 0);
        const Scene scene = load_scene(options.scenes[0]);
        const ReferenceKey key{hash_scene_files(scene), "naive", raytrace::kEstimatorVersion, 16, 16, 64, 64};
        const ReferenceCache cache(options.references);
        Reference wrong = *cache.find("cornell", key);
        for (Rgb& pixel : wrong.mean.pixels()) pixel.b *= 1.5f;
        cache.store("cornell", key, wrong);
        CHECK(bench(options) == 1);
    }

    TEST_CASE("a reference by another integrator is used, and not checked as if its pixels were independent") {
        const ScratchFolder scratch;
        BenchOptions options = small_bench(scratch);
        options.choice.techniques = {"bidirectional", "vcm"};
        options.choice.spps = {16};
        options.reference_by = "bidirectional";
        REQUIRE(bench(options) == 0);
        const json scene = json::parse(read_file(options.folder / "report.json"))["scenes"][0];
        CHECK(scene["reference"]["estimator"] == "bidirectional");
        CHECK(scene["checks"].empty());
        REQUIRE(scene["rows"].size() == 2);
        for (const json& row : scene["rows"]) CHECK(row["relmse"]["value"] < 0.02); // measured: 0.004
    }

    TEST_CASE("unknown techniques and samplers are refused before anything is rendered") {
        const ScratchFolder scratch;
        BenchOptions options = small_bench(scratch);
        options.choice.techniques = {"path", "radiosity"};
        CHECK_THROWS_AS(bench(options), Error);
        options = small_bench(scratch);
        options.choice.samplers = {"halton"};
        CHECK_THROWS_AS(bench(options), Error);
        options = small_bench(scratch);
        options.reference_by = "raster";
        CHECK_THROWS_AS(bench(options), Error);
        options = small_bench(scratch);
        options.scenes = {fs::path(DUET_SOURCE_DIR) / "models" / "cloud.json"};
        options.choice.techniques = {"path", "vcm"}; // which does not support media
        CHECK_THROWS_AS(bench(options), Error);
        CHECK_FALSE(fs::exists(options.references));
    }
}
