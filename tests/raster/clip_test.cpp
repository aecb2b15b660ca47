#include "raster/geometry/clip.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

using namespace duet;
using namespace duet::raster;

namespace {

const Viewport kViewport{640, 480, 0.01};

using Key = std::tuple<double, double, double, double>;
Key key(const PixelVertex& v) { return {v.xw, v.yw, v.w, v.depth}; }

std::set<Key> corners(const ClippedPolygon& p) {
    std::set<Key> result;
    for (int i = 0; i < p.count; ++i) result.insert(key(p.vertices[static_cast<std::size_t>(i)]));
    return result;
}

/// Generates vertices in front of and behind the eye, inside and far outside the image.
class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    PixelVertex vertex() {
        std::uniform_real_distribution<double> depth(-5, 5), place(-3000, 3000);
        const double w = depth(engine_);
        const double scale = engine_() % 4 == 0 ? 200 : 1; // some are beyond the guard band
        return {.xw = place(engine_) * scale, .yw = place(engine_) * scale, .w = w, .depth = w};
    }

private:
    std::mt19937 engine_;
};

/// Returns the least of the three barycentric coordinates of a homogeneous point. It is at least −1e-9 if the point
/// is inside the triangle within rounding.
double least_barycentric(const PixelVertex& p, const PixelVertex& a, const PixelVertex& b, const PixelVertex& c) {
    const auto v = [](const PixelVertex& q) { return Vec3d(q.xw, q.yw, q.w); };
    const double det = dot(v(a), cross(v(b), v(c)));
    return std::min(
        {dot(v(p), cross(v(b), v(c))) / det, dot(v(p), cross(v(c), v(a))) / det, dot(v(p), cross(v(a), v(b))) / det});
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("what is kept lies beyond the near plane, within the guard band, and in the triangle") {
        Random random(1);
        int kept = 0;
        for (int i = 0; i < 20000; ++i) {
            const PixelVertex a = random.vertex(), b = random.vertex(), c = random.vertex();
            const ClippedPolygon p = clip(a, b, c, kViewport);
            for (int k = 0; k < p.count; ++k) {
                const PixelVertex& v = p.vertices[static_cast<std::size_t>(k)];
                REQUIRE(v.depth >= kViewport.near * (1 - 1e-9));
                REQUIRE(v.w > 0);
                REQUIRE(std::abs(v.xw / v.w - 320) <= kGuardBand + 321);
                REQUIRE(std::abs(v.yw / v.w - 240) <= kGuardBand + 241);
                REQUIRE(least_barycentric(v, a, b, c) > -1e-7);
                ++kept;
            }
        }
        CHECK(kept > 20000);
    }

    TEST_CASE("a triangle all before the near plane vanishes, one all inside stays as it is") {
        const PixelVertex a{.xw = 10, .yw = 20, .w = 1, .depth = 1}, b{.xw = 600, .yw = 30, .w = 2, .depth = 2},
            c{.xw = 40, .yw = 900, .w = 3, .depth = 3};
        CHECK(corners(clip(a, b, c, kViewport)) == std::set<Key>{key(a), key(b), key(c)});
        const auto behind = [](PixelVertex v) {
            v.w = v.depth = -v.w;
            return v;
        };
        CHECK(clip(behind(a), behind(b), behind(c), kViewport).count == 0);
    }

    TEST_CASE("corners 1e18 meters away take nothing from the precision of near ones") {
        const PixelVertex near_a{.xw = -8, .yw = 100, .w = 1, .depth = 1},
            near_b{.xw = -8, .yw = 300, .w = 1, .depth = 1}, far{.xw = 2e18, .yw = 1e23, .w = 1e18, .depth = 1e18};
        const ClippedPolygon p = clip(near_a, near_b, far, kViewport);
        REQUIRE(p.count >= 4);
        int below = 0; // where the edges of the far corner leave the guard band, yw = bottom · w
        for (int k = 0; k < p.count; ++k) {
            const PixelVertex& v = p.vertices[static_cast<std::size_t>(k)];
            if (v.yw < 400) continue;
            ++below;
            CHECK(v.yw == doctest::Approx((kViewport.height + kGuardBand) * v.w).epsilon(1e-9));
            CHECK(v.xw == doctest::Approx(-8 + 2 * (v.w - 1)).epsilon(1e-9)); // on both edges
        }
        CHECK(below == 2);
    }

    TEST_CASE("both triangles of an edge get the same new vertices, bit for bit") {
        Random random(2);
        int cut_edges = 0;
        for (int i = 0; i < 20000; ++i) {
            // The two triangles share the edge ab and traverse it in opposite directions.
            const PixelVertex a = random.vertex(), b = random.vertex(), c = random.vertex(), d = random.vertex();
            const std::set<Key> left = corners(clip(a, b, c, kViewport)), right = corners(clip(b, a, d, kViewport));
            // A third, degenerate triangle aba has no other edges, so its vertices are exactly the intersections of
            // ab.
            for (const Key& vertex : corners(clip(a, b, a, kViewport))) {
                REQUIRE(left.count(vertex) == 1);
                REQUIRE(right.count(vertex) == 1);
                ++cut_edges;
            }
        }
        CHECK(cut_edges > 5000);
    }
}
