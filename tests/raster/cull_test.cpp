// These tests check that culling removes only invisible primitives. They compare images with and without culling, and
// cover the cases in which back faces must remain.
#include "tests/raster/scenes.h"

#include "raster/geometry/cull.h"
#include "raster/raster_scene.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

std::int64_t skipped(const Rendering& rendering, const std::string& what) {
    for (const SkippedWork& s : rendering.statistics.skipped)
        if (s.what == what) return s.count;
    return 0;
}

/// Counts the pixels whose hits differ. A sample that only a snapped silhouette edge covers belongs to a front and
/// a back face at their common edge, where rounding decides which is nearer. Culling may change the primitive there,
/// but nothing else.
struct Difference {
    int coverage = 0, object = 0, distance = 0, primitive = 0;
};
Difference difference(const Image<Hit>& a, const Image<Hit>& b) {
    Difference d;
    for (std::size_t i = 0; i < a.size(); ++i) {
        d.coverage += a[i].valid() != b[i].valid();
        d.object += a[i].object != b[i].object;
        d.primitive += a[i].primitive != b[i].primitive;
        d.distance += a[i].valid() && std::abs(a[i].t - b[i].t) > 1e-3f * a[i].t;
    }
    return d;
}

Scene tori() {
    Scene scene;
    add(scene, torus(60, 30));
    add_instance(scene, 0, Mat4(translation(Vec3(1.2f, 0.5f, 0)) * rotation(Vec3(1, 0, 0), 1.2f)));
    add_instance(scene, 0, Mat4(translation(Vec3(-1, 0.2f, 0.5f)) * scaling(Vec3(-0.7f, 0.7f, 0.7f)))); // mirrored
    add_instance(scene, 0, Mat4(translation(Vec3(0, 80, 0))));                                          // not visible
    finish_scene(scene);
    return scene;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("culling on and off give the same image") {
        const Scene scene = tori();
        for (int i = 0; i < 12; ++i) {
            const double angle = 0.6 * i;
            const View view{look({4 * std::cos(angle), 1.5, 4 * std::sin(angle)}, {0, 0, 0}, 40), 240, 180};
            raster::RasterSettings settings = hits_only();
            const Rendering with = render(scene, view, settings);
            settings.skips.frustum = settings.skips.back_faces = false;
            const Rendering without = render(scene, view, settings);
            const Difference d = difference(with.hit, without.hit);
            CHECK(d.coverage == 0);
            CHECK(d.object == 0);
            CHECK(d.distance == 0);
            CHECK(d.primitive <= 12); // of 43,200 pixels
            double sum_with = 0, sum_without = 0;
            for (std::size_t k = 0; k < with.radiance.size(); ++k) {
                sum_with += static_cast<double>(luminance(with.radiance[k]));
                sum_without += static_cast<double>(luminance(without.radiance[k]));
            }
            CHECK(sum_with == doctest::Approx(sum_without).epsilon(1e-3));
            CHECK(skipped(with, "backfaces") > 4000);
            CHECK(skipped(with, "outside the frustum") >= 3600);
            CHECK(skipped(without, "backfaces") == 0);
        }
    }

    TEST_CASE("the eye inside a closed mesh sees its inside in every pixel") {
        Scene scene;
        add(scene, torus(40, 20));
        finish_scene(scene);
        CHECK(std::get<Mesh>(scene.shapes[0]).closed.value());
        const View view{look({1.0, 0.05, 0.02}, {0.9, 0.0, -1}, 90), 64, 48};
        const Rendering rendering = render(scene, view, hits_only());
        CHECK(skipped(rendering, "backfaces") == 0);
        CHECK(std::all_of(rendering.hit.begin(), rendering.hit.end(), [](const Hit& h) { return h.valid(); }));
        const Agreement agreement = compare_hits(scene, view, rendering.hit);
        CAPTURE(agreement.first);
        CHECK(agreement.unexplained == 0);
    }

    TEST_CASE("a mesh that the near plane cuts open keeps its back faces") {
        Scene scene;
        add(scene, torus(40, 20));
        finish_scene(scene);
        View view{look({0, 0.3, 4}, {0, 0, 0}, 40), 96, 72};
        view.camera.near = 3.9; // the near plane cuts the torus
        const Rendering rendering = render(scene, view, hits_only());
        CHECK(skipped(rendering, "backfaces") == 0);
        const Agreement agreement = compare_hits(scene, view, rendering.hit);
        CAPTURE(agreement.first);
        CHECK(agreement.unexplained == 0);
        CHECK(agreement.same > 96 * 72 * 0.98);
    }

    TEST_CASE("mirrored, inside-out, and mirrored inside-out: each pixel sees the nearest face") {
        for (const bool mirrored : {false, true})
            for (const bool inside_out : {false, true}) {
                Scene scene;
                add(scene, inside_out ? turned_inside_out(torus(40, 20)) : torus(40, 20));
                add_instance(scene, 0, Mat4(scaling(Vec3(mirrored ? -1.0f : 1.0f, 1, 1.1f))));
                scene.objects.erase(scene.objects.begin());
                finish_scene(scene);
                const View view{look({1, 2, 3}, {0, 0, 0}, 45), 96, 72};
                const Rendering rendering = render(scene, view, hits_only());
                const Agreement agreement = compare_hits(scene, view, rendering.hit);
                CAPTURE(mirrored);
                CAPTURE(inside_out);
                CAPTURE(agreement.first);
                CHECK(agreement.unexplained == 0);
                CHECK((skipped(rendering, "backfaces") > 0) ==
                      (std::get<Mesh>(scene.shapes[scene.objects[0].shape]).closed.value()));
            }
    }

    TEST_CASE("glass and open meshes keep their back faces") {
        Scene glass, open;
        add(glass, torus(40, 20), Mat4(), Dielectric{});
        Mesh half = torus(40, 20);
        half.triangles.resize(half.triangles.size() / 2);
        add(open, half);
        for (Scene* scene : {&glass, &open}) {
            finish_scene(*scene);
            const View view{look({1, 2, 3}, {0, 0, 0}, 45), 96, 72};
            const Rendering rendering = render(*scene, view, hits_only());
            CHECK(skipped(rendering, "backfaces") == 0);
            const Agreement agreement = compare_hits(*scene, view, rendering.hit);
            CAPTURE(agreement.first);
            CHECK(agreement.unexplained == 0);
        }
    }

    TEST_CASE("six quads are closed where they enclose a space and face outwards, not for being six") {
        QuadList box = box_quads(Vec3(-0.1f, 0.3f, 7), Vec3(1, 0.7f, 7.3f)), open = box, inside_out = box, twice = box;
        open.quads[2].corner.y -= 0.1f; // an open box
        for (Quad& quad : inside_out.quads) std::swap(quad.u, quad.v);
        twice.quads[1] = twice.quads[0];
        QuadList sheets = box; // six boxes side by side
        for (std::size_t i = 0; i < 6; ++i)
            sheets.quads[i] = {Vec3(static_cast<float>(i), 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
        Scene scene;
        for (const QuadList& quads : {box, open, inside_out, twice, sheets}) add(scene, quads);
        finish_scene(scene);
        const raster::RasterScene prepared = raster::prepare(scene, {});
        for (std::size_t i = 0; i < 5; ++i) CHECK(prepared.data().objects[i].closed == (i == 0));
    }

    TEST_CASE("a box is outside the frustum only if no point of it can be seen") {
        const View view{look({0, 0, 5}, {0, 0, 0}, 40), 64, 48};
        const Pinhole pinhole = CameraModel(view).pinhole();
        const raster::Viewport viewport{64, 48, pinhole.near};
        const auto outside = [&](Vec3 center, float half) {
            const Vec3 h(half, half, half);
            return raster::outside_frustum(Box3{center - h, center + h}, pinhole, viewport);
        };
        CHECK_FALSE(outside({0, 0, 0}, 0.1f));
        CHECK_FALSE(outside({0, 0, 5}, 0.1f));    // contains the eye
        CHECK_FALSE(outside({0, 0, 0}, 1e6f));    // contains the whole scene
        CHECK_FALSE(outside({3.5f, 0, 0}, 1.5f)); // partly inside the frustum
        CHECK(outside({0, 0, 6}, 0.5f));          // behind the eye
        CHECK(outside({10, 0, 0}, 1));
        CHECK(outside({0, -10, 0}, 1));
        CHECK(raster::outside_frustum(Box3{}, pinhole, viewport)); // an empty box
    }
}
