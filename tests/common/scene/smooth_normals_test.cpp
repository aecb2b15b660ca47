#include "common/scene/obj/smooth_normals.h"

#include <doctest/doctest.h>

using namespace duet;

namespace {

/// Returns two unit squares that share an edge on the y axis and meet at an angle. The vertices on that edge are
/// shared, or duplicated as at a seam.
Mesh bent_strip(double degrees, bool seam) {
    const float c = static_cast<float>(std::cos(radians(degrees))), s = static_cast<float>(std::sin(radians(degrees)));
    Mesh mesh;
    mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {c, 0, -s}, {c, 1, -s}};
    const std::uint32_t a = seam ? 6 : 1, b = seam ? 7 : 2;
    if (seam) {
        mesh.positions.push_back({0, 0, 0});
        mesh.positions.push_back({0, 1, 0});
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {a, 4, 5}, {a, 5, b}};
    return mesh;
}

Vec3 normal_at(const Mesh& mesh, std::size_t triangle, std::size_t corner) {
    return mesh.normals[mesh.triangles[triangle][corner]];
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("A gentle bend is smoothed, a sharp one is kept, seam or no seam") {
        for (const bool seam : {false, true}) {
            CAPTURE(seam);
            Mesh gentle = bent_strip(50, seam);
            add_smooth_normals(gentle);
            REQUIRE(gentle.normals.size() == gentle.positions.size());
            CHECK(gentle.positions.size() == (seam ? 8 : 6));
            const Vec3 left = normal_at(gentle, 0, 1), right = normal_at(gentle, 2, 0);
            CHECK(length(left - right) < 1e-6f);
            CHECK(left.x == doctest::Approx(std::sin(radians(25))));
            CHECK(left.z == doctest::Approx(std::cos(radians(25))));
            CHECK(normal_at(gentle, 0, 0) == Vec3(0, 0, 1));

            Mesh sharp = bent_strip(70, seam);
            add_smooth_normals(sharp);
            CHECK(sharp.positions.size() == 8);
            CHECK(normal_at(sharp, 0, 1) == Vec3(0, 0, 1));
            CHECK(normal_at(sharp, 2, 0).x == doctest::Approx(std::sin(radians(70))));
            for (const auto& t : sharp.triangles)
                for (const std::uint32_t i : t) CHECK(i < sharp.normals.size());
        }
    }

    TEST_CASE("Weights are angles: a side cut in two does not pull the normal of a pyramid's tip") {
        // A cube's corner flattened to 54.7 degrees between its faces is above the crease angle, so this test takes a
        // low pyramid.
        Mesh mesh;
        mesh.positions = {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 0, 0.3f}};
        mesh.triangles = {{4, 0, 1}, {4, 1, 2}, {4, 2, 3}, {4, 3, 0}};
        mesh.positions.push_back({0, 1, 0}); // one side is split in two
        mesh.triangles[0] = {4, 5, 1};
        mesh.triangles.push_back({4, 0, 5});
        add_smooth_normals(mesh);
        const Vec3 top = normal_at(mesh, 0, 0);
        CHECK(std::abs(top.x) < 1e-6f);
        CHECK(std::abs(top.y) < 1e-6f);
        CHECK(top.z == doctest::Approx(1));
    }

    TEST_CASE("A fine sphere gets its own normals") {
        Mesh mesh;
        constexpr int kRings = 32, kSegments = 64;
        for (int i = 0; i <= kRings; ++i)
            for (int j = 0; j < kSegments; ++j) {
                const double theta = kPiDouble * i / kRings, phi = 2 * kPiDouble * j / kSegments;
                mesh.positions.push_back(
                    Vec3(Vec3d(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi))));
            }
        for (int i = 0; i < kRings; ++i)
            for (int j = 0; j < kSegments; ++j) {
                const auto at = [&](int ring, int segment) {
                    return static_cast<std::uint32_t>(ring * kSegments + segment % kSegments);
                };
                mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
            }
        add_smooth_normals(mesh);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto& [a, b, c] = mesh.triangles[t];
            const Vec3 p = mesh.positions[a];
            const bool degenerate =
                p == mesh.positions[b] || mesh.positions[b] == mesh.positions[c] || p == mesh.positions[c];
            if (!degenerate && std::abs(p.y) < 0.99f) CHECK(dot(normal_at(mesh, t, 0), p) > 0.999f);
            CHECK(length(normal_at(mesh, t, 0)) == doctest::Approx(1));
        }
    }

    TEST_CASE("Edges of three triangles and triangles turned over are not smoothed across") {
        Mesh mesh = bent_strip(30, false);
        mesh.triangles[2] = {1, 5, 4}; // reversed winding
        mesh.triangles[3] = {1, 2, 5};
        add_smooth_normals(mesh);
        CHECK(normal_at(mesh, 0, 1) == Vec3(0, 0, 1));
        CHECK(normal_at(mesh, 2, 0).z < 0);
    }

    TEST_CASE("Triangles without area do no harm") {
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 0}};
        mesh.triangles = {{0, 1, 2}, {0, 3, 0}};
        add_smooth_normals(mesh);
        for (const Vec3 n : mesh.normals) CHECK(length(n) == 1);
    }

} // TEST_SUITE
