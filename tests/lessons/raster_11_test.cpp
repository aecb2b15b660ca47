// Lesson raster-11: 32-bit edges, tiles and the library cover what lesson 02 covers.
#include "compare/stress/raster_stages.h"
#include "raster/lessons/11-tiles-and-simd/tiles.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;

namespace {

std::int64_t wide(const lesson::Edge& e, std::int64_t x, std::int64_t y) { return e.a * x + e.b * y + e.c; }

} // namespace

TEST_SUITE("lesson") {

    TEST_CASE("raster-11: an edge of 32 bits has the pixels inside that lesson 02 has, and does not overflow") {
        std::mt19937 random(11);
        const auto integer = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
        for (int i = 0; i < 200'000; ++i) {
            const int reach = i % 2 ? 2048 * 256 : 6 * 256; // a picture of 2048 pixels, and one of 6
            lesson::FixedPoint from{integer(0, reach), integer(0, reach)}, to{integer(0, reach), integer(0, reach)};
            if (i % 8 < 4) // through centers
                from = {from.x / 256 * 256 + 128, from.y / 256 * 256 + 128},
                to = {to.x / 256 * 256 + 128, to.y / 256 * 256 + 128};
            if (from.x == to.x && from.y == to.y) continue;
            const lesson::Edge edge = lesson::make_edge(from, to);
            const int x = integer(0, reach / 256 - 1), y = integer(0, reach / 256 - 1);
            const std::int64_t w = lesson::edge_function(from, to, lesson::pixel_center(x, y));
            CAPTURE(i);
            REQUIRE((wide(edge, x, y) >= 0) == lesson::is_inside(w, from, to));
            REQUIRE(std::abs(wide(edge, x, y)) < (std::int64_t{1} << 31));
            REQUIRE(edge.at(x, y) == wide(edge, x, y));
            const raster::EdgeFunction library({int(from.x), int(from.y)}, {int(to.x), int(to.y)});
            REQUIRE((library.at(256 * x + 128, 256 * y + 128) >= 0) == (edge.at(x, y) >= 0));
        }
    }

    TEST_CASE("raster-11: what tiles cover is what lesson 02 and the library cover") {
        constexpr int kSize = 48, kTile = 8;
        std::mt19937 random(12);
        const auto integer = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
        std::array<int, 3> states{};
        for (int i = 0; i < 1500; ++i) {
            std::array<lesson::FixedPoint, 3> p;
            for (lesson::FixedPoint& q : p) {
                q = {integer(0, kSize * 256), integer(0, kSize * 256)};
                if (i % 4 == 0) q = {q.x / 256 * 256 + 128, q.y / 256 * 256 + 128};
            }
            if (lesson::edge_function(p[0], p[1], p[2]) < 0) std::swap(p[1], p[2]);
            if (lesson::edge_function(p[0], p[1], p[2]) == 0) continue;
            const std::array<lesson::Edge, 3> edges{lesson::make_edge(p[0], p[1]), lesson::make_edge(p[1], p[2]),
                                                    lesson::make_edge(p[2], p[0])};
            const auto inside = [&](int x, int y) {
                return edges[0].at(x, y) >= 0 && edges[1].at(x, y) >= 0 && edges[2].at(x, y) >= 0;
            };
            Image<int> naive(kSize, kSize), tiles(kSize, kSize);
            const auto pixels = [](lesson::FixedPoint q) {
                return Vec2{static_cast<float>(q.x) / 256, static_cast<float>(q.y) / 256};
            };
            lesson::for_each_pixel(pixels(p[0]), pixels(p[1]), pixels(p[2]), kSize, kSize,
                                   [&](int x, int y, Vec3) { ++naive(x, y); });
            for (int y = 0; y < kSize; y += kTile)
                for (int x = 0; x < kSize; x += kTile) {
                    const lesson::Tile tile = lesson::test_tile(edges, x, y, kTile);
                    ++states[static_cast<std::size_t>(tile)];
                    for (int k = 0; k < kTile * kTile; ++k) {
                        const int px = x + k % kTile, py = y + k / kTile;
                        tiles(px, py) =
                            tile == lesson::Tile::kInside || (tile == lesson::Tile::kPartial && inside(px, py));
                    }
                }
            compare::CoverageProbe probe({{0, 0, kSize, kSize}, {}});
            probe.draw(
                {raster::FixedPoint{int(p[0].x), int(p[0].y)}, {int(p[1].x), int(p[1].y)}, {int(p[2].x), int(p[2].y)}});
            Image<int> library(kSize, kSize);
            for (int y = 0; y < kSize; ++y)
                for (int x = 0; x < kSize; ++x) library(x, y) = probe.covers(x, y);
            CAPTURE(i);
            REQUIRE(naive.pixels() == tiles.pixels());
            REQUIRE(naive.pixels() == library.pixels());
        }
        for (const int state : states) CHECK(state > 300);
    }
}
