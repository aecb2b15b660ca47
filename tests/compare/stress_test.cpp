// These tests check the stress suite's framework: what counts as a failure, equal rows for any thread count, and
// names.
#include "common/system/error.h"
#include "compare/stress/accelerated_scene.h"
#include "compare/stress/errors.h"
#include "compare/stress/log_p_value.h"
#include "compare/stress/naive.h"
#include "compare/stress/trials.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

using namespace duet;
using namespace duet::compare;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

StressTest test_of(double bound, std::string_view naive = "the naive way") {
    return {"suite/test", "something holds", bound, "unit", "derived", naive, 1000, nullptr};
}

/// Returns errors that are uniform in [0, 1), and twice as large for the naive method.
StressResult uniform_errors(double bound, const StressSetting& setting) {
    return run_trials(test_of(bound), setting, [](Trial& trial) {
        const double error = static_cast<double>(trial.random.uniform());
        trial.note("error ", error, " in trial ", trial.number());
        trial.record(error);
        trial.record_naive(2 * error);
    });
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("an error above the bound fails, and so does NaN; the worst and the first are kept, in any order") {
        StressOutcome outcome;
        outcome.add(5, 1.0, 1.0);
        CHECK(outcome.failures == 0);
        CHECK(outcome.first_failure == -1);
        outcome.add(7, 1.5, 1.0);
        outcome.add(3, std::numeric_limits<double>::infinity(), 1.0);
        CHECK(outcome.failures == 2);
        CHECK(outcome.first_failure == 3);
        CHECK(outcome.worst == std::numeric_limits<double>::infinity());
        StressOutcome with_nan;
        with_nan.add(1, kNan, 1.0);
        with_nan.add(9, 0.5, 1.0);
        CHECK(with_nan.failures == 1);
        StressOutcome sum = outcome, other = with_nan;
        sum += with_nan;
        other += outcome;
        for (const StressOutcome& all : {sum, other}) {
            CHECK(all.failures == 3);
            CHECK(all.first_failure == 1);
            CHECK(std::isnan(all.worst));
        }
    }

    TEST_CASE("a trial's largest error counts, once; a trial without any is not counted; none at all is a failure") {
        const StressResult result = run_trials(test_of(1), {}, [](Trial& trial) {
            if (trial.number() % 2) return;
            for (const double error : {0.5, 3.0, 2.0}) trial.record(error);
            trial.record_naive(kNan);
            trial.record_naive(0.0);
        });
        CHECK(result.trials == 500);
        CHECK(result.library.failures == 500);
        CHECK(result.library.worst == 3);
        REQUIRE(result.naive.has_value());
        CHECK(result.naive->failures == 500);
        CHECK(std::isnan(result.naive->worst));
        CHECK(result.failed());
        CHECK(run_trials(test_of(1), {}, [](Trial&) {}).failed());
        CHECK_FALSE(run_trials(test_of(1, ""), {}, [](Trial& trial) { trial.record(1); }).naive.has_value());
    }

    TEST_CASE("a row whose trials judge less often than it says fails; one of few trials may be unlucky") {
        const auto run = [](double judged, double share, double factor) {
            StressTest test = test_of(1);
            test.required_fraction = judged;
            StressSetting setting;
            setting.factor = factor;
            return run_trials(test, setting, [&](Trial& trial) {
                if (static_cast<double>(trial.random.uniform()) < share) trial.record(0);
            });
        };
        CHECK(run(0.99, 0.9, 1).failed());
        CHECK(run(0.99, 0.9, 1).least_trials > 970);
        CHECK_FALSE(run(0.99, 1, 1).failed());
        CHECK_FALSE(run(0.5, 0.5, 1).failed()); // 500 of 1000 expected, 420 required
        CHECK(run(0.5, 0.3, 1).failed());
        CHECK_FALSE(run(0.5, 0.5, 0.03).failed());
    }

    TEST_CASE("failures of the naive way alone fail nothing") {
        const StressResult result = uniform_errors(1, {});
        CHECK_FALSE(result.failed());
        CHECK(result.naive->failures > 400);
        CHECK(result.naive->failures < 600);
        CHECK(result.details.empty());
    }

    TEST_CASE("a row depends on seed and factor, not on threads; the first failure explains itself") {
        StressSetting one;
        one.threads = 1;
        StressSetting many = one;
        many.threads = 7;
        const StressResult a = uniform_errors(0.9, one), b = uniform_errors(0.9, many);
        CHECK(a.trials == 1000);
        CHECK(a.library.failures == b.library.failures);
        CHECK(a.library.worst == b.library.worst);
        CHECK(a.library.first_failure == b.library.first_failure);
        CHECK(a.naive->worst == b.naive->worst);
        CHECK(a.details == b.details);
        CHECK(a.details.find("in trial " + std::to_string(a.library.first_failure)) != std::string::npos);
        StressSetting other = one;
        other.seed = 1;
        CHECK(uniform_errors(0.9, other).library.worst != a.library.worst);
        StressSetting more = many;
        more.factor = 10;
        const StressResult ten = uniform_errors(0.9, more); // starts with the same trials
        CHECK(ten.trials == 10'000);
        CHECK(ten.library.first_failure == a.library.first_failure);
        CHECK(ten.library.worst >= a.library.worst);
        more.factor = 1e-9;
        CHECK(uniform_errors(1, more).trials == 1);
    }

    TEST_CASE("progress rises to 1, and a stop is obeyed") {
        double last = 0;
        bool falls = false;
        StressSetting setting;
        setting.control.progress = [&](double fraction) {
            falls = falls || fraction < last;
            last = fraction;
        };
        uniform_errors(1, setting);
        CHECK(last == 1);
        CHECK_FALSE(falls);
        const std::atomic<bool> stop{true};
        setting.control.stop = &stop;
        CHECK(uniform_errors(1, setting).trials == 0);
    }

    TEST_CASE("names choose tests whole, or by their beginnings at a word's end") {
        CHECK(select_stress_tests({}).size() == all_stress_tests().size());
        const auto one = select_stress_tests({"arithmetic/difference-of-products"});
        REQUIRE(one.size() == 1); // not "arithmetic/difference-of-products-double"
        CHECK(one[0].name == "arithmetic/difference-of-products");
        CHECK(select_stress_tests({"arithmetic/difference"}).size() == 2);
        CHECK(select_stress_tests({"leak", "leak/edges"}).size() == select_stress_tests({"leak"}).size());
        for (const std::string wrong : {"lea", "nothing", ""})
            CHECK_THROWS_WITH_AS(select_stress_tests({wrong}), doctest::Contains("arithmetic, leak, "), Error);
    }

    TEST_CASE("every test has a name of its own in the suite's form, says what it is, and has a default") {
        const std::vector<StressTest> all = all_stress_tests();
        for (std::size_t i = 0; i < all.size(); ++i) {
            CAPTURE(all[i].name);
            CHECK(all[i].name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-/") == std::string_view::npos);
            CHECK(std::count(all[i].name.begin(), all[i].name.end(), '/') == 1);
            CHECK_FALSE(all[i].what.empty());
            CHECK_FALSE(all[i].unit.empty());
            CHECK_FALSE(all[i].source.empty());
            CHECK(all[i].bound >= 0);
            CHECK(all[i].trials > 0);
            for (std::size_t j = 0; j < i; ++j) CHECK(all[j].name != all[i].name);
        }
    }

    TEST_CASE("NaN is the largest of errors, wherever it stands") {
        CHECK(std::isnan(larger_error(kNan, 1)));
        CHECK(std::isnan(larger_error(1, kNan)));
        CHECK(larger_error(2, 1) == 2);
        CHECK(larger_error(1, 2) == 2);
        CHECK(std::isnan(family_log_p_value(kNan, 5)));
    }

    TEST_CASE("errors in ulp, relative, and as odds") {
        CHECK(ulps(1.0f, 1.0L) == 0);
        CHECK(ulps(next_up(1.0f), 1.0L) == 1);
        CHECK(ulps(next_down(2.0f), 2.0L) == 0.5); // the spacing below 2 is half as large
        CHECK(ulps(0.0f, 1e-45L) == doctest::Approx(1e-45 / 0x1p-149));
        CHECK(ulps(3.0, 3.0L + 0x1p-53L) == 0.25);
        CHECK(std::isnan(ulps(std::numeric_limits<float>::quiet_NaN(), 1.0L)));
        CHECK(relative_error(0, 0) == 0);
        CHECK(relative_error(1.5, 1) == 0.5);
        CHECK(family_log_p_value(0.5, 1) == doctest::Approx(-std::log10(0.5)));
        CHECK(family_log_p_value(1e-9, 1000) == doctest::Approx(6).epsilon(1e-6));
        CHECK(family_log_p_value(1e-9, 1000) ==
              doctest::Approx(-std::log10(1 - std::pow(1 - 1e-9, 1000))).epsilon(1e-6));
        CHECK(family_log_p_value(1, 20) == 0);
    }

    TEST_CASE("a trial's random numbers stay in their ranges") {
        TrialRandom random(42);
        float least = 1, most = 0;
        for (int i = 0; i < 10'000; ++i) {
            const float x = random.log_uniform(1e-3f, 1e3f);
            REQUIRE((x > 0.99e-3f && x < 1.01e3f));
            REQUIRE(random.below(7) < 7);
            REQUIRE(std::abs(length(random.direction()) - 1) < 1e-6f);
            const float u = random.uniform();
            least = min(least, u), most = max(most, u);
        }
        CHECK((least >= 0 && least < 1e-3f && most < 1 && most > 0.999f));
    }

    TEST_CASE("the naive column runs the books' way: right on easy rays") {
        const Sphere sphere{{0, 0, -5}, 1};
        CHECK(naive::intersect_sphere({{0, 0, 0}, {0, 0, -1}}, sphere) == 4.0f);
        CHECK(naive::intersect_sphere({{0, 0, -5}, {0, 0, -1}}, sphere) == 1.0f);
        CHECK_FALSE(naive::intersect_sphere({{0, 0, 0}, {0, 0, 1}}, sphere).has_value());
        const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
        CHECK(naive::intersect_triangle({{0.2f, 0.2f, 1}, {0, 0, -1}}, a, b, c) == 1.0f);
        CHECK_FALSE(naive::intersect_triangle({{0.9f, 0.9f, 1}, {0, 0, -1}}, a, b, c).has_value());
        CHECK(naive::intersect_box({{-1, 0.5f, 0.5f}, {1, 0.1f, 0.1f}}, {{0, 0, 0}, {1, 1, 1}}));
        CHECK_FALSE(naive::intersect_box({{-1, 2.5f, 0.5f}, {1, 0.1f, 0.1f}}, {{0, 0, 0}, {1, 1, 1}}));
        CHECK(is_closed_outwards(icosphere(1, 0.1f)));
        CHECK(is_closed_outwards(scaled_and_moved(icosphere(2, 0.1f), 1, {1e5f, -1e5f, 1e5f})));
    }
}
