#include "compare/hits/hit_agreement.h"

#include "compare/hits/edge_search.h"
#include "tests/compare/test_scenes.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::compare;

namespace {

constexpr int kWidth = 64, kHeight = 64;

/// Returns a view with the camera at z = 10 looking along −z. 64 pixels cover 64 units at z = 0, so pixel (x, y) is
/// centered at (x − 31.5, 31.5 − y).
View plain_view() {
    View view;
    view.width = kWidth;
    view.height = kHeight;
    view.camera.projection = Camera::Projection::kOrthographic;
    view.camera.height = 64;
    view.camera.eye = {0, 0, 10};
    view.camera.look_at = {0, 0, 0};
    return view;
}

Quad facing(float x0, float x1, float y0, float y1, float z) { return {{x0, y0, z}, {x1 - x0, 0, 0}, {0, y1 - y0, 0}}; }

/// Returns the hits of an exact pipeline.
Image<Hit> perfect_hits(const Scene& scene, const View& view) {
    const ReferenceTracer tracer(scene, 0);
    const Pinhole pinhole = CameraModel(view).pinhole();
    Image<Hit> hits(view.width, view.height);
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const ReferenceHit exact = tracer.nearest(pinhole.ray({x + 0.5, y + 0.5}));
            if (exact.valid()) hits(x, y) = {exact.object, exact.primitive, 0, 0, static_cast<float>(exact.t)};
        }
    return hits;
}

void set(Image<Hit>& hits, int x, int y, std::uint32_t object, std::uint32_t primitive = 0, float t = 10) {
    hits(x, y) = {object, primitive, 0, 0, t};
}

void check_counts(const HitAgreement& result, std::int64_t edge, std::int64_t depth_tie, std::int64_t unexplained) {
    CHECK(result.edge == edge);
    CHECK(result.depth_tie == depth_tie);
    CHECK(result.unexplained == unexplained);
    CHECK(result.pixels == kWidth * kHeight);
    CHECK(result.same == result.pixels - edge - depth_tie - unexplained);
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("pipelines that agree: all the same, no distance error") {
        Scene scene = test::empty_scene();
        test::add(scene, QuadList{{facing(-10, 10, -10, 10, 0)}});
        const Image<Hit> hits = perfect_hits(scene, plain_view());
        const HitAgreement result = compare_hits(scene, plain_view(), hits, hits);
        check_counts(result, 0, 0, 0);
        CHECK(result.worst_distance == 0);
        CHECK(result.distance_violations == 0);
    }

    TEST_CASE("an edge that passes the pixel's center within 1/128 pixel explains; one a little further off does not") {
        // The boundary between two quads is at x = offset, and the center of pixel 32 is at 0.5.
        for (const double side : {-1.0, 1.0})
            for (const double distance : {0.0077, 0.0079}) {
                const float boundary = static_cast<float>(0.5 + side * distance);
                Scene scene = test::empty_scene();
                test::add(scene, QuadList{{facing(-20, boundary, -20, 20, 0), facing(boundary, 20, -20, 20, 0)}});
                const Image<Hit> raytrace = perfect_hits(scene, plain_view());
                Image<Hit> raster = raytrace;
                raster(32, 30).primitive = 1 - raytrace(32, 30).primitive;
                CAPTURE(side);
                CAPTURE(distance);
                const bool near = distance < kEdgeRadius;
                check_counts(compare_hits(scene, plain_view(), raster, raytrace), near, 0, !near);
                check_counts(compare_hits(scene, plain_view(), raytrace, raster), near, 0, !near);
            }
    }

    TEST_CASE("an edge of something else close by explains nothing") {
        Scene scene = test::empty_scene();
        test::add(scene, QuadList{{facing(-20, 0.5f, -20, 20, 0), facing(0.5f, 20, -20, 20, 0)}});
        test::add(scene, QuadList{{facing(-20, 20, -20, 20, -5)}}); // fully hidden by the two
        const Image<Hit> raytrace = perfect_hits(scene, plain_view());
        Image<Hit> raster = raytrace;
        set(raster, 32, 30, 1, 0, 15);
        const HitAgreement result = compare_hits(scene, plain_view(), raster, raytrace);
        check_counts(result, 0, 0, 1);
        REQUIRE(result.listed.size() == 1);
        CHECK(result.listed[0].x == 32);
        CHECK(result.listed[0].y == 30);
        CHECK(result.listed[0].raster.object == 1);
        CHECK(result.listed[0].exact.object == 0);
        CHECK(result.verdicts(32, 30) == HitVerdict::kUnexplained);
    }

    TEST_CASE("a silhouette: hit and miss are an edge; a miss in the middle of a surface is not") {
        Scene scene = test::empty_scene();
        test::add(scene,
                  // Its rightmost point is 0.001 to the right of the center of pixel 42.
                  Sphere{{0.5f, 0.5f, 0}, 10.001f});
        const Image<Hit> raytrace = perfect_hits(scene, plain_view());
        REQUIRE(raytrace(42, 31).valid());
        Image<Hit> raster = raytrace;
        raster(42, 31) = Hit{};
        check_counts(compare_hits(scene, plain_view(), raster, raytrace), 1, 0, 0);
        raster(32, 31) = Hit{};
        check_counts(compare_hits(scene, plain_view(), raster, raytrace), 1, 0, 1);
    }

    TEST_CASE("a sliver far thinner than the disk is found, if it is seen") {
        for (const float depth : {1.0f, -1.0f}) { // in front of the wall, behind it
            Scene scene = test::empty_scene();
            test::add(scene, QuadList{{facing(-20, 20, -20, 20, 0)}});
            const float x = 0.505f;
            test::add(scene,
                      Mesh{{{x, -5, depth}, {x + 2e-6f, -5, depth}, {x, 5, depth}}, {}, {}, {{0, 1, 2}}, {}, false});
            const Image<Hit> raytrace = perfect_hits(scene, plain_view());
            Image<Hit> raster = raytrace;
            set(raster, 32, 33, 1);
            const bool seen = depth > 0;
            CAPTURE(depth);
            check_counts(compare_hits(scene, plain_view(), raster, raytrace), seen, 0, !seen);
        }
    }

    TEST_CASE("a hidden face counts where it meets the one before it, at the edge, and nowhere else") {
        // The quads are a block's front and its bottom, which is visible through the open top. They meet at y = 0.5 ±
        // offset, z = 0.
        for (const double offset : {-1e-4, 0.1}) {
            Scene scene = test::empty_scene();
            const float edge = static_cast<float>(0.5 - offset);
            test::add(scene, QuadList{{facing(-20, 20, edge, 20, 0), Quad{{-20, edge, 0}, {40, 0, 0}, {0, 5, -5}}}});
            const Image<Hit> raster = perfect_hits(scene, plain_view());
            CAPTURE(offset);
            REQUIRE(raster(20, 31).valid() == (offset > 0)); // pixel row 31 is centered at y = 0.5
            Image<Hit> raytrace = raster;
            set(raytrace, 20, 31, 0, 1);
            const bool at_edge = offset < 0;
            check_counts(compare_hits(scene, plain_view(), raster, raytrace), 0, at_edge, !at_edge);
        }
    }

    TEST_CASE("surfaces at one distance are a depth tie, surfaces further apart than the tolerance are not") {
        for (const float gap : {0.0f, 0.5e-4f, 2e-4f}) { // tolerance at t = 10: 1e-4
            Scene scene = test::empty_scene();
            test::add(scene, QuadList{{facing(-20, 20, -20, 20, 0)}});
            test::add(scene, QuadList{{facing(-20, 20, -20, 20, -gap)}});
            const Image<Hit> raytrace = perfect_hits(scene, plain_view());
            Image<Hit> raster = raytrace;
            set(raster, 20, 20, 1);
            CAPTURE(gap);
            const bool tie = gap < 1e-4f;
            check_counts(compare_hits(scene, plain_view(), raster, raytrace), 0, tie, !tie);
        }
    }

    TEST_CASE("distances: worst one, violations, and the relief for grazing surfaces") {
        Scene scene = test::empty_scene();
        test::add(scene, QuadList{{facing(-20, 20, -20, 20, 0)}});
        const Image<Hit> raytrace = perfect_hits(scene, plain_view());
        Image<Hit> raster = raytrace;
        // The surface is 10 meters from the ray's origin, which is at (-1.5, 0.5, 10), and its farthest corner 31.
        raster(30, 31).t = 10 * (1 + 2.4e-5f);
        HitAgreement result = compare_hits(scene, plain_view(), raster, raytrace);
        CHECK(result.worst_distance == doctest::Approx(2.4e-4 / length(Vec3d(21.5, 20.5, 10))).epsilon(0.02));
        CHECK(result.distance_violations == 0);
        raster(33, 34).t = 10 * (1 - 3.3e-5f);
        raster(34, 34).t = std::numeric_limits<float>::quiet_NaN();
        result = compare_hits(scene, plain_view(), raster, raytrace);
        CHECK(result.distance_violations == 2);
        CHECK(result.same == result.pixels);

        Scene grazing = test::empty_scene(); // a slope of 1 : 10, cos θ = 0.0995
        test::add(grazing, QuadList{{Quad{{-2, -20, 20}, {4, 0, -40}, {0, 40, 0}}}});
        const Image<Hit> exact = perfect_hits(grazing, plain_view());
        Image<Hit> off = exact;
        REQUIRE(exact(31, 31).valid());
        off(31, 31).t *= 1 + 5e-5f;
        result = compare_hits(grazing, plain_view(), off, exact);
        CHECK(result.distance_violations == 0);
        const double reach = length(Vec3d(2, 20, -20) - Vec3d(-0.5, 0.5, 10));
        CHECK(result.worst_distance ==
              doctest::Approx(5e-5 * 0.0995 * static_cast<double>(exact(31, 31).t) / reach).epsilon(0.02));
    }

    TEST_CASE("distances: a thin primitive's plane is less certain than a square one's, in proportion") {
        for (const float thinness : {1.0f, 20.0f}) {
            Scene scene = test::empty_scene();
            test::add(scene, QuadList{{facing(-20, 20, -20 / thinness, 20 / thinness, 0)}});
            const Image<Hit> exact = perfect_hits(scene, plain_view());
            Image<Hit> off = exact;
            REQUIRE(exact(32, 32).valid());
            off(32, 32).t *= 1 + 2e-4f;
            const HitAgreement result = compare_hits(scene, plain_view(), off, exact);
            CHECK(result.distance_violations == (thinness > 1 ? 0 : 1));
        }
    }

    TEST_CASE("distances: the rounding of an orthographic ray's origin is allowed, and no more") {
        View view = plain_view();
        view.camera.eye = {0, 0, 1e5 + 10};
        view.camera.look_at = {0.3, 0.2, 1e5}; // oblique, so that the origins differ in z
        Scene scene = test::empty_scene();
        test::add(scene, QuadList{{facing(-20, 20, -20, 20, 1e5f)}});
        const Image<Hit> exact = perfect_hits(scene, view);
        const Rayd ray = CameraModel(view).pinhole().ray({20.5, 12.5});
        const double rounding = length(Vec3d(Vec3(ray.origin)) - ray.origin);
        REQUIRE(exact(20, 12).valid());
        REQUIRE(rounding > 1e-4);
        for (const double relief : {0.9, 5.0}) {
            Image<Hit> off = exact;
            off(20, 12).t += static_cast<float>(relief * rounding);
            CHECK(compare_hits(scene, view, off, exact).distance_violations == (relief > 1 ? 1 : 0));
        }
    }

    TEST_CASE("a face that is parallel to the rays counts on the line that it projects to, and nowhere else") {
        Scene scene = test::empty_scene();
        test::add(scene, QuadList{{facing(-20, 20, -20, 20, 0)}});
        test::add(scene, QuadList{{Quad{{0.5f, -5, 0}, {0, 10, 0}, {0, 0, 2}}}}); // through the centers of column 32
        const View view = plain_view();
        const Image<Hit> exact = perfect_hits(scene, view);
        const auto judged = [&](int x, int y, float t) {
            Image<Hit> hits = exact;
            set(hits, x, y, 1, 0, t);
            return compare_hits(scene, view, hits, exact);
        };
        check_counts(judged(32, 31, 9), 1, 0, 0);
        check_counts(judged(40, 31, 9), 0, 0, 1);  // beside it
        check_counts(judged(32, 20, 9), 0, 0, 1);  // beyond its end
        check_counts(judged(32, 31, 11), 0, 0, 1); // behind what all rays see
    }

    TEST_CASE("a face whose plane contains the eye counts on the line that it projects to, and nowhere else") {
        View view = plain_view();
        view.camera.projection = Camera::Projection::kPerspective;
        view.camera.fov_degrees = 90; // 64 pixels cover 20 units at z = 0
        view.camera.eye = {0, 0, 10};
        const auto judged = [&](float right, int y, float t) {
            Scene scene = test::empty_scene();
            test::add(scene, QuadList{{facing(-9, right, -9, 9, 0)}});
            // The plane x = 0 projects to the boundary of columns 31 and 32. The shear moves that to 1/256 pixel from
            // the center of column 32.
            const float shear = (0.5f + 1 / 256.0f) * 20 / 64 / 10;
            test::add(scene, QuadList{{Quad{{shear * 10, -5, 0}, {0, 10, 0}, {-shear * 2, 0, 2}}}});
            const Image<Hit> exact = perfect_hits(scene, view);
            Image<Hit> hits = exact;
            set(hits, 32, y, 1, 0, t);
            return compare_hits(scene, view, hits, exact);
        };
        const float at_wall = 10, beyond = 10.5f;
        check_counts(judged(9, 31, 9), 1, 0, 0);
        check_counts(judged(9, 31, beyond), 0, 0, 1);             // behind what all rays see
        check_counts(judged(9, 2, 9), 0, 0, 1);                   // beyond its end
        check_counts(judged(0.15f, 31, at_wall + 0.001f), 1, 0, 0); // rays see past the wall's edge
    }

    TEST_CASE("of two steep surfaces that nearly coincide, either may be seen at an edge, and nowhere else") {
        // Both are valleys with their bottom at x = 0.5 - offset. Beside the bottom, the rasterizer may move a point
        // over it, which changes the distance by up to 1/64. The tie's tolerance is 1e-4.
        for (const float offset : {0.002f, 0.2f})
            for (const float gap : {0.005f, 0.05f}) {
                Scene scene = test::empty_scene();
                const float bottom = 0.5f - offset;
                for (const float behind : {0.0f, gap})
                    test::add(scene, QuadList{{Quad{{bottom, -9.5f, -behind}, {10, 0, 20}, {0, 20, 0}},
                                               Quad{{bottom, -9.5f, -behind}, {-10, 0, 20}, {0, 20, 0}}}});
                const Image<Hit> raytrace = perfect_hits(scene, plain_view());
                REQUIRE(raytrace(32, 31).object == 0);
                REQUIRE(raytrace(32, 31).primitive == 0);
                Image<Hit> raster = raytrace;
                set(raster, 32, 31, 1, 1); // the hidden surface's other side
                CAPTURE(offset);
                CAPTURE(gap);
                const bool tie = offset < 0.01f && gap < 0.01f;
                check_counts(compare_hits(scene, plain_view(), raster, raytrace), 0, tie, !tie);
                set(raster, 32, 31, 1, 0); // the hidden surface at the same place
                check_counts(compare_hits(scene, plain_view(), raster, raytrace), 0, 0, 1);
            }
    }

    TEST_CASE("moving objects are judged as the shutter opens, instances where they stand") {
        Scene scene = test::empty_scene();
        const Mat4 start = translation(Vec3(-10, 0, 0)), end = translation(Vec3(10, 0, 0));
        test::add(scene, QuadList{{facing(-2, 2, -2, 2, 0)}}, start, &end);
        View view = plain_view();
        view.camera.shutter_open = 0.25; // the object is then at x = −5
        const Pinhole pinhole = CameraModel(view).pinhole();
        const ReferenceTracer tracer(scene, CameraModel(view).time(0));
        CHECK(tracer.nearest(pinhole.ray({32 - 5.0, 32})).valid());
        CHECK_FALSE(tracer.nearest(pinhole.ray({32 - 10.0, 32})).valid());
        Image<Hit> raster(kWidth, kHeight), raytrace(kWidth, kHeight);
        set(raster, 22, 32, 0); // its position at time 0, not at 0.25
        check_counts(compare_hits(scene, view, raster, raytrace), 0, 0, 1);
    }

    TEST_CASE("hits that don't fit are refused") {
        Scene scene = test::empty_scene();
        test::add(scene, Sphere{{0, 0, 0}, 1.0f});
        Image<Hit> hits(kWidth, kHeight), bad(kWidth, kHeight);
        set(bad, 3, 3, 0, 1);
        CHECK_THROWS_AS(compare_hits(scene, plain_view(), hits, bad), Error);
        CHECK_THROWS_AS(compare_hits(scene, plain_view(), Image<Hit>(3, 3), hits), Error);
    }
}
