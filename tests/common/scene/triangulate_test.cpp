// These tests triangulate polygons. The triangles must cover the polygon exactly, at any scale, offset and
// orientation.
#include "common/scene/obj/triangulate.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>

using namespace duet;

namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;
using Polygon = std::vector<Vec2d>;

/// Returns the polygon in a plane of 3D space, rotated, scaled and translated.
std::vector<Vec3> placed(const Polygon& polygon, double scale, double offset, int plane) {
    const Vec3d axes[3][2] = {{{1, 0, 0}, {0, 1, 0}}, {{0, 0, -1}, {0.6, 0.8, 0}}, {{0.48, 0.6, 0.64}, {-0.8, 0.6, 0}}};
    std::vector<Vec3> points;
    for (const Vec2d p : polygon)
        points.push_back(
            Vec3((axes[plane][0] * p.x + axes[plane][1] * p.y + Vec3d(offset, -offset, 2 * offset)) * scale));
    return points;
}

/// Checks the triangle count, the indices, equal orientation and the sum of areas. Each inner edge must be shared by
/// two triangles in opposite directions.
void check_cover(const std::vector<Vec3>& polygon, const Triangles& triangles) {
    REQUIRE(triangles.size() == polygon.size() - 2);
    const Vec3d normal = newell_normal(polygon);
    double area = 0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : triangles) {
        const Vec3d a(polygon[t[0]]), n = cross(Vec3d(polygon[t[1]]) - a, Vec3d(polygon[t[2]]) - a);
        CHECK(dot(n, normal) >= -1e-6 * length_squared(normal));
        area += length(n);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = t[k], to = t[(k + 1) % 3];
            edges[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
        }
    }
    CHECK(area == doctest::Approx(length(normal)).epsilon(1e-4));
    const auto n = static_cast<std::uint32_t>(polygon.size());
    for (const auto& entry : edges) {
        const auto edge = entry.first;
        const int balance = entry.second;
        const int expected = edge.second == edge.first + 1 ? 1 : edge.first == 0 && edge.second == n - 1 ? -1 : 0;
        CHECK_MESSAGE(balance == expected, "edge " << edge.first << "-" << edge.second);
    }
}

void check_everywhere(const Polygon& polygon) {
    for (const double scale : {1e-6, 1.0, 1e6})
        for (const double offset : {0.0, 1000.0}) // in units of the polygon's size: float leaves 4 digits of its shape
            for (int plane = 0; plane < 3; ++plane)
                for (const bool reversed : {false, true}) {
                    CAPTURE(scale);
                    CAPTURE(offset);
                    CAPTURE(plane);
                    CAPTURE(reversed);
                    std::vector<Vec3> points = placed(polygon, scale, offset, plane);
                    if (reversed) std::reverse(points.begin(), points.end());
                    Triangles triangles;
                    REQUIRE(triangulate(points, triangles));
                    check_cover(points, triangles);
                }
}

Polygon star(int spikes, double inner) {
    Polygon p;
    for (int i = 0; i < 2 * spikes; ++i) {
        const double angle = kPiDouble * i / spikes, r = i % 2 ? inner : 1.0;
        p.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    return p;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("Convex polygons") {
        for (const int n : {3, 4, 5, 6, 17}) {
            Polygon p;
            for (int i = 0; i < n; ++i) p.push_back({std::cos(2 * kPiDouble * i / n), std::sin(2 * kPiDouble * i / n)});
            check_everywhere(p);
        }
    }

    TEST_CASE("A quad is split along its shorter diagonal, at equality along the first") {
        Triangles triangles;
        triangulate(placed({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1, 0, 0), triangles);
        CHECK(triangles == Triangles{{0, 1, 2}, {0, 2, 3}});
        triangles.clear();
        triangulate(placed({{-2, 0}, {0, -1}, {2, 0}, {0, 1}}, 1, 0, 0), triangles);
        CHECK(triangles == Triangles{{0, 1, 3}, {1, 2, 3}});
        triangles.clear();
        triangulate(placed({{0, -1}, {2, 0}, {0, 1}, {-2, 0}}, 1, 0, 0), triangles);
        CHECK(triangles == Triangles{{0, 1, 2}, {0, 2, 3}});
    }

    TEST_CASE("Concave quads, whichever corner is the inward one") {
        const Polygon dart{{0, 0}, {2, -1}, {0.5, 0}, {2, 1}};
        for (std::size_t turn = 0; turn < 4; ++turn) {
            Polygon p = dart;
            std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(turn), p.end());
            std::reverse(p.begin(), p.end());
            check_everywhere(p);
        }
    }

    TEST_CASE("Concave polygons: stars, combs, spirals") {
        check_everywhere(star(5, 0.3));
        check_everywhere(star(30, 0.2));
        Polygon comb{{0, 0}};
        for (int i = 0; i < 12; ++i) {
            comb.push_back({i + 0.1, 0});
            comb.push_back({i + 0.5, 5});
        }
        comb.push_back({12, 0});
        comb.push_back({12, -1});
        comb.push_back({0, -1});
        std::reverse(comb.begin(), comb.end());
        check_everywhere(comb);
        Polygon spiral;
        for (int i = 0; i < 60; ++i)
            spiral.push_back({(1 + 0.1 * i) * std::cos(0.2 * i), (1 + 0.1 * i) * std::sin(0.2 * i)});
        for (int i = 59; i >= 0; --i)
            spiral.push_back({(1.4 + 0.1 * i) * std::cos(0.2 * i), (1.4 + 0.1 * i) * std::sin(0.2 * i)});
        check_everywhere(spiral);
    }

    TEST_CASE("Corners on a straight side, and a hole joined by a bridge") {
        check_everywhere({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 3}, {2, 3}, {0, 3}});
        Triangles triangles;
        // The polygon runs along the outer square, over a bridge to the inner square in reverse order, and back.
        const std::vector<Vec3> ring =
            placed({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}, 1, 0, 1);
        REQUIRE(triangulate(ring, triangles));
        REQUIRE(triangles.size() == 8);
        double area = 0;
        for (const auto& t : triangles) {
            const Vec3d a(ring[t[0]]), n = cross(Vec3d(ring[t[1]]) - a, Vec3d(ring[t[2]]) - a);
            CHECK(dot(n, newell_normal(ring)) >= 0);
            area += 0.5 * length(n);
        }
        CHECK(area == doctest::Approx(12));
    }

    TEST_CASE("Random star-shaped polygons") {
        std::mt19937 random(7);
        std::uniform_real_distribution<double> radius(0.1, 1), count(5, 40);
        for (int trial = 0; trial < 100; ++trial) {
            const int n = static_cast<int>(count(random));
            Polygon p;
            for (int i = 0; i < n; ++i) {
                const double r = radius(random);
                p.push_back({r * std::cos(2 * kPiDouble * i / n), r * std::sin(2 * kPiDouble * i / n)});
            }
            const std::vector<Vec3> points = placed(p, 1, 0, trial % 3);
            Triangles triangles;
            REQUIRE(triangulate(points, triangles));
            check_cover(points, triangles);
        }
    }

    TEST_CASE("Polygons that cross themselves or have no area still give n - 2 triangles of their corners") {
        const std::vector<std::vector<Vec3>> polygons = {
            placed({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 1, 0, 0),                 // a bow tie
            placed({{0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}}, 1, 0, 0),         // a point
            placed({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}, 1, 0, 0), // a line
            placed({{1, 0}, {-0.8, 0.6}, {0.3, -0.95}, {0.3, 0.95}, {-0.8, -0.6}}, 1, 0,
                   0), // a pentagram: it winds twice and turns only left
            {Vec3(1e18f, 0, 0), Vec3(-1e18f, 0, 0), Vec3(0, 1e18f, 1), Vec3(0, 1e-18f, 1e18f), Vec3(1, 2, 3)},
        };
        for (const std::vector<Vec3>& polygon : polygons) {
            Triangles triangles;
            REQUIRE(triangulate(polygon, triangles));
            CHECK(triangles.size() == polygon.size() - 2);
            for (const auto& t : triangles)
                for (const std::uint32_t i : t) CHECK(i < polygon.size());
        }
    }

    TEST_CASE("A concave polygon of very many corners is declined; a convex one is not") {
        Triangles triangles;
        CHECK_FALSE(triangulate(placed(star(5001, 0.5), 1, 0, 0), triangles));
        CHECK(triangles.empty());
        CHECK(triangulate(placed(star(1000, 0.5), 1, 0, 0), triangles));
    }

} // TEST_SUITE
