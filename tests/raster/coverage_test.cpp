// Coverage by fixed-point edge functions against an oracle in wider integers.
#include "raster/cover.h"

#include "compare/stress/exact_coverage.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>

using namespace duet;
using namespace duet::raster;

namespace {

constexpr int kSize = 48; // pixels a side of the test picture
const PixelRect kPicture{0, 0, kSize, kSize};

Pinhole test_pinhole() { return CameraModel({Camera{}, kSize, kSize}).through(); }

SetupTriangle triangle(FixedPoint a, FixedPoint b, FixedPoint c) {
    if (doubled_area(a, b, c) < 0) std::swap(b, c);
    const auto vertex = [](FixedPoint p) {
        return PixelVertex{.xw = static_cast<double>(p.x) / kSubPixels,
                           .yw = static_cast<double>(p.y) / kSubPixels,
                           .w = 1,
                           .depth = 1};
    };
    return {.corners = {a, b, c}, .interpolation = Interpolation(vertex(a), vertex(b), vertex(c), a)};
}

/// How often the triangles cover each sample of the picture.
Image<int> covered(const std::vector<SetupTriangle>& triangles, SampleOffset offset) {
    Image<int> count(kSize, kSize, 0);
    const Pinhole pinhole = test_pinhole();
    for (const SetupTriangle& t : triangles) {
        HitTile tile(kPicture, pinhole, offset, 0);
        tile.draw(t);
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) count(x, y) += tile.hit(x, y).valid() ? 1 : 0;
    }
    return count;
}

Image<int> expected(const std::vector<SetupTriangle>& triangles, SampleOffset offset) {
    Image<int> count(kSize, kSize, 0);
    for (const SetupTriangle& t : triangles)
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x)
                count(x, y) += compare::covers(t.corners, x * kSubPixels + offset.x, y * kSubPixels + offset.y) ? 1 : 0;
    return count;
}

/// A picture of the difference: '.' right, digits where more is covered than expected, '-' where less.
std::string difference_map(const Image<int>& found, const Image<int>& wanted) {
    std::string map;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const int d = found(x, y) - wanted(x, y);
            map += d == 0 ? '.' : d < 0 ? '-' : static_cast<char>('0' + std::min(d, 9));
        }
        map += '\n';
    }
    return map;
}

void check_equal(const Image<int>& found, const Image<int>& wanted, const SetupTriangle& t) {
    const bool equal = found.pixels() == wanted.pixels();
    if (!equal)
        for (const FixedPoint p : t.corners) MESSAGE("corner (1/256 pixel): ", p.x, ", ", p.y);
    REQUIRE_MESSAGE(equal, "coverage differs ('-': missing, digits: too much)\n", difference_map(found, wanted));
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
    FixedPoint point(int low, int high) { return {integer(low, high), integer(low, high)}; }

private:
    std::mt19937 engine_;
};

constexpr int kFull = kSize * kSubPixels;

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("coverage equals the exact oracle: triangles of all sizes") {
        Random random(1);
        for (int i = 0; i < 1500; ++i) {
            // From sub-pixel ones over those about the picture to the largest that the guard band lets through.
            const int reach = std::array{200, 2000, kFull, 20 * kFull,
                                         static_cast<int>(kGuardBand) * kSubPixels}[static_cast<std::size_t>(i) % 5];
            const FixedPoint near = random.point(0, kFull);
            const auto corner = [&] {
                return FixedPoint{near.x + random.integer(-reach, reach), near.y + random.integer(-reach, reach)};
            };
            const SampleOffset offset{random.integer(0, 256), random.integer(0, 256)};
            const std::vector<SetupTriangle> one{triangle(corner(), corner(), corner())};
            if (doubled_area(one[0].corners[0], one[0].corners[1], one[0].corners[2]) == 0) continue;
            check_equal(covered(one, offset), expected(one, offset), one[0]);
        }
    }

    TEST_CASE("coverage equals the exact oracle: edges and corners through samples") {
        Random random(2);
        for (int i = 0; i < 1500; ++i) {
            const SampleOffset offset; // all corners on sample points: every edge runs through some
            const auto corner = [&] {
                return FixedPoint{random.integer(-4, kSize + 4) * kSubPixels + offset.x,
                                  random.integer(-4, kSize + 4) * kSubPixels + offset.y};
            };
            const std::vector<SetupTriangle> one{triangle(corner(), corner(), corner())};
            if (doubled_area(one[0].corners[0], one[0].corners[1], one[0].corners[2]) == 0) continue;
            check_equal(covered(one, offset), expected(one, offset), one[0]);
        }
    }

    TEST_CASE("coverage equals the exact oracle: slivers") {
        Random random(3);
        for (int i = 0; i < 1500; ++i) {
            const FixedPoint a = random.point(-kFull, 2 * kFull), b = random.point(-kFull, 2 * kFull);
            const FixedPoint c{b.x + random.integer(-3, 3), b.y + random.integer(-3, 3)};
            const std::vector<SetupTriangle> one{triangle(a, b, c)};
            if (doubled_area(one[0].corners[0], one[0].corners[1], one[0].corners[2]) == 0) continue;
            check_equal(covered(one, {}), expected(one, {}), one[0]);
        }
    }

    TEST_CASE("a sample beside a sliver sees the sliver's nearest point, not one of its ends") {
        // 8e-8 pixels wide, 8 long, deeper to the upper end; the sample lies 3e-4 pixels beside it.
        const auto vertex = [](double x, double y, double depth) {
            return PixelVertex{.xw = x * depth, .yw = y * depth, .w = depth, .depth = depth};
        };
        const Interpolation sliver(vertex(19.9046225, 21.9291211, 5.91187377),
                                   vertex(17.0116565, 14.8682996, 7.53373377),
                                   vertex(19.755635, 21.5654896, 5.97815284), {4355, 3806});
        const Interpolated at = sliver.at({18.5, 18.5}, Piece::kTriangle);
        const double depth = at.depth_sum / at.sum;
        const double x =
            (at.b0 * 19.9046225 * 5.91187377 + at.b1 * 17.0116565 * 7.53373377 + at.b2 * 19.755635 * 5.97815284) /
            at.depth_sum;
        CHECK(std::abs(x - 18.5) < 1.0 / 128);
        CHECK(depth == doctest::Approx(6.62).epsilon(0.01)); // the ends are at 5.91 and 7.53
    }

    TEST_CASE("a fan around a vertex covers each sample once") {
        Random random(4);
        const std::vector<FixedPoint> frame{{-500, -500},
                                            {kFull / 2, -700},
                                            {kFull + 500, -500},
                                            {kFull + 300, kFull / 3},
                                            {kFull + 500, kFull + 500},
                                            {-500, kFull + 500},
                                            {-900, kFull / 2}};
        for (int i = 0; i < 60; ++i) {
            // The hub lies on a sample every other time, which all triangles of the fan then touch.
            const FixedPoint hub = i % 2 == 0 ? FixedPoint{128 + 256 * random.integer(2, kSize - 3),
                                                           128 + 256 * random.integer(2, kSize - 3)}
                                              : random.point(500, kFull - 500);
            std::vector<SetupTriangle> fan;
            for (std::size_t k = 0; k < frame.size(); ++k)
                fan.push_back(triangle(hub, frame[k], frame[(k + 1) % frame.size()]));
            const Image<int> count = covered(fan, {});
            REQUIRE_MESSAGE(std::all_of(count.begin(), count.end(), [](int c) { return c == 1; }), "hub at ", hub.x,
                            ", ", hub.y, " (1/256 pixel)\n", difference_map(count, Image<int>(kSize, kSize, 1)));
        }
    }

    TEST_CASE("a random mesh over the picture covers each sample once") {
        Random random(5);
        constexpr int kCells = 24;
        std::vector<FixedPoint> grid;
        for (int y = 0; y <= kCells; ++y)
            for (int x = 0; x <= kCells; ++x) {
                const int step = kFull / kCells + 40, jitter = step / 3;
                grid.push_back({-400 + x * step + random.integer(-jitter, jitter),
                                -400 + y * step + random.integer(-jitter, jitter)});
            }
        std::vector<SetupTriangle> mesh;
        for (std::size_t y = 0; y < kCells; ++y)
            for (std::size_t x = 0; x < kCells; ++x) {
                const FixedPoint a = grid[y * (kCells + 1) + x], b = grid[y * (kCells + 1) + x + 1];
                const FixedPoint c = grid[(y + 1) * (kCells + 1) + x + 1], d = grid[(y + 1) * (kCells + 1) + x];
                mesh.push_back(triangle(a, b, c));
                mesh.push_back(triangle(a, c, d));
            }
        for (const SampleOffset offset : {SampleOffset{}, SampleOffset{0, 0}, SampleOffset{256, 77}}) {
            const Image<int> count = covered(mesh, offset);
            REQUIRE_MESSAGE(std::all_of(count.begin(), count.end(), [](int c) { return c == 1; }), "\n",
                            difference_map(count, Image<int>(kSize, kSize, 1)));
        }
    }

    TEST_CASE("drawing into tiles gives what drawing at once gives") {
        Random random(6);
        const TileGrid grid{kSize, kSize};
        const Pinhole pinhole = test_pinhole();
        for (int i = 0; i < 200; ++i) {
            const std::vector<SetupTriangle> one{triangle(
                random.point(-kFull, 2 * kFull), random.point(-kFull, 2 * kFull), random.point(-kFull, 2 * kFull))};
            const std::vector<SampleOffset> samples{{random.integer(0, 256), random.integer(0, 256)}, {0, 256}};
            const Bins bins = bin(grid, one, samples);
            Image<int> count(kSize, kSize, 0);
            for (std::size_t k = 0; k < grid.size(); ++k) {
                HitTile tile(grid.tile(k), pinhole, samples[0], 0);
                for (const std::uint32_t index : bins.tile(k)) tile.draw(one[index]);
                for (int y = tile.rect().y0; y < tile.rect().y1; ++y)
                    for (int x = tile.rect().x0; x < tile.rect().x1; ++x) count(x, y) += tile.hit(x, y).valid() ? 1 : 0;
            }
            check_equal(count, expected(one, samples[0]), one[0]);
        }
    }

    TEST_CASE("of coincident surfaces the lower object, then primitive, wins in any order") {
        const FixedPoint a{0, 0}, b{kFull, 0}, c{0, kFull};
        std::vector<SetupTriangle> same(4, triangle(a, b, c));
        same[0].object = 2, same[0].primitive = 0;
        same[1].object = 1, same[1].primitive = 7;
        same[2].object = 1, same[2].primitive = 3;
        same[3].object = 5, same[3].primitive = 1;
        std::vector<std::size_t> order{0, 1, 2, 3};
        do {
            HitTile tile(kPicture, test_pinhole(), {}, 0);
            for (const std::size_t i : order) tile.draw(same[i]);
            REQUIRE(tile.hit(5, 5).object == 1);
            REQUIRE(tile.hit(5, 5).primitive == 3);
        } while (std::next_permutation(order.begin(), order.end()));
    }
}
