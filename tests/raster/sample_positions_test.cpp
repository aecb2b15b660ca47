#include "raster/geometry/sample_positions.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

using namespace duet;
using namespace duet::raster;

TEST_SUITE("unit") {

    TEST_CASE("a single sample is the center of pixel and lens, as the shutter opens") {
        const std::vector<Pass> passes = plan_passes(1, 17, true, true);
        REQUIRE(passes.size() == 1);
        REQUIRE(passes[0].samples.size() == 1);
        CHECK(passes[0].samples[0].x == 128);
        CHECK(passes[0].samples[0].y == 128);
        CHECK(passes[0].samples[0].position(3, 4) == Vec2d(3.5, 4.5));
        CHECK(passes[0].lens == Vec2d(0.5, 0.5));
        CHECK(passes[0].time == 0);
    }

    TEST_CASE("samples share one pass unless the view has a lens or motion") {
        CHECK(plan_passes(16, 0, false, false).size() == 1);
        CHECK(plan_passes(16, 0, false, false)[0].samples.size() == 16);
        CHECK(plan_passes(16, 0, true, false).size() == 16);
        CHECK(plan_passes(16, 0, false, true).size() == 16);
        for (const Pass& pass : plan_passes(16, 0, true, false)) {
            CHECK(pass.samples.size() == 1);
            CHECK(pass.time == 0);
        }
    }

    TEST_CASE("samples are stratified in x, in y and in both, on the grid, by any seed") {
        for (std::uint64_t seed = 0; seed < 20; ++seed) {
            const std::vector<SampleOffset> samples = plan_passes(16, seed, false, false)[0].samples;
            std::vector<int> xs, ys;
            std::multiset<int> cells;
            for (const SampleOffset s : samples) {
                xs.push_back(s.x);
                ys.push_back(s.y);
            }
            std::sort(xs.begin(), xs.end());
            std::sort(ys.begin(), ys.end());
            // Each sixteenth of the range contains one sample; rounding may move it onto the boundary.
            for (int i = 0; i < 16; ++i) {
                const auto k = static_cast<std::size_t>(i);
                CHECK(xs[k] >= 16 * i);
                CHECK(xs[k] <= 16 * i + 16);
                CHECK(ys[k] >= 16 * i);
                CHECK(ys[k] <= 16 * i + 16);
            }
            // Each of the 4 × 4 cells contains one sample, so at most one sample is strictly inside a cell.
            for (int row = 0; row < 4; ++row)
                for (int column = 0; column < 4; ++column) {
                    const auto inside = [&](SampleOffset s) {
                        return s.x > 64 * column && s.x < 64 * column + 64 && s.y > 64 * row && s.y < 64 * row + 64;
                    };
                    CHECK(std::count_if(samples.begin(), samples.end(), inside) <= 1);
                }
        }
    }

    TEST_CASE("lens and time are stratified, too, and independent of the pixel's order") {
        const std::vector<Pass> passes = plan_passes(64, 5, true, true);
        std::vector<double> times, lens_x;
        double correlation = 0;
        for (const Pass& pass : passes) {
            times.push_back(pass.time);
            lens_x.push_back(pass.lens.x);
            correlation += (pass.time - 0.5) * (pass.lens.x - 0.5) * 12 / 64;
        }
        std::sort(times.begin(), times.end());
        std::sort(lens_x.begin(), lens_x.end());
        for (std::size_t i = 0; i < 64; ++i) {
            CHECK(static_cast<std::size_t>(times[i] * 64) == i);
            CHECK(static_cast<std::size_t>(lens_x[i] * 64) == i);
        }
        CHECK(std::abs(correlation) < 0.1); // equal or reversed orders would give ±1
    }

    TEST_CASE("samples are a function of index and seed: a longer pattern begins with the shorter") {
        const auto few = plan_passes(8, 3, false, false)[0].samples, many = plan_passes(32, 3, false, false)[0].samples;
        for (std::size_t i = 0; i < few.size(); ++i) {
            CHECK(few[i].x == many[i].x);
            CHECK(few[i].y == many[i].y);
        }
        const auto other = plan_passes(8, 4, false, false)[0].samples;
        CHECK_FALSE(std::equal(few.begin(), few.end(), other.begin(),
                               [](SampleOffset a, SampleOffset b) { return a.x == b.x && a.y == b.y; }));
    }
}
