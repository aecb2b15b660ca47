#include "compare/kernels/judge.h"

#include "compare/kernels/kernel_scene.h"
#include "compare/kernels/ray_sets.h"
#include "compare/stress/stage.h"

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
constexpr Answer kMiss{};

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a right answer is right, another triangle at the same place a tie") {
        const Scene scene = squares();
        const Judge judge(scene);
        CHECK(judge.closest(down(0.7f, 0.3f), {1, 0}) == Finding::kRight);
        CHECK(judge.closest(down(0.7f, 0.3f), {1, 4}) == Finding::kTie);
        CHECK(judge.closest(down(0.5f, 0.5f), {1, 1}) == Finding::kTie); // on the diagonal
        CHECK(judge.closest(down(2, 2), kMiss) == Finding::kRight);
        CHECK(judge.occluded(down(0.7f, 0.3f), true) == Finding::kRight);
        CHECK(judge.occluded(down(2, 2), false) == Finding::kRight);
    }

    TEST_CASE("at a silhouette hit and miss may both be found, and what lies behind") {
        const Scene scene = squares();
        const Judge judge(scene);
        for (const float x : {0x1p-22f, -0x1p-22f}) {
            CHECK(judge.closest(down(x, 0.5f), {2, 3}) != Finding::kWrong);
            CHECK(judge.closest(down(x, 0.5f), {1, 1}) != Finding::kWrong);
            CHECK(judge.closest(down(x, 0.5f), kMiss) != Finding::kWrong);
            CHECK(judge.occluded(down(x, 0.5f), true) != Finding::kWrong);
            CHECK(judge.occluded(down(x, 0.5f), false) != Finding::kWrong);
        }
        CHECK(judge.closest(down(-0x1p-22f, 0.5f), {1, 1}) == Finding::kEdge);
        CHECK(judge.closest(down(0x1p-22f, 0.5f), kMiss) == Finding::kEdge);
        CHECK(judge.occluded(down(0x1p-22f, 0.5f), false) == Finding::kEdge);
        CHECK(judge.occluded(down(-0x1p-22f, 0.5f), true) == Finding::kEdge);
    }

    TEST_CASE("the surface that a ray starts from, and the end of a shadow ray, may be found or not") {
        const Scene scene = squares();
        const Judge judge(scene);
        Ray from_surface = down(0.7f, 0.3f);
        from_surface.origin.z = -0x1p-24f;
        CHECK(judge.closest(from_surface, {1, 2}) == Finding::kRight);
        CHECK(judge.closest(from_surface, {0, 0}) == Finding::kEdge);
        Ray ends = down(0.7f, 0.3f);
        for (const float end : {1 - 0x1p-23f, 1 + 0x1p-22f}) {
            ends.t_max = end;
            CHECK(judge.occluded(ends, true) != Finding::kWrong);
            CHECK(judge.occluded(ends, false) != Finding::kWrong);
        }
    }

    TEST_CASE("planted faults are found wrong") {
        const Scene scene = squares();
        const Judge judge(scene);
        const Ray ray = down(0.7f, 0.3f);
        CHECK(judge.closest(ray, kMiss) == Finding::kWrong);         // a missed hit
        CHECK(judge.closest(ray, {2, 2}) == Finding::kWrong);        // a hit behind the nearest one
        CHECK(judge.closest(ray, {1, 1}) == Finding::kWrong);        // the neighboring triangle, away from the edge
        CHECK(judge.closest(ray, {1.001f, 0}) == Finding::kWrong);   // at the wrong distance
        CHECK(judge.closest(down(2, 2), {1, 0}) == Finding::kWrong); // outside all triangles
        CHECK(judge.closest(ray, {0.5f, 0}) == Finding::kWrong);     // not on a surface
        CHECK(judge.occluded(ray, false) == Finding::kWrong);
        CHECK(judge.occluded(down(2, 2), true) == Finding::kWrong);
        Ray ends = ray;
        ends.t_max = 0.9f;
        CHECK(judge.occluded(ends, true) == Finding::kWrong);
        CHECK(judge.occluded(ends, false) == Finding::kRight);
    }

    TEST_CASE("comparing answers counts each difference once, and says whose fault it is") {
        const KernelScene scene = make_kernel_scene("lump", Arrangement::kRoom, enclosed(ball(3, 0.2f), Vec3(), 3), [] {
            Camera camera;
            camera.eye = {1, 1.5, 2.5};
            return camera;
        }());
        const raytrace::Accelerator accelerator(*scene.scene, 1);
        const Judge judge(*scene.scene);
        const auto rays = camera_rays(scene.camera, 64, 64, PixelOrder::kRows, 1);
        const std::vector<Answer> right = all_answers(our_closest(accelerator, rays), rays.size(), 1);
        const Questions questions{rays, {}};
        const auto compared = [&](const std::vector<Answer>& ours, const std::vector<Answer>& theirs) {
            return compare_answers(judge, questions, ours, theirs, 2);
        };
        CHECK(compared(right, right).differ() == 0);
        CHECK(compared(right, right).rays == 64 * 64);

        std::vector<Answer> faulty = right;
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

        CHECK(judge_answers(judge, questions, faulty, 1, 2).wrong == 3);
        CHECK(judge_answers(judge, questions, faulty, 10, 1).wrong == 2);
        CHECK(judge_answers(judge, questions, faulty, 10, 1).rays == 410);

        // The double-precision judge must accept all of our hits.
        for (std::size_t i = 0; i < rays.size(); ++i) REQUIRE(judge.closest(rays[i], right[i]) != Finding::kWrong);
        const ShadowRays shadow = shadow_rays(scene, accelerator, rays, 0, 1);
        const Questions in_the_way{shadow.rays, shadow.ends};
        const auto blocked = all_answers(our_occluded(accelerator, shadow.rays, shadow.ends), shadow.rays.size(), 1);
        const Faults ours = judge_answers(judge, in_the_way, blocked, 1, 2);
        CHECK(ours.rays == std::ssize(shadow.rays));
        CHECK_FALSE(ours.any());
        std::vector<Answer> flipped = blocked;
        flipped[5].triangle = blocked[5].hit() ? Answer::kNone : 0;
        const Mismatches one = compare_answers(judge, in_the_way, blocked, flipped, 1);
        CHECK(one.unexplained == 1);
        CHECK(one.peer.wrong == 1);
    }

    TEST_CASE("between two triangles of one surface nothing gets through; past an outline it may") {
        const Scene scene = squares(); // their diagonal, (0, 0) to (1, 1), is an interior edge
        const Judge judge(scene);
        for (const float off : {-0x1p-21f, 0.0f, 0x1p-21f}) {
            const Ray inside = down(0.5f + off, 0.5f);
            CHECK(judge.closest(inside, kMiss) == Finding::kFault);
            CHECK(judge.closest(inside, {2, 2}) == Finding::kFault);
            CHECK(judge.closest(inside, {2, 3}) == Finding::kFault);
            CHECK(judge.occluded(inside, false) == Finding::kFault);
            CHECK(judge.closest(inside, {1, 1}) != Finding::kFault);
            const Ray outline = down(off, 0.5f);
            CHECK(judge.closest(outline, kMiss) != Finding::kFault);
            CHECK(judge.closest(outline, {2, 3}) != Finding::kFault);
            CHECK(judge.occluded(outline, false) != Finding::kFault);
            const Ray corner = down(1 + off, 1);
            CHECK(judge.closest(corner, kMiss) != Finding::kFault);
        }
        Faults faults;
        for (const Finding finding :
             {Finding::kRight, Finding::kFault, Finding::kWrong, Finding::kFault, Finding::kEdge})
            faults.count(finding);
        CHECK(faults.rays == 5);
        CHECK(faults.edge == 2);
        CHECK(faults.wrong == 1);
    }

    TEST_CASE("the triangle that a shadow ray ends on does not block it; what lies before it does") {
        const Scene scene = squares();
        const Judge judge(scene);
        const Ray ray = down(0.7f, 0.3f);
        const Hit lamp{0, 2, 0, 0, 2}; // on the lower square
        CHECK(judge.occluded(ray, lamp, true) == Finding::kRight); // occluded by the upper square
        CHECK(judge.occluded(ray, lamp, false) == Finding::kWrong);
        Ray below = ray;
        below.origin.z = -0.5f;
        CHECK(judge.occluded(below, Hit{0, 2, 0, 0, 0.5f}, false) == Finding::kRight);
        // The shadow ray ends at another triangle, which is farther away.
        CHECK(judge.occluded(below, Hit{0, 3, 0, 0, 0.6f}, false) == Finding::kWrong);
    }

    TEST_CASE("instances are judged where they stand") {
        const Scene scene =
            make_scene(ball(2), {translation(Vec3(-2, 0, 0)), translation(Vec3(2, 0, 0)) * scaling(Vec3(2, 2, 2))});
        const Judge judge(scene);
        const raytrace::Accelerator accelerator(scene, 1);
        std::vector<Ray> rays;
        for (const float x : {-2.1f, 2.1f}) rays.push_back({{x, 0.1f, 5}, {0, 0, -1}});
        std::vector<Answer> answers = all_answers(our_closest(accelerator, rays), rays.size(), 1);
        CHECK(answers[0].object == 0);
        CHECK(answers[1].object == 1);
        const Questions questions{rays, {}};
        CHECK_FALSE(judge_answers(judge, questions, answers, 1, 1).any());
        std::swap(answers[0].object, answers[1].object);
        CHECK(judge_answers(judge, questions, answers, 1, 1).wrong == 2);
    }
}
