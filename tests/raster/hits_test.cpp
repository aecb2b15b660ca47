// These tests compare every pixel of a hit image with an exact ray.
#include "tests/raster/scenes.h"

#include <doctest/doctest.h>

#include <random>

using namespace duet;
using namespace duet::test;

namespace {

/// Renders and compares. At most the fraction `edges` of the pixels may differ because of an edge near the sample.
Rendering check_hits(const Scene& scene, const View& view, double edges = 0.001, bool cull = true) {
    raster::RasterSettings settings = hits_only();
    settings.skips.frustum = settings.skips.back_faces = cull;
    Rendering rendering = render(scene, view, settings);
    const Agreement agreement = compare_hits(scene, view, rendering.hit);
    CAPTURE(agreement.first);
    CHECK(agreement.unexplained == 0);
    CHECK(agreement.wrong_distance == 0);
    CHECK(agreement.edge <= edges * view.width * view.height);
    return rendering;
}

int count_hits(const Image<Hit>& hits) {
    return static_cast<int>(std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.valid(); }));
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    Vec3 vector(double reach) {
        return Vec3(Vec3d((*this)(-reach, reach), (*this)(-reach, reach), (*this)(-reach, reach)));
    }

private:
    std::mt19937 engine_;
};

Mesh soup(Random& random, int count, double reach, double size) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3 center = random.vector(reach);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(center + random.vector(size));
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

/// Calls check(hit, exact, ray) for each pixel that shows an object, with the hit of its ray in double.
template <typename Check>
void for_each_hit(const Scene& scene, const View& view, const Image<Hit>& hits, const Check& check) {
    const Oracle oracle(scene);
    const Pinhole pinhole = CameraModel(view).pinhole();
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const Rayd ray = pinhole.ray({x + 0.5, y + 0.5});
            if (hits(x, y).valid()) check(hits(x, y), oracle.trace(ray), ray);
        }
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a soup of triangles before, behind and through the eye's plane") {
        Random random(1);
        for (int i = 0; i < 4; ++i) {
            Scene scene;
            add(scene, soup(random, 60, 3, 2));
            finish_scene(scene);
            check_hits(scene, {look(Vec3d(random.vector(2)), Vec3d(random.vector(1)), 70), 64, 48}, 0.005);
        }
    }

    TEST_CASE("a soup under a transform, and the same scene at scales from 1e-6 to 1e6") {
        for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
            Random random(2);
            Scene scene;
            add(scene, soup(random, 50, 2, 1));
            const auto s = static_cast<float>(scale);
            add_instance(scene, 0, scaling(Vec3(s, -s, s)) * rotation(normalize(Vec3(1, 2, 3)), 0.7f));
            scene.objects.erase(scene.objects.begin());
            finish_scene(scene);
            CAPTURE(scale);
            check_hits(scene, {look(Vec3d(1, 2, 5) * scale, Vec3d(), 40), 64, 48}, 0.005);
        }
    }

    TEST_CASE("a floor that runs under the eye to the horizon and behind") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-1000, 0, 1000), Vec3(2000, 0, 0), Vec3(0, 0, -2000)}}});
        finish_scene(scene);
        const View view{look({0, 1.5, 0}, {0.3, 1.2, -3}, 60), 160, 120};
        const Rendering rendering = check_hits(scene, view, 0.001);
        // Every pixel below the horizon shows the floor.
        const CameraModel camera(view);
        CHECK(rendering.hit(80, 119).valid());
        CHECK(rendering.hit(0, 119).valid());
        CHECK_FALSE(rendering.hit(80, 0).valid());
        CHECK(count_hits(rendering.hit) > 160 * 50);
    }

    TEST_CASE("triangles that pass right through the eye's plane, one corner far off") {
        Random random(3);
        for (int i = 0; i < 10; ++i) {
            Scene scene;
            Mesh mesh;
            mesh.positions = {Vec3(0, -0.5f, 5e3f), Vec3(-1, -0.4f, -3), Vec3(1, -0.6f, -3),
                              random.vector(1e6),   random.vector(10),   random.vector(10)};
            mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
            add(scene, mesh);
            finish_scene(scene);
            check_hits(scene, {look({0, 0, 0}, {0, 0, -1}, 90), 64, 64}, 0.003);
        }
    }

    TEST_CASE("quads are one primitive, u and v run along their edges") {
        Scene scene;
        add(scene, QuadList{{{Vec3(-1, -1, 0), Vec3(2, 0.2f, 0.5f), Vec3(0.3f, 2, -1)},
                             {Vec3(-2, -2, -1), Vec3(4, 0, 0), Vec3(0, 4, 0)}}});
        finish_scene(scene);
        const View view{look({0.5, 0.3, 4}, {0, 0, 0}, 45), 96, 72};
        const Rendering rendering = check_hits(scene, view);
        for_each_hit(scene, view, rendering.hit, [](const Hit& hit, const ReferenceHit& exact, const Rayd&) {
            if (hit.primitive != exact.primitive || hit.object != exact.object) return;
            REQUIRE(hit.u == doctest::Approx(exact.u).epsilon(1e-6));
            REQUIRE(hit.v == doctest::Approx(exact.v).epsilon(1e-6));
        });
    }

    TEST_CASE("a quad's diagonal is no edge of it: distances are exact there, too") {
        Random random(12);
        int compared = 0;
        for (int i = 0; i < 600; ++i) {
            Scene scene;
            add(scene, QuadList{{{random.vector(1), random.vector(4), random.vector(4)}}});
            finish_scene(scene);
            const View view{look({0, 0, 3}, Vec3d(random.vector(1)), 70), 32, 24};
            const Image<Hit> hits = render(scene, view, hits_only()).hit;
            for_each_hit(scene, view, hits, [&](const Hit& hit, const ReferenceHit& exact, const Rayd&) {
                if (exact.object == kNoObject || exact.cosine < 0.01) return;
                REQUIRE(static_cast<double>(hit.t) == doctest::Approx(exact.t).epsilon(2e-6));
                ++compared;
            });
        }
        CHECK(compared > 10000);
    }

    TEST_CASE("barycentrics are perspective-correct: those of the exact ray") {
        Random random(4);
        Scene scene;
        add(scene, soup(random, 30, 2, 3));
        finish_scene(scene);
        const View view{look({0, 0, 5}, {0, 0, 0}, 60), 96, 72};
        const Rendering rendering = check_hits(scene, view, 0.003);
        const Oracle oracle(scene);
        const Pinhole pinhole = CameraModel(view).pinhole();
        int compared = 0;
        for (int y = 0; y < view.height; ++y)
            for (int x = 0; x < view.width; ++x) {
                const Hit& hit = rendering.hit(x, y);
                const ReferenceHit exact = oracle.trace(pinhole.ray({x + 0.5, y + 0.5}));
                if (!hit.valid() || hit.primitive != exact.primitive || exact.cosine < 0.05) continue;
                REQUIRE(std::abs(static_cast<double>(hit.u) - exact.u) < 2e-6);
                REQUIRE(std::abs(static_cast<double>(hit.v) - exact.v) < 2e-6);
                REQUIRE(static_cast<double>(rendering.depth(x, y)) ==
                        doctest::Approx(exact.t * dot(pinhole.ray({x + 0.5, y + 0.5}).direction, pinhole.forward))
                            .epsilon(1e-6));
                ++compared;
            }
        CHECK(compared > 1000);
    }

    TEST_CASE("orthographic images of meshes and spheres") {
        Random random(5);
        Scene scene;
        add(scene, soup(random, 40, 2, 1));
        add(scene, Sphere{Vec3(0.5f, 0.2f, 0.3f), 0.7f});
        add(scene, torus(24, 12), Mat4(rotation(normalize(Vec3(1, 1, 0)), 0.8f)));
        finish_scene(scene);
        check_hits(scene, {look_orthographic({3, 2, 4}, {0, 0, 0}, 4), 80, 60}, 0.005);
        // The near plane cuts all objects.
        check_hits(scene, {look_orthographic({0.1, 0.1, 0.5}, {0, 0, 0}, 2), 80, 60}, 0.005);
    }

    TEST_CASE("spheres and ellipsoids have the silhouettes that rays see, from everywhere") {
        Random random(6);
        for (int i = 0; i < 24; ++i) {
            Scene scene;
            for (int k = 0; k < 4; ++k) add(scene, Sphere{random.vector(2), static_cast<float>(random(0.1, 1.5))});
            const Mat4 stretch = Mat4(translation(random.vector(1))) * rotation(normalize(random.vector(1)), 1.0f) *
                                 scaling(Vec3(0.3f, -1.2f, 0.7f));
            add_instance(scene, 0, stretch);
            finish_scene(scene);
            Camera camera = look(Vec3d(random.vector(2.5)), Vec3d(random.vector(0.5)), 75);
            if (i % 3 == 0) camera.near = 0.8; // the near plane cuts spheres
            check_hits(scene, {camera, 64, 48}, 0.003);
        }
    }

    TEST_CASE("the eye inside a sphere sees it in every pixel") {
        Scene scene;
        add(scene, Sphere{Vec3(0, 0, 0), 2});
        add(scene, Sphere{Vec3(5, 0, 0), 1}, Mat4(translation(Vec3(-5, 0, 0)) * scaling(Vec3(1, 0.5f, 2))));
        finish_scene(scene);
        const Rendering rendering = check_hits(scene, {look({0.1, 0.2, 0.3}, {1, 0, 0}, 100), 64, 48}, 0.003);
        CHECK(count_hits(rendering.hit) == 64 * 48);
    }

    TEST_CASE("intersecting meshes, spheres and boxes decide each pixel as the ray does") {
        Scene scene;
        add(scene, torus(40, 20));
        add(scene, Sphere{Vec3(0.9f, 0, 0.2f), 0.6f});
        add(scene, box_quads(Vec3(-1.2f, -0.2f, -0.5f), Vec3(-0.2f, 0.6f, 1)), Mat4(rotation(Vec3(0, 1, 0), 0.4f)));
        finish_scene(scene);
        check_hits(scene, {look({1.5, 2, 3}, {0, 0, 0}, 45), 160, 120}, 0.003);
    }
}
