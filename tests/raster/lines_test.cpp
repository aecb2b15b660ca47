// These tests compare integer line rasterization with exact fractions, and clipping with cutting the line into small
// pieces.
#include "raster/overlay/lines.h"
#include "tests/raster/varied_scene.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;
using namespace duet::test;
using raster::FixedPoint, raster::kSubpixels, raster::SampleOffset;

namespace {

constexpr int kSide = 40;
using Marks = Image<std::uint8_t>;

/// Rasterizes the line by its definition, one column at a time, in 64-bit fractions that are compared but never
/// divided.
Marks by_definition(FixedPoint a, FixedPoint b, SampleOffset offset) {
    Marks marks(kSide, kSide, 0);
    std::int64_t u0 = a.x - offset.x, v0 = a.y - offset.y, u1 = b.x - offset.x, v1 = b.y - offset.y;
    const bool steep = std::abs(v1 - v0) > std::abs(u1 - u0);
    if (steep) std::swap(u0, v0), std::swap(u1, v1);
    if (u0 > u1) std::swap(u0, u1), std::swap(v0, v1);
    for (std::int64_t column = 0; column < kSide; ++column) {
        const std::int64_t u = column * kSubpixels;
        if (u < u0 || u >= u1) continue;
        for (std::int64_t row = 0; row < kSide; ++row) {
            // The condition is |v(u) − 256 row| <= 128, where only the upper bound is included, with v(u) = v0 + (u −
            // u0)(v1 − v0)/(u1 − u0).
            // The value is multiplied by u1 − u0.
            const std::int64_t apart = (v0 - row * kSubpixels) * (u1 - u0) + (u - u0) * (v1 - v0);
            const std::int64_t half = kSubpixels / 2 * (u1 - u0);
            if (apart <= half && apart > -half)
                marks(static_cast<int>(steep ? row : column), static_cast<int>(steep ? column : row)) = 1;
        }
    }
    return marks;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a line marks the pixels that its definition says, of any length and place") {
        std::mt19937 engine(7);
        const auto number = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine); };
        int marked = 0;
        for (int trial = 0; trial < 20'000; ++trial) {
            const int reach = std::array{300, 5000, kSide * kSubpixels, 1 << 24}[static_cast<std::size_t>(trial) % 4];
            const FixedPoint middle{number(0, kSide * kSubpixels), number(0, kSide * kSubpixels)};
            const SampleOffset offset = trial % 3 == 0 ? SampleOffset{} : SampleOffset{number(0, 256), number(0, 256)};
            FixedPoint a{middle.x + number(-reach, reach), middle.y + number(-reach, reach)},
                b{2 * middle.x - a.x + number(-9, 9), 2 * middle.y - a.y + number(-9, 9)};
            if (trial % 5 == 0) { // ends on samples and simple fractions as slopes, which cause ties
                a = {number(-4, 44) * kSubpixels + offset.x, number(-4, 44) * kSubpixels + offset.y};
                b = {a.x + number(-6, 6) * 2 * kSubpixels, a.y + number(-6, 6) * kSubpixels};
            }
            Marks marks(kSide, kSide, 0), reversed(kSide, kSide, 0);
            raster::draw_line(a, b, offset, marks);
            raster::draw_line(b, a, offset, reversed);
            CAPTURE(trial);
            REQUIRE(marks.pixels() == by_definition(a, b, offset).pixels());
            REQUIRE(reversed.pixels() == marks.pixels());
            for (const auto m : marks) marked += m;
        }
        CHECK(marked > 100'000);
    }

    TEST_CASE("a chain of lines marks each column once, and leaves none out") {
        std::mt19937 engine(8);
        const auto number = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine); };
        for (int trial = 0; trial < 300; ++trial) {
            std::vector<int> columns(kSide, 0);
            FixedPoint from{-300, kSide * kSubpixels / 2};
            while (from.x < kSide * kSubpixels + 300) {
                const int dx = number(1, 900);
                const FixedPoint to{from.x + dx, from.y + number(-dx, dx) / 2};
                Marks marks(kSide, kSide * 40, 0);
                raster::draw_line({from.x, from.y + 4000 * 32}, {to.x, to.y + 4000 * 32}, {}, marks);
                for (int y = 0; y < marks.height(); ++y)
                    for (int x = 0; x < kSide; ++x) columns[static_cast<std::size_t>(x)] += marks(x, y);
                from = to;
            }
            for (const int count : columns) REQUIRE(count == 1);
        }
    }

    TEST_CASE("lines are cut at the near plane and about the image: what is drawn lies on them, and nothing is lost") {
        const raster::Viewport viewport{kSide, kSide, 0.5, false};
        std::mt19937 engine(9);
        const auto real = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(engine);
        };
        int visible = 0, before = 0;
        for (int trial = 0; trial < 3000; ++trial) {
            const auto vertex = [&] {
                const double depth = real(-3, 6);
                return raster::PixelVertex{.xw = real(-200, 240), .yw = real(-200, 240), .w = depth, .depth = depth};
            };
            const raster::PixelVertex a = vertex(), b = vertex();
            FixedPoint from, to;
            const bool any = raster::clip_line(a, b, viewport, from, to);
            bool wanted = false; // true if a point of the line is well inside the image and beyond the near plane
            double worst = 0;
            for (int k = 0; k <= 4000; ++k) {
                const double t = k / 4000.0, w = a.w + (b.w - a.w) * t;
                if (w < 0.5) continue;
                const double x = (a.xw + (b.xw - a.xw) * t) / w, y = (a.yw + (b.yw - a.yw) * t) / w;
                if (x < 0 || y < 0 || x > kSide || y > kSide) continue;
                wanted = true;
                if (!any) continue;
                // The distance from the point to the clipped line is computed next.
                const Vec2d p(from.x / 256.0, from.y / 256.0), d(to.x / 256.0 - p.x, to.y / 256.0 - p.y),
                    q(x - p.x, y - p.y);
                const double along = std::clamp(dot(q, d) / std::max(dot(d, d), 1e-12), 0.0, 1.0);
                worst = std::max(worst, std::hypot(q.x - d.x * along, q.y - d.y * along));
            }
            visible += wanted;
            before += wanted && (a.depth < 0.5 || b.depth < 0.5);
            if (wanted) REQUIRE(any);
            if (any) {
                REQUIRE(worst < 1.0 / 128);
                for (const FixedPoint end : {from, to}) {
                    REQUIRE(std::abs(end.x / 256.0 - kSide / 2.0) <= kSide / 2.0 + 1.01);
                    REQUIRE(std::abs(end.y / 256.0 - kSide / 2.0) <= kSide / 2.0 + 1.01);
                }
            }
        }
        CHECK(visible > 500);
        CHECK(before > 100);
    }

    TEST_CASE("the image of lines: a quad's outline without its diagonal, the same for any number of threads") {
        Scene scene;
        add(scene, QuadList{{Quad{Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)}}});
        finish_scene(scene);
        const View view{look_orthographic({0, 0, 4}, {0, 0, 0}, 2.5), 64, 64};
        raster::RasterSettings settings;
        settings.shading = raster::Shading::kLines;
        const Rendering shown_image = render(scene, view, settings);
        double sum = 0;
        for (const Rgb c : shown_image.radiance) sum += static_cast<double>(c.r);
        // Each side is 51.2 pixels long, so 51 or 52 columns have a sample within it.
        CHECK(sum >= 4 * 51 - 4);
        CHECK(sum <= 4 * 52);
        CHECK(shown_image.radiance(32, 32).r == 0);
        const Scene varied = varied_scene(60);
        settings.threads = 1;
        settings.samples_per_pixel = 3;
        const Rendering one = render(varied, perspective(), settings);
        settings.threads = 5;
        CHECK(render(varied, perspective(), settings).radiance.pixels() == one.radiance.pixels());
    }
}
