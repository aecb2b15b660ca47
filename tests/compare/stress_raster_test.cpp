// These tests check the oracles of the stress suite's raster tests. The oracles must be right in known cases and must
// detect errors.
#include "compare/stress/coverage_meshes.h"
#include "compare/stress/projection_scenes.h"
#include "compare/stress/random_scene.h"
#include "compare/stress/textbook_rasterizer.h"
#include "compare/stress/textbook_tracer.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace duet;
using namespace duet::compare;

namespace {

/// Returns the sum of the windings of the triangles that cover a grid point.
int turns(const std::vector<GridTriangle>& mesh, std::int64_t x, std::int64_t y) {
    int sum = 0;
    for (const GridTriangle& triangle : mesh) sum += covers(triangle, x, y) ? winding(triangle) : 0;
    return sum;
}

const View kView{{.eye = {0, 0, 0}, .look_at = {0, 0, -1}, .fov_degrees = 90, .near = 0.5}, 100, 100};

Vec3 seen_at(double x, double y, double depth) { return point_at(CameraModel(kView).pinhole(), {x, y}, depth); }

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("exact coverage: left and top edges are in, right and bottom ones out, in either winding") {
        const GridTriangle upper{{{0, 0}, {10, 0}, {0, 10}}}, lower{{{10, 0}, {10, 10}, {0, 10}}};
        for (const GridTriangle& t : {upper, GridTriangle{upper[0], upper[2], upper[1]}}) {
            CHECK(covers(t, 0, 0));
            CHECK(covers(t, 5, 0));
            CHECK(covers(t, 0, 9));
            CHECK_FALSE(covers(t, 5, 5)); // on the shared edge, which is the lower triangle's left edge
            CHECK_FALSE(covers(t, 10, 0));
            CHECK_FALSE(covers(t, 0, 10));
            CHECK_FALSE(covers(t, -1, 0));
        }
        CHECK(covers(lower, 5, 5));
        CHECK_FALSE(covers(lower, 10, 5));
        CHECK_FALSE(covers(lower, 9, 10));
        CHECK_FALSE(covers({{{0, 0}, {5, 5}, {10, 10}}}, 5, 5)); // no area
        CHECK(winding(upper) == 1);
        CHECK(winding({upper[0], upper[2], upper[1]}) == -1);
    }

    TEST_CASE("exact coverage needs more than 64 bits, and has them") {
        constexpr std::int32_t kFar = 2'000'000'000; // products of differences reach 2^64
        const GridTriangle huge{{{-kFar, -kFar}, {kFar, -kFar}, {0, kFar}}};
        CHECK(covers(huge, 0, 0));
        CHECK(covers(huge, 0, kFar - 1));
        CHECK_FALSE(covers(huge, kFar - 1, kFar - 1));
    }

    TEST_CASE("fans, strips and grids go once around every sample; a triangle removed, turned or moved shows") {
        TrialRandom random(5);
        int moved_seen = 0;
        for (int i = 0; i < 300; ++i) {
            const Window window = random_window(random, 6);
            std::vector<GridTriangle> mesh = i % 3 == 0   ? random_fan(random, window)
                                             : i % 3 == 1 ? random_strip(random, window)
                                                          : random_grid(random, window);
            const auto all_once = [&] {
                bool once = true;
                window.for_each(
                    [&](int x, int y) { once = once && turns(mesh, window.grid_x(x), window.grid_y(y)) == 1; });
                return once;
            };
            REQUIRE(all_once());
            // Find a triangle that covers some sample of the window.
            const std::int64_t x = window.grid_x(window.rect.x0), y = window.grid_y(window.rect.y0);
            const auto hit = std::find_if(mesh.begin(), mesh.end(), [&](const auto& t) { return covers(t, x, y); });
            REQUIRE(hit != mesh.end());
            GridTriangle& one = *hit;
            const GridTriangle taken = one;
            one = {taken[0], taken[2], taken[1]}; // reversed winding
            REQUIRE_FALSE(all_once());
            one = {taken[0], taken[0], taken[0]}; // removed
            REQUIRE_FALSE(all_once());
            one = {{{taken[0].x + 300, taken[0].y}, taken[1], taken[2]}}; // its neighbors keep the old vertex
            moved_seen += !all_once();
        }
        CHECK(moved_seen > 30); // visible if a sample is in between
    }

    TEST_CASE("the probe tells the triangle drawn last, and what it does not cover") {
        const Window window{{4, 4, 8, 8}, {128, 128}};
        CoverageProbe probe(window);
        probe.draw({{{0, 0}, {4096, 0}, {0, 4096}}});
        CHECK(probe.covers(4, 4));
        probe.draw({{{6 * 256, 0}, {6 * 256, 4096}, {4096, 0}}}); // counterclockwise
        CHECK_FALSE(probe.covers(4, 4));
        CHECK(probe.covers(6, 4));
        probe.draw({{{0, 0}, {0, 0}, {9, 9}}});
        CHECK_FALSE(probe.covers(6, 4));
    }

    TEST_CASE("a projected triangle knows its outline in pixels, and what is where in it") {
        const ProjectedTriangle t(CameraModel(kView).pinhole(),
                                  {seen_at(20, 20, 2), seen_at(60, 20, 2), seen_at(20, 60, 4)});
        CHECK(t.inside({30, 30}) == doctest::Approx(10).epsilon(1e-5));
        CHECK(t.inside({15, 30}) == doctest::Approx(-5).epsilon(1e-5));
        CHECK(t.inside({30, 17}) == doctest::Approx(-3).epsilon(1e-5));
        CHECK(t.at({60, 20}).u == doctest::Approx(1).epsilon(1e-5));
        CHECK(t.at({20, 60}).v == doctest::Approx(1).epsilon(1e-5));
        CHECK(t.at({20, 60}).depth == doctest::Approx(4).epsilon(1e-5));
        // In the middle of the image between depths 2 and 4 the depth is 8/3, and two thirds of the distance remain.
        CHECK(t.at({20, 40}).depth == doctest::Approx(8.0 / 3).epsilon(1e-5));
        CHECK(t.at({20, 40}).v == doctest::Approx(1.0 / 3).epsilon(1e-5));
        CHECK(displacement(t, {30, 30}, true) == 0);
        CHECK(displacement(t, {30, 30}, false) == doctest::Approx(10).epsilon(1e-5));
        CHECK(displacement(t, {15, 30}, true) == doctest::Approx(5).epsilon(1e-5));
        CHECK(displacement(t, {15, 30}, false) == 0);
    }

    TEST_CASE("a projected triangle ends at the near plane, and is right with corners behind the eye or on its plane") {
        const Pinhole pinhole = CameraModel(kView).pinhole();
        // The floor is half a meter below the eye, from z = 5 (behind) to −5. Beyond the near plane it is visible
        // below y = 50.
        const ProjectedTriangle floor(pinhole, {Vec3(-100, -0.5f, 5), Vec3(100, -0.5f, 5), Vec3(0, -0.5f, -5)});
        CHECK(floor.inside({50, 40}) < 0); // above the horizon
        CHECK(floor.inside({50, 80}) > 0);
        // The lower edge is 45 degrees down, and y = 75 is half of that.
        CHECK(floor.at({50, 75}).depth == doctest::Approx(1));
        CHECK(floor.inside({50, 99}) == doctest::Approx(1)); // the near plane's line is y = 100
        CHECK(floor.inside({50, 101}) == doctest::Approx(-1));
        const ProjectedTriangle on_eye_plane(pinhole, {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, -1, -10)});
        CHECK(on_eye_plane.inside({50, 90}) > 0);
        CHECK(on_eye_plane.at({50, 100}).depth == doctest::Approx(1));
        CHECK(ProjectedTriangle(pinhole, {Vec3(1, 0, -1), Vec3(2, 0, -2), Vec3(0, 0, -3)}).edge_on());
        const ProjectedTriangle behind(pinhole, {Vec3(-1, -1, 1), Vec3(1, -1, 1), Vec3(0, 1, 1)});
        for (const Vec2d p : {Vec2d(50, 50), Vec2d(10, 90), Vec2d(70, 20)}) CHECK(behind.inside(p) < 0);
    }

    TEST_CASE("a displaced coverage and a wrong depth are seen: the books' rasterizer fails by known amounts") {
        const Pinhole pinhole = CameraModel(kView).pinhole();
        const Mat4 matrix(pinhole.world_to_pixel);
        const std::array<Vec3, 3> corners{seen_at(20, 20, 1), seen_at(60, 20, 1), seen_at(20, 60, 100)};
        const TextbookTriangle textbook{textbook_project(matrix, corners[0]), textbook_project(matrix, corners[1]),
                                        textbook_project(matrix, corners[2])};
        CHECK(textbook_covers(textbook, {30, 30}));
        CHECK_FALSE(textbook_covers(textbook, {15, 30}));
        CHECK(textbook_covers(textbook, {20, 30})); // on an edge: covered by both triangles that share it
        // The interpolation is affine: it gives half of v where perspective gives 1/101.
        CHECK(textbook_barycentrics(textbook, {20, 40}).z == doctest::Approx(0.5f).epsilon(1e-4));
        CHECK(ProjectedTriangle(pinhole, corners).at({20, 40}).v == doctest::Approx(1.0 / 101).epsilon(1e-4));
        CHECK(textbook_z(0.1f, 0.1f, 1e5f) == doctest::Approx(-1.0f));
        CHECK(textbook_z(1e5f, 0.1f, 1e5f) == doctest::Approx(1.0f));
        CHECK(textbook_z(9e4f, 0.1f, 1e5f) == textbook_z(9.01e4f, 0.1f, 1e5f)); // 100 meters apart, but equal depths
    }

    TEST_CASE("random scenes are the same for the same numbers, and seen from both outside and within") {
        const SceneContents all{.soup = true, .meshes = true, .spheres = true, .quads = true, .instances = true};
        TrialRandom first(3), second(3);
        const TrialScene a = random_scene(first, all, {}, 32, 24), b = random_scene(second, all, {}, 32, 24);
        REQUIRE(a.scene.objects.size() == b.scene.objects.size());
        CHECK(a.scene.objects.size() == 20);
        CHECK(a.view.camera.eye == b.view.camera.eye);
        CHECK(std::get<Mesh>(a.scene.shapes[0]).positions == std::get<Mesh>(b.scene.shapes[0]).positions);
        CHECK(std::get<Mesh>(a.scene.shapes[1]).closed.value());
        int within = 0;
        for (int i = 0; i < 100; ++i) {
            const TrialScene c = random_scene(first, all, {.offset = {1e5f, 0, 0}, .scale = 1}, 32, 24);
            within += c.scene.bounds.contains(Vec3(c.view.camera.eye));
            CHECK(c.scene.bounds.contains(Vec3(c.view.camera.look_at)));
            CHECK(c.scene.bounds.low.x > 9e4f);
        }
        CHECK(within > 20);
        CHECK(within < 95);
    }

    TEST_CASE("the books' tracer hits what is there at the scale of the books, and nothing below a millimetre") {
        TrialRandom random(4);
        const TrialScene scene = random_scene(random, {.quads = true}, {}, 32, 24);
        const TextbookTracer tracer(scene.scene);
        const PrimitiveVertices wall = primitive_vertices(scene.scene.shapes[0], 2);
        const Vec3d middle = (Vec3d(wall.p[0]) + Vec3d(wall.p[2])) * 0.5;
        const Vec3d n = normalize(cross(Vec3d(wall.p[1] - wall.p[0]), Vec3d(wall.p[3] - wall.p[0])));
        Ray ray;
        ray.origin = Vec3(middle + n * 0.002);
        ray.direction = Vec3(-n);
        const Hit hit = tracer.nearest(ray);
        CHECK(hit.object == 0);
        CHECK(hit.primitive == 2);
        CHECK(hit.t == doctest::Approx(0.002f).epsilon(1e-3));
        ray.origin = Vec3(middle + n * 0.0005);
        const Hit none = tracer.nearest(ray);
        CHECK_FALSE((none.valid() && none.object == 0 && none.primitive == 2));
    }
}
