// These tests check the simplified meshes that irradiance probes see.
#include "tests/raster/path_traced.h"
#include "tests/raster/varied_scene.h"

#include "raster/geometry/simplify_mesh.h"
#include "raster/probes/irradiance_probes.h"
#include "raster/probes/simplified_scene.h"

#include <doctest/doctest.h>

#include <map>
#include <tuple>

using namespace duet;
using namespace duet::test;
using raster::simplified;

namespace {

/// Returns the distance of a point from the surface of torus().
double from_torus(Vec3d p) { return std::abs(std::hypot(std::hypot(p.x, p.z) - 1, p.y) - 0.4); }

double volume(const Mesh& mesh) {
    double six_times = 0;
    for (const auto& t : mesh.triangles)
        six_times += dot(Vec3d(mesh.positions[t[0]]), cross(Vec3d(mesh.positions[t[1]]), Vec3d(mesh.positions[t[2]])));
    return six_times / 6;
}

/// Returns whether each edge, by the positions of its ends, is traversed as often in one direction as in the other.
bool edges_cancel(const Mesh& mesh) {
    const auto key = [&](std::uint32_t i) {
        return std::tuple(mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z);
    };
    std::map<std::pair<std::tuple<float, float, float>, std::tuple<float, float, float>>, int> count;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = key(t[k]), b = key(t[(k + 1) % 3]);
            if (a < b)
                ++count[{a, b}];
            else
                --count[{b, a}];
        }
    return std::ranges::all_of(count, [](const auto& edge) { return edge.second == 0; });
}

/// Returns a square of n × n quads in the plane z = 0, from 0 to 1, with uv = (x, y), whose right half has slot 1.
Mesh square(std::uint32_t n) {
    Mesh mesh;
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) {
            const Vec2 uv(static_cast<float>(x) / static_cast<float>(n), static_cast<float>(y) / static_cast<float>(n));
            mesh.positions.emplace_back(uv.x, uv.y, 0.0f), mesh.uvs.push_back(uv);
        }
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t a = y * (n + 1) + x, d = a + n + 1;
            mesh.triangles.push_back({a, a + 1, d + 1}), mesh.triangles.push_back({a, d + 1, d});
            for (int k = 0; k < 2; ++k) mesh.material_slots.push_back(x < n / 2 ? 0 : 1);
        }
    return mesh;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a simplified mesh lies near the mesh, closed and with its normals") {
        const Mesh mesh = smooth_torus(400, 160);
        for (const double cell : {0.02, 0.05, 0.1}) {
            CAPTURE(cell);
            const Mesh simple = simplified(mesh, cell);
            // A torus has 4π²·0.4 square meters, with about one vertex per cell² and two triangles per vertex, and up
            // to twice as many where it is slanted in the grid.
            CHECK(static_cast<double>(simple.triangles.size()) < 4 * 4 * sqr(kPiDouble) * 0.4 / sqr(cell));
            CHECK(edges_cancel(simple));
            CHECK(volume(simple) == doctest::Approx(volume(mesh)).epsilon(cell).scale(0));
            for (std::size_t i = 0; i < simple.positions.size(); ++i) {
                const Vec3d p(simple.positions[i]);
                CHECK(from_torus(p) < cell / 2);
                const Vec3d ring = normalize(Vec3d(p.x, 0, p.z)), outward = normalize(p - ring);
                CHECK(dot(outward, Vec3d(simple.normals[i])) > 0.8); // up to half the width of a face of a cube
            }
        }
    }

    TEST_CASE("a simplified mesh keeps material slots and texture coordinates") {
        const Mesh simple = simplified(square(200), 0.05);
        CHECK(simple.triangles.size() < 2000);
        REQUIRE(simple.material_slots.size() == simple.triangles.size());
        std::array<double, 2> area{};
        for (std::size_t i = 0; i < simple.triangles.size(); ++i) {
            const auto [a, b, c] = simple.triangles[i];
            area[simple.material_slots[i]] +=
                static_cast<double>(length(cross(simple.positions[b] - simple.positions[a],
                                                 simple.positions[c] - simple.positions[a]))) / 2;
        }
        CHECK(area[0] == doctest::Approx(0.5).epsilon(0.12).scale(0)); // the outermost half cells are lost
        CHECK(area[1] == doctest::Approx(0.5).epsilon(0.12).scale(0));
        for (std::size_t i = 0; i < simple.positions.size(); ++i) {
            CHECK(std::abs(simple.uvs[i].x - simple.positions[i].x) < 0.05f);
            CHECK(std::abs(simple.uvs[i].y - simple.positions[i].y) < 0.05f);
        }
    }

    TEST_CASE("normals of length zero and opposite normals of a thin sheet stay finite") {
        Mesh mesh = smooth_torus(100, 50);
        for (std::size_t i = 0; i < mesh.normals.size(); i += 2) mesh.normals[i] = mesh.normals[i] * -1.0f;
        std::fill_n(mesh.normals.begin(), 2000, Vec3());
        for (const Vec3 n : simplified(mesh, 0.2).normals) CHECK((length(n) == 0 || std::abs(length(n) - 1) < 1e-5f));
    }

    TEST_CASE("a mesh within one cell vanishes, and one with coarser triangles stays") {
        const Mesh mesh = torus(20, 10);
        CHECK(simplified(mesh, 100).triangles.empty());
        const Mesh same = simplified(mesh, 1e-3);
        CHECK(same.triangles == mesh.triangles);
        CHECK(same.positions == mesh.positions);
        CHECK(simplified(mesh, 1e-300).triangles == mesh.triangles);
        CHECK(simplified(mesh, 0).triangles == mesh.triangles);
        CHECK(simplified(Mesh(), 1).triangles.empty());
    }

    TEST_CASE("a scene is simplified where it has many small triangles") {
        const auto triangles = [](const Scene& scene, double cell) {
            const raster::RasterScene prepared = raster::prepare(scene, plain());
            const std::optional<Scene> simple = simplified_scene(prepared.data(), cell);
            return simple ? std::optional(primitive_count(simple->shapes[0])) : std::nullopt;
        };
        const auto scene_of = [](Mesh mesh, float scale, Material material) {
            Scene scene;
            add(scene, std::move(mesh), Mat4(scaling(Vec3(1, 1, 1) * scale)), std::move(material));
            add_instance(scene, 0, Mat4(scaling(Vec3(0.1f, 0.1f, 0.1f) * scale))); // keeps the mesh from being baked
            scene.lights = {SunLight{{0, -1, 0}, Rgb(1)}};
            finish_scene(scene);
            return scene;
        };
        const std::optional<std::uint32_t> count = triangles(scene_of(torus(200, 100), 1, Diffuse{}), 0.1);
        REQUIRE(count);
        CHECK(*count > 1000);
        CHECK(*count < 20'000);
        CHECK(triangles(scene_of(torus(200, 100), 1000, Diffuse{}), 100) == count);
        CHECK_FALSE(triangles(scene_of(torus(200, 100), 1, Diffuse{}), 0));
        CHECK_FALSE(triangles(scene_of(torus(200, 100), 1, Diffuse{}), 0.001)); // finer than the mesh
        CHECK_FALSE(triangles(scene_of(torus(200, 100), 1, Diffuse{}), 3));     // the mesh would vanish
        CHECK_FALSE(triangles(scene_of(torus(20, 10), 1, Diffuse{}), 0.5));     // few triangles
        CHECK_FALSE(triangles(scene_of(torus(200, 100), 1, Emissive{Rgb(1)}), 0.1));
        Scene masked = scene_of(torus(200, 100), 1, Diffuse{});
        masked.maps.resize(masked.materials.size());
        for (SurfaceMaps& maps : masked.maps) maps.opacity = {0.5f};
        finish_scene(masked);
        CHECK_FALSE(triangles(masked, 0.1));
        Scene moving = scene_of(torus(200, 100), 1, Diffuse{});
        moving.objects[0].place(moving.objects[0].to_world, Mat4(scaling(Vec3(4, 4, 4)))); // it grows
        finish_scene(moving);
        CHECK(triangles(moving, 0.4) == count);
    }
}

TEST_SUITE("image") {

    TEST_CASE("the light below a dense mesh is that below a coarse one") {
        ImageRgb images[2];
        float spacing[2];
        for (const bool dense : {false, true}) {
            CAPTURE(dense);
            Scene scene;
            add(scene, dense ? torus(1000, 500) : torus(40, 20), Mat4(translation(Vec3(0, 0.8f, 0))),
                Diffuse{{Rgb(0.8f, 0.3f, 0.3f)}});
            add(scene, QuadList{{Quad{Vec3(-9, 0, 9), Vec3(18, 0, 0), Vec3(0, 0, -18)}}}, Mat4(), Diffuse{{Rgb(0.7f)}});
            scene.environment = ConstantEnvironment{Rgb(1)};
            finish_scene(scene);
            const View view{look({1, 0.7, 4}, {0, 0.3, 0}), 96, 72};
            const raster::RasterScene prepared = raster::prepare(scene, {});
            spacing[dense] = prepared.data().irradiance_probes->spacing();
            Control control;
            images[dense] = raster::render(prepared, view, {}, control).radiance;
            CHECK(relmse(images[dense], path_traced(scene, view, 64)) < 0.01); // measured: 0.0074 and 0.0067
        }
        CHECK(spacing[0] == doctest::Approx(spacing[1]).epsilon(0.01).scale(0));
        CHECK(relmse(images[0], images[1]) < 0.015); // measured: 0.010, and 0.023 if probes see the dense mesh itself
    }
}
