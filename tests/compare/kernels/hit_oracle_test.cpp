#include "compare/kernels/hit_oracle.h"

#include "compare/kernels/kernel_scene.h"
#include "compare/kernels/ray_sets.h"
#include "compare/stress/accelerated_scene.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::compare;

namespace {

/// Returns two unit squares of two triangles each, at z = 0 (triangles 0, 1) and z = −1 (2, 3), and a duplicate (4)
/// of triangle 0.
Scene squares() {
    Mesh mesh;
    for (const float z : {0.0f, -1.0f})
        for (const Vec2 p : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)}) mesh.positions.emplace_back(p.x, p.y, z);
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}, {0, 1, 2}};
    return make_scene({mesh});
}

Ray down(float x, float y) { return {{x, y, 1}, {0, 0, -1}}; }
constexpr RayResult kMiss{};

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a right answer is right, another triangle at the same place a tie") {
        const Scene scene = squares();
        const HitOracle oracle(scene);
        CHECK(oracle.closest(down(0.7f, 0.3f), {1, 0}) == AnswerVerdict::kCorrect);
        CHECK(oracle.closest(down(0.7f, 0.3f), {1, 4}) == AnswerVerdict::kTie);
        CHECK(oracle.closest(down(0.5f, 0.5f), {1, 1}) == AnswerVerdict::kTie); // on the diagonal
        CHECK(oracle.closest(down(2, 2), kMiss) == AnswerVerdict::kCorrect);
        CHECK(oracle.occluded(down(0.7f, 0.3f), true) == AnswerVerdict::kCorrect);
        CHECK(oracle.occluded(down(2, 2), false) == AnswerVerdict::kCorrect);
    }

    TEST_CASE("at a silhouette hit and miss may both be found, and what lies behind") {
        const Scene scene = squares();
        const HitOracle oracle(scene);
        for (const float x : {0x1p-22f, -0x1p-22f}) {
            CHECK(oracle.closest(down(x, 0.5f), {2, 3}) != AnswerVerdict::kWrong);
            CHECK(oracle.closest(down(x, 0.5f), {1, 1}) != AnswerVerdict::kWrong);
            CHECK(oracle.closest(down(x, 0.5f), kMiss) != AnswerVerdict::kWrong);
            CHECK(oracle.occluded(down(x, 0.5f), true) != AnswerVerdict::kWrong);
            CHECK(oracle.occluded(down(x, 0.5f), false) != AnswerVerdict::kWrong);
        }
        CHECK(oracle.closest(down(-0x1p-22f, 0.5f), {1, 1}) == AnswerVerdict::kEdge);
        CHECK(oracle.closest(down(0x1p-22f, 0.5f), kMiss) == AnswerVerdict::kEdge);
        CHECK(oracle.occluded(down(0x1p-22f, 0.5f), false) == AnswerVerdict::kEdge);
        CHECK(oracle.occluded(down(-0x1p-22f, 0.5f), true) == AnswerVerdict::kEdge);
    }

    TEST_CASE("the surface that a ray starts from, and the end of a shadow ray, may be found or not") {
        const Scene scene = squares();
        const HitOracle oracle(scene);
        Ray from_surface = down(0.7f, 0.3f);
        from_surface.origin.z = -0x1p-24f;
        CHECK(oracle.closest(from_surface, {1, 2}) == AnswerVerdict::kCorrect);
        CHECK(oracle.closest(from_surface, {0, 0}) == AnswerVerdict::kEdge);
        Ray ends = down(0.7f, 0.3f);
        for (const float end : {1 - 0x1p-23f, 1 + 0x1p-22f}) {
            ends.t_max = end;
            CHECK(oracle.occluded(ends, true) != AnswerVerdict::kWrong);
            CHECK(oracle.occluded(ends, false) != AnswerVerdict::kWrong);
        }
    }

    TEST_CASE("planted faults are found wrong") {
        const Scene scene = squares();
        const HitOracle oracle(scene);
        const Ray ray = down(0.7f, 0.3f);
        CHECK(oracle.closest(ray, kMiss) == AnswerVerdict::kWrong);  // a missed hit
        CHECK(oracle.closest(ray, {2, 2}) == AnswerVerdict::kWrong); // a hit behind the nearest one
        CHECK(oracle.closest(ray, {1, 1}) == AnswerVerdict::kWrong); // the neighboring triangle, away from the edge
        CHECK(oracle.closest(ray, {1.001f, 0}) == AnswerVerdict::kWrong);   // at the wrong distance
        CHECK(oracle.closest(down(2, 2), {1, 0}) == AnswerVerdict::kWrong); // outside all triangles
        CHECK(oracle.closest(ray, {0.5f, 0}) == AnswerVerdict::kWrong);     // not on a surface
        CHECK(oracle.occluded(ray, false) == AnswerVerdict::kWrong);
        CHECK(oracle.occluded(down(2, 2), true) == AnswerVerdict::kWrong);
        Ray ends = ray;
        ends.t_max = 0.9f;
        CHECK(oracle.occluded(ends, true) == AnswerVerdict::kWrong);
        CHECK(oracle.occluded(ends, false) == AnswerVerdict::kCorrect);
    }

    TEST_CASE("comparing answers counts each difference once, and says whose fault it is") {
        const KernelScene scene =
            make_kernel_scene("lump", Arrangement::kRoom, enclosed(icosphere(3, 0.2f), Vec3(), 3), [] {
                Camera camera;
                camera.eye = {1, 1.5, 2.5};
                return camera;
            }());
        const raytrace::Accelerator accelerator(*scene.scene, 1);
        const HitOracle oracle(*scene.scene);
        const auto rays = camera_rays(scene.camera, 64, 64, PixelOrder::kRows, 1);
        const std::vector<RayResult> right = trace_all(duet_closest(accelerator, rays), rays.size(), 1);
        const RayQueries ray_queries{rays, {}};
        const auto compared = [&](const std::vector<RayResult>& ours, const std::vector<RayResult>& theirs) {
            return compare_results(oracle, ray_queries, ours, theirs, 2);
        };
        CHECK(compared(right, right).differ() == 0);
        CHECK(compared(right, right).rays == 64 * 64);

        std::vector<RayResult> faulty = right;
        faulty[7] = kMiss;
        faulty[1000].t *= 1.01f;
        faulty[2000].triangle = (faulty[2000].triangle + 40) % 1000;
        Mismatches found = compared(faulty, right);
        CHECK(found.unexplained == 3);
        CHECK(found.differ() == 3);
        CHECK(found.ours.wrong == 3);
        CHECK(found.peer.wrong == 0);
        found = compared(right, faulty);
        CHECK(found.ours.wrong == 0);
        CHECK(found.peer.wrong == 3);

        CHECK(check_answers(oracle, ray_queries, faulty, 1, 2).wrong == 3);
        CHECK(check_answers(oracle, ray_queries, faulty, 10, 1).wrong == 2);
        CHECK(check_answers(oracle, ray_queries, faulty, 10, 1).rays == 410);

        // The double-precision oracle must accept all of our hits.
        for (std::size_t i = 0; i < rays.size(); ++i)
            REQUIRE(oracle.closest(rays[i], right[i]) != AnswerVerdict::kWrong);
        const ShadowRays shadow = shadow_rays(scene, accelerator, rays, 0, 1);
        const RayQueries in_the_way{shadow.rays, shadow.ends};
        const auto blocked = trace_all(duet_occluded(accelerator, shadow.rays, shadow.ends), shadow.rays.size(), 1);
        const KernelErrors ours = check_answers(oracle, in_the_way, blocked, 1, 2);
        CHECK(ours.rays == std::ssize(shadow.rays));
        CHECK_FALSE(ours.any());
        std::vector<RayResult> flipped = blocked;
        flipped[5].triangle = blocked[5].hit() ? RayResult::kNone : 0;
        const Mismatches one = compare_results(oracle, in_the_way, blocked, flipped, 1);
        CHECK(one.unexplained == 1);
        CHECK(one.peer.wrong == 1);
    }

    TEST_CASE("between two triangles of one surface nothing gets through; past an outline it may") {
        const Scene scene = squares(); // their diagonal, (0, 0) to (1, 1), is an interior edge
        const HitOracle oracle(scene);
        for (const float off : {-0x1p-21f, 0.0f, 0x1p-21f}) {
            const Ray inside = down(0.5f + off, 0.5f);
            CHECK(oracle.closest(inside, kMiss) == AnswerVerdict::kEdgeLeak);
            CHECK(oracle.closest(inside, {2, 2}) == AnswerVerdict::kEdgeLeak);
            CHECK(oracle.closest(inside, {2, 3}) == AnswerVerdict::kEdgeLeak);
            CHECK(oracle.occluded(inside, false) == AnswerVerdict::kEdgeLeak);
            CHECK(oracle.closest(inside, {1, 1}) != AnswerVerdict::kEdgeLeak);
            const Ray outline = down(off, 0.5f);
            CHECK(oracle.closest(outline, kMiss) != AnswerVerdict::kEdgeLeak);
            CHECK(oracle.closest(outline, {2, 3}) != AnswerVerdict::kEdgeLeak);
            CHECK(oracle.occluded(outline, false) != AnswerVerdict::kEdgeLeak);
            const Ray corner = down(1 + off, 1);
            CHECK(oracle.closest(corner, kMiss) != AnswerVerdict::kEdgeLeak);
        }
        KernelErrors faults;
        for (const AnswerVerdict finding : {AnswerVerdict::kCorrect, AnswerVerdict::kEdgeLeak, AnswerVerdict::kWrong,
                                            AnswerVerdict::kEdgeLeak, AnswerVerdict::kEdge})
            faults.count(finding);
        CHECK(faults.rays == 5);
        CHECK(faults.edge == 2);
        CHECK(faults.wrong == 1);
    }

    TEST_CASE("the triangle that a shadow ray ends on does not block it; what lies before it does") {
        const Scene scene = squares();
        const HitOracle oracle(scene);
        const Ray ray = down(0.7f, 0.3f);
        const Hit area_light{0, 2, 0, 0, 2};                                      // on the lower square
        CHECK(oracle.occluded(ray, area_light, true) == AnswerVerdict::kCorrect); // occluded by the upper square
        CHECK(oracle.occluded(ray, area_light, false) == AnswerVerdict::kWrong);
        Ray below = ray;
        below.origin.z = -0.5f;
        CHECK(oracle.occluded(below, Hit{0, 2, 0, 0, 0.5f}, false) == AnswerVerdict::kCorrect);
        // The shadow ray ends at another triangle, which is farther away.
        CHECK(oracle.occluded(below, Hit{0, 3, 0, 0, 0.6f}, false) == AnswerVerdict::kWrong);
    }

    TEST_CASE("instances are judged where they stand") {
        const Scene scene = make_scene(
            icosphere(2), {translation(Vec3(-2, 0, 0)), translation(Vec3(2, 0, 0)) * scaling(Vec3(2, 2, 2))});
        const HitOracle oracle(scene);
        const raytrace::Accelerator accelerator(scene, 1);
        std::vector<Ray> rays;
        for (const float x : {-2.1f, 2.1f}) rays.push_back({{x, 0.1f, 5}, {0, 0, -1}});
        std::vector<RayResult> ray_results = trace_all(duet_closest(accelerator, rays), rays.size(), 1);
        CHECK(ray_results[0].object == 0);
        CHECK(ray_results[1].object == 1);
        const RayQueries ray_queries{rays, {}};
        CHECK_FALSE(check_answers(oracle, ray_queries, ray_results, 1, 1).any());
        std::swap(ray_results[0].object, ray_results[1].object);
        CHECK(check_answers(oracle, ray_queries, ray_results, 1, 1).wrong == 2);
    }
}
