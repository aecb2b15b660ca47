// These tests compare the coverage of fixed-point edge functions with an oracle in wider integers.
#include "compare/stress/raster_stages.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>

using namespace duet;
using namespace duet::raster;

namespace {

constexpr int kSize = 48; // pixels per side of the test image
const PixelRect kImage{0, 0, kSize, kSize};

using compare::CoverageProbe, compare::GridTriangle;

bool has_area(const GridTriangle& t) { return doubled_area(t[0], t[1], t[2]) != 0; }

/// Returns how many triangles cover each sample of the image.
Image<int> covered(const std::vector<GridTriangle>& triangles, SampleOffset offset) {
    Image<int> count(kSize, kSize, 0);
    CoverageProbe probe({kImage, offset});
    for (const GridTriangle& t : triangles) {
        probe.draw(t);
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) count(x, y) += probe.covers(x, y) ? 1 : 0;
    }
    return count;
}

Image<int> expected(const std::vector<GridTriangle>& triangles, SampleOffset offset) {
    Image<int> count(kSize, kSize, 0);
    for (const GridTriangle& t : triangles)
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x)
                count(x, y) += compare::covers(t, x * kSubpixels + offset.x, y * kSubpixels + offset.y) ? 1 : 0;
    return count;
}

/// Returns a text image of the difference: '.' correct, a digit where more is covered than expected, '-' where less.
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

void check_equal(const Image<int>& found, const Image<int>& wanted, const GridTriangle& t) {
    const bool equal = found.pixels() == wanted.pixels();
    if (!equal)
        for (const FixedPoint p : t) MESSAGE("corner (1/256 pixel): ", p.x, ", ", p.y);
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

constexpr int kFull = kSize * kSubpixels;

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("coverage equals the exact oracle: triangles of all sizes") {
        Random random(1);
        for (int i = 0; i < 1500; ++i) {
            // Triangle sizes range from sub-pixel to the size of the image and the largest that the guard band
            // allows.
            const int reach = std::array{200, 2000, kFull, 20 * kFull,
                                         static_cast<int>(kGuardBand) * kSubpixels}[static_cast<std::size_t>(i) % 5];
            const FixedPoint near = random.point(0, kFull);
            const auto corner = [&] {
                return FixedPoint{near.x + random.integer(-reach, reach), near.y + random.integer(-reach, reach)};
            };
            const SampleOffset offset{random.integer(0, 256), random.integer(0, 256)};
            const std::vector<GridTriangle> one{{corner(), corner(), corner()}};
            if (!has_area(one[0])) continue;
            check_equal(covered(one, offset), expected(one, offset), one[0]);
        }
    }

    TEST_CASE("coverage equals the exact oracle: edges and corners through samples") {
        Random random(2);
        for (int i = 0; i < 1500; ++i) {
            const SampleOffset offset; // all vertices are on sample points, so every edge passes through some
            const auto corner = [&] {
                return FixedPoint{random.integer(-4, kSize + 4) * kSubpixels + offset.x,
                                  random.integer(-4, kSize + 4) * kSubpixels + offset.y};
            };
            const std::vector<GridTriangle> one{{corner(), corner(), corner()}};
            if (!has_area(one[0])) continue;
            check_equal(covered(one, offset), expected(one, offset), one[0]);
        }
    }

    TEST_CASE("coverage equals the exact oracle: slivers") {
        Random random(3);
        for (int i = 0; i < 1500; ++i) {
            const FixedPoint a = random.point(-kFull, 2 * kFull), b = random.point(-kFull, 2 * kFull);
            const FixedPoint c{b.x + random.integer(-3, 3), b.y + random.integer(-3, 3)};
            const std::vector<GridTriangle> one{{a, b, c}};
            if (!has_area(one[0])) continue;
            check_equal(covered(one, {}), expected(one, {}), one[0]);
        }
    }

    TEST_CASE("a sample beside a sliver sees the sliver's nearest point, not one of its ends") {
        // The triangle is 8e-8 pixels wide and 8 pixels long, with larger depth at the upper end. The sample is 3e-4
        // pixels beside it.
        const auto vertex = [](double x, double y, double depth) {
            return PixelVertex{.xw = x * depth, .yw = y * depth, .w = depth, .depth = depth};
        };
        const Interpolation sliver(vertex(19.9046225, 21.9291211, 5.91187377),
                                   vertex(17.0116565, 14.8682996, 7.53373377),
                                   vertex(19.755635, 21.5654896, 5.97815284), {4355, 3806});
        const Interpolated at = sliver.at({18.5, 18.5}, TriangleKind::kTriangle);
        const double depth = at.depth_sum / at.sum;
        const double x =
            (at.b0 * 19.9046225 * 5.91187377 + at.b1 * 17.0116565 * 7.53373377 + at.b2 * 19.755635 * 5.97815284) /
            at.depth_sum;
        CHECK(std::abs(x - 18.5) < 1.0 / 128);
        CHECK(depth == doctest::Approx(6.62).epsilon(0.01)); // the ends have depths 5.91 and 7.53
    }

    TEST_CASE("a sample beside a triangle seen edge-on sees the nearer of the two edges there") {
        // In the image, the corners lie on one line through (10, 10) with the slope 1/2.
        const auto vertex = [](double along, double depth) {
            return PixelVertex{.xw = (10 + along) * depth, .yw = (10 + along / 2) * depth, .w = depth, .depth = depth};
        };
        std::array corners{vertex(0, 2), vertex(4, 8), vertex(8, 4)};
        for (int rotation = 0; rotation < 3; ++rotation) {
            std::rotate(corners.begin(), corners.begin() + 1, corners.end());
            const Interpolation triangle(corners[0], corners[1], corners[2], {2560, 2560});
            const auto depth_at = [&](double along, double beside) {
                const Interpolated at = triangle.at({10 + along - beside / 2, 10 + along / 2 + beside},
                                                    TriangleKind::kTriangle);
                CHECK(min(at.b0, min(at.b1, at.b2)) >= 0);
                CHECK(at.sum == doctest::Approx(at.b0 + at.b1 + at.b2));
                return at.depth_sum / at.sum;
            };
            // The nearer edge, from the first to the last corner, has an inverse depth linear in the image.
            for (const double along : {0.5, 3.0, 4.0, 7.5})
                CHECK(depth_at(along, 1e-3) == doctest::Approx(1 / (0.5 + along / 8 * (0.25 - 0.5))));
            CHECK(depth_at(-1e-3, 0) == doctest::Approx(2)); // beyond the ends
            CHECK(depth_at(8.001, -1e-3) == doctest::Approx(4));
        }
    }

    TEST_CASE("samples at the ends of a triangle seen edge-on see the corner there, however near the others are") {
        const auto vertex = [](double x, double y, double w) {
            return PixelVertex{.xw = x * w, .yw = y * w, .w = w, .depth = w};
        };
        const auto depth_at = [&](std::array<PixelVertex, 3> corners, Vec2d p) {
            const Interpolation triangle(corners[0], corners[1], corners[2], {2560, 2560});
            const Interpolated at = triangle.at(p, TriangleKind::kTriangle);
            return at.depth_sum / at.sum;
        };
        CHECK(depth_at({vertex(10, 10, 1e6), vertex(310, 160, 1), vertex(160, 85, 2)}, {9.999, 9.9995}) == 1e6);
        CHECK(depth_at({vertex(10, 10, 4096), vertex(18, 14, 1.0 / 128), vertex(14, 12, 1)}, {9.999, 9.9995}) == 4096);
        // Two corners are behind the eye.
        CHECK(depth_at({vertex(12, 11, -1e-3), vertex(11, 10.5, -2e-3), vertex(10, 10, 100)}, {10.0019, 10.00095}) > 0);
    }

    TEST_CASE("triangles seen edge-on anywhere in the image have depths between those of their corners") {
        std::mt19937 random(7);
        std::uniform_real_distribution<double> uniform(0, 1);
        int outside = 0;
        for (int i = 0; i < 100000; ++i) {
            const Vec2d from(16000 * uniform(random), 16000 * uniform(random));
            const Vec2d direction = i % 2 == 0 ? Vec2d(40, 0) : Vec2d(80 * uniform(random) - 40, 80 * uniform(random));
            std::array<PixelVertex, 3> corners;
            std::array<double, 3> along{0, uniform(random), 1};
            for (std::size_t k = 0; k < 3; ++k) {
                const double w = 0.1 + 20 * uniform(random);
                const Vec2d p = from + direction * along[k];
                corners[k] = {.xw = p.x * w, .yw = p.y * w, .w = w, .depth = w};
            }
            const Vec2d sample = from + direction * uniform(random) + Vec2d(1e-3, 1e-3) * uniform(random);
            const FixedPoint beside{static_cast<std::int32_t>(from.x) * 256, static_cast<std::int32_t>(from.y) * 256};
            const Interpolated at =
                Interpolation(corners[0], corners[1], corners[2], beside).at(sample, TriangleKind::kTriangle);
            const double depth = at.depth_sum / at.sum;
            const auto [least, most] = std::minmax({corners[0].depth, corners[1].depth, corners[2].depth});
            outside += !(depth >= least * (1 - 1e-9) && depth <= most * (1 + 1e-9));
        }
        CHECK(outside == 0);
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
            // Every second hub is on a sample, so all triangles of the fan touch that sample.
            const FixedPoint hub = i % 2 == 0 ? FixedPoint{128 + 256 * random.integer(2, kSize - 3),
                                                           128 + 256 * random.integer(2, kSize - 3)}
                                              : random.point(500, kFull - 500);
            std::vector<GridTriangle> fan;
            for (std::size_t k = 0; k < frame.size(); ++k)
                fan.push_back({hub, frame[k], frame[(k + 1) % frame.size()]});
            const Image<int> count = covered(fan, {});
            REQUIRE_MESSAGE(std::all_of(count.begin(), count.end(), [](int c) { return c == 1; }), "hub at ", hub.x,
                            ", ", hub.y, " (1/256 pixel)\n", difference_map(count, Image<int>(kSize, kSize, 1)));
        }
    }

    TEST_CASE("a random mesh over the image covers each sample once") {
        Random random(5);
        constexpr int kCells = 24;
        std::vector<FixedPoint> grid;
        for (int y = 0; y <= kCells; ++y)
            for (int x = 0; x <= kCells; ++x) {
                const int step = kFull / kCells + 40, jitter = step / 3;
                grid.push_back({-400 + x * step + random.integer(-jitter, jitter),
                                -400 + y * step + random.integer(-jitter, jitter)});
            }
        std::vector<GridTriangle> mesh;
        for (std::size_t y = 0; y < kCells; ++y)
            for (std::size_t x = 0; x < kCells; ++x) {
                const FixedPoint a = grid[y * (kCells + 1) + x], b = grid[y * (kCells + 1) + x + 1];
                const FixedPoint c = grid[(y + 1) * (kCells + 1) + x + 1], d = grid[(y + 1) * (kCells + 1) + x];
                mesh.push_back({a, b, c});
                mesh.push_back({a, c, d});
            }
        for (const SampleOffset offset : {SampleOffset{}, SampleOffset{0, 0}, SampleOffset{256, 77}}) {
            const Image<int> count = covered(mesh, offset);
            REQUIRE_MESSAGE(std::all_of(count.begin(), count.end(), [](int c) { return c == 1; }), "\n",
                            difference_map(count, Image<int>(kSize, kSize, 1)));
        }
    }

    TEST_CASE("drawing into the tiles of a grid covers what the oracle says") {
        Random random(6);
        constexpr int kWidth = 300, kHeight = 270; // three by three tiles, smaller ones at the edges
        const TileGrid grid{{0, 0, kWidth, kHeight}};
        for (int i = 0; i < 100; ++i) {
            const auto place = [&] { return random.integer(-kFull, 4 * kFull); };
            std::vector<GridTriangle> one{
                {FixedPoint{place(), place()}, FixedPoint{place(), place()}, FixedPoint{place(), place()}}};
            if (i % 2 == 0)
                one[0][1] = {one[0][0].x + random.integer(-300, 300), one[0][0].y + random.integer(-300, 300)};
            if (i % 2 == 0)
                one[0][2] = {one[0][0].x + random.integer(-300, 300), one[0][0].y + random.integer(-300, 300)};
            const SampleOffset offset{random.integer(0, 256), random.integer(0, 256)};
            int wrong = 0;
            for (std::size_t k = 0; k < grid.size(); ++k) {
                const PixelRect rect = grid.tile(k);
                CoverageProbe probe({rect, offset});
                probe.draw(one[0]);
                for (int y = rect.y0; y < rect.y1; ++y)
                    for (int x = rect.x0; x < rect.x1; ++x)
                        wrong += probe.covers(x, y) !=
                                 compare::covers(one[0], x * kSubpixels + offset.x, y * kSubpixels + offset.y);
            }
            REQUIRE(wrong == 0);
        }
    }

    TEST_CASE("a batch's triangles, coverage masks and fragments are sorted by tile, in their order within each") {
        Random random(7);
        TileSorter sorter;
        for (int trial = 0; trial < 20; ++trial) {
            constexpr std::size_t kTiles = 50;
            Batch batch;
            std::vector<TileSorter::TileOverlap> triangle_overlaps, mask_overlaps;
            std::array<std::vector<std::uint32_t>, kTiles> wanted, wanted_masks, wanted_fragments;
            for (std::uint32_t i = 0; i < 500; ++i) {
                const auto tile = static_cast<std::uint32_t>(random.integer(0, kTiles - 1) * random.integer(0, 1));
                triangle_overlaps.push_back({tile, i});
                wanted[tile].push_back(i);
                const auto other = static_cast<std::uint32_t>((tile + 7) % kTiles);
                mask_overlaps.push_back({other, i});
                wanted_masks[other].push_back(i);
                Fragment fragment;
                fragment.id = i;
                fragment.tile = static_cast<std::uint16_t>(kTiles - 1 - tile);
                batch.fragments.push_back(fragment);
                wanted_fragments[kTiles - 1 - tile].push_back(i);
            }
            sorter.sort(batch, triangle_overlaps, mask_overlaps, kTiles);
            const std::vector<Batch> batches{batch};
            TileLists triangles, coverage_masks, fragments;
            triangles.gather(batches, &Batch::triangle_segments, kTiles);
            coverage_masks.gather(batches, &Batch::mask_segments, kTiles);
            fragments.gather(batches, &Batch::fragment_segments, kTiles);
            for (std::size_t tile = 0; tile < kTiles; ++tile) {
                std::vector<std::uint32_t> found, found_masks, found_fragments;
                for (const TileLists::Item& item : triangles.tile(tile))
                    for (std::uint32_t k = 0; k < item.count; ++k) found.push_back(batch.order[item.first + k]);
                for (const TileLists::Item& item : coverage_masks.tile(tile))
                    for (std::uint32_t k = 0; k < item.count; ++k)
                        found_masks.push_back(batch.mask_order[item.first + k]);
                for (const TileLists::Item& item : fragments.tile(tile))
                    for (std::uint32_t k = 0; k < item.count; ++k)
                        found_fragments.push_back(batch.fragments[item.first + k].id);
                REQUIRE(found == wanted[tile]);
                REQUIRE(found_masks == wanted_masks[tile]);
                REQUIRE(found_fragments == wanted_fragments[tile]);
            }
        }
    }

    TEST_CASE("a sample beyond the snapped edges' margins is inside of the triangle before it was snapped") {
        Random random(11);
        int beyond = 0, outside = 0, outside_half = 0;
        for (int trial = 0; trial < 30'000; ++trial) {
            const int reach = std::array{40, 300, 3000, 16000}[static_cast<std::size_t>(trial) % 4];
            const int low = trial % 3 == 0 ? reach / 50 : reach;
            std::array<FixedPoint, 3> p{
                random.point(0, reach), random.point(0, reach), {random.integer(0, reach), random.integer(0, low)}};
            if (doubled_area(p[0], p[1], p[2]) < 0) std::swap(p[1], p[2]);
            if (doubled_area(p[0], p[1], p[2]) == 0) continue;
            DrawTriangle triangle;
            triangle.corners = p;
            const std::array<std::int64_t, 3> margins = edge_margins(triangle);
            for (int i = 0; i < 10; ++i) { // samples, most of them close to an edge
                const auto near = static_cast<std::size_t>(random.integer(0, 2));
                const double t = random.integer(0, 1000) / 1000.0,
                             depth = random.integer(0, 100) * random.integer(0, 100) * 1e-6;
                const FixedPoint &a = p[near], &b = p[(near + 1) % 3], &c = p[(near + 2) % 3];
                const auto mixed = [&](int u, int v, int w) {
                    return static_cast<std::int32_t>(std::lround((u * (1 - t) + v * t) * (1 - depth) + w * depth));
                };
                const FixedPoint s{mixed(a.x, b.x, c.x), mixed(a.y, b.y, c.y)};
                bool all = true, half = true; // beyond the margins, and beyond half the margins
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int64_t value = doubled_area(p[k], p[(k + 1) % 3], s);
                    all = all && value >= margins[k];
                    half = half && 2 * value >= margins[k];
                }
                if (!half) continue;
                bool inside = true; // for all vertex positions within their grid squares, in units of half grid points
                for (std::size_t k = 0; k < 3; ++k)
                    for (int moves = 0; moves < 16; ++moves) {
                        const auto moved = [&](const FixedPoint& q, int bits) {
                            return FixedPoint{2 * q.x + (bits & 1) * 2 - 1, 2 * q.y + (bits >> 1 & 1) * 2 - 1};
                        };
                        inside = inside && doubled_area(moved(p[k], moves), moved(p[(k + 1) % 3], moves >> 2),
                                                        {2 * s.x, 2 * s.y}) >= 0;
                    }
                beyond += all;
                outside += all && !inside;
                outside_half += !inside;
            }
        }
        CHECK(beyond > 100'000);
        CHECK(outside == 0);
        CHECK(outside_half > 100); // half the margins would not suffice
    }

    TEST_CASE("of coincident surfaces the lower number wins in any order") {
        const auto vertex = [](double x, double y) { return PixelVertex{.xw = x, .yw = y, .w = 1, .depth = 1}; };
        const Viewport viewport{kSize, kSize, 0.5, true};
        compare::SetupTriangles setup;
        const std::array<FixedPoint, 3> corners{{{0, 0}, {kFull, 0}, {0, kFull}}};
        for (std::uint32_t id = 0; id < 4; ++id) {
            setup.source_triangles.push_back({vertex(0, 0), vertex(kSize, 0), vertex(0, kSize)});
            setup.triangles.push_back(set_up(setup.source_triangles[id], corners, id, false, viewport));
        }
        std::vector<std::size_t> order{0, 1, 2, 3};
        do {
            DepthTile tile;
            tile.reset(kImage, {}, viewport);
            for (const std::size_t i : order) tile.draw(setup.triangles[i], setup);
            REQUIRE(tile.id(5, 5) == 0);
            REQUIRE(tile.reversed_depth(5, 5) == 0.5f);
        } while (std::next_permutation(order.begin(), order.end()));
    }
}
