#include "compare/hits/reference_tracer.h"

#include "tests/compare/test_scenes.h"

#include <doctest/doctest.h>

#include <optional>
#include <random>

using namespace duet;
using compare::ReferenceHit;
using compare::ReferenceTracer;

namespace {

using Random = std::mt19937_64;

Vec3d random_vector(Random& random, double size = 1) {
    std::uniform_real_distribution<double> uniform(-size, size);
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return {x, y, z};
}

/// Returns triangles of all sizes in [−1, 1]³.
Mesh triangle_soup(Random& random, int count) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const double size = std::exp(-3 * std::uniform_real_distribution<double>(0, 1)(random));
        const Vec3d center = random_vector(random);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int k = 0; k < 3; ++k) mesh.positions.emplace_back(center + random_vector(random, size));
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

/// Intersects a triangle in a different way: first the plane, then the sides of the three edges.
std::optional<double> hit_triangle(const Rayd& ray, Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d n = cross(b - a, c - a);
    const double t = dot(a - ray.origin, n) / dot(ray.direction, n);
    const Vec3d p = ray.at(t);
    const bool inside =
        dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0;
    return inside && t > ray.t_min && t <= ray.t_max ? std::optional(t) : std::nullopt;
}

/// Tests every primitive of every object in world space.
ReferenceHit brute_force(const Scene& scene, float time, const Rayd& ray) {
    ReferenceHit best;
    const auto offer = [&](std::uint32_t object, std::uint32_t primitive, std::optional<double> t) {
        if (t && *t < best.t) best = {object, primitive, *t};
    };
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
        const Mat4d map(object_transform(scene.objects[o], time).to_world);
        const Shape& shape = scene.shapes[scene.objects[o].shape];
        if (const auto* mesh = std::get_if<Mesh>(&shape))
            for (std::uint32_t i = 0; i < mesh->triangles.size(); ++i) {
                const auto corner = [&](std::size_t k) {
                    return transform_point(map, Vec3d(mesh->positions[mesh->triangles[i][k]]));
                };
                offer(o, i, hit_triangle(ray, corner(0), corner(1), corner(2)));
            }
        if (const auto* list = std::get_if<QuadList>(&shape))
            for (std::uint32_t i = 0; i < list->quads.size(); ++i) {
                const Quad& q = list->quads[i];
                const Vec3d a = transform_point(map, Vec3d(q.corner)), b = transform_point(map, Vec3d(q.corner + q.u)),
                            c = transform_point(map, Vec3d(q.corner + q.u + q.v)),
                            d = transform_point(map, Vec3d(q.corner + q.v));
                const auto first = hit_triangle(ray, a, b, c);
                offer(o, i, first ? first : hit_triangle(ray, a, c, d));
            }
        if (const auto* sphere = std::get_if<Sphere>(&shape)) { // with translations only
            const Vec3d f = ray.origin - transform_point(map, Vec3d(sphere->center));
            const double b = dot(f, ray.direction),
                         root = b * b - length_squared(f) + sqr(static_cast<double>(sphere->radius));
            if (root < 0) continue;
            const double near = -b - std::sqrt(root), far = -b + std::sqrt(root);
            if (near > ray.t_min)
                offer(o, 0, near);
            else if (far > ray.t_min)
                offer(o, 0, far);
        }
    }
    return best;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("the tracer finds what trying every primitive finds: instances, motion, quads, spheres") {
        Random random(11);
        Scene scene = test::empty_scene();
        test::add(scene, triangle_soup(random, 600));
        const Mat4 placed = translation(Vec3(0.5f, -0.2f, 0.3f)) * rotation(normalize(Vec3(1, 2, 3)), 1.1f) *
                            scaling(Vec3(0.7f, -1.2f, 0.4f));
        test::add(scene, triangle_soup(random, 300), placed);
        const Mat4 end = translation(Vec3(0.9f, 0.4f, 0.0f)) * placed;
        test::add(scene, triangle_soup(random, 100), placed, &end);
        test::add(scene, box_quads({-0.3f, -0.4f, 0.2f}, {0.1f, 0.3f, 0.6f}), placed);
        const Mat4 up = translation(Vec3(0.0f, 0.5f, 0.0f));
        test::add(scene, Sphere{{0.2f, 0.1f, -0.4f}, 0.25f}, up);
        for (const float time : {0.0f, 0.375f}) {
            const ReferenceTracer tracer(scene, time);
            int hits = 0;
            for (int i = 0; i < 2000; ++i) {
                Rayd ray;
                ray.origin = random_vector(random, 3);
                ray.direction = normalize(random_vector(random) - ray.origin);
                const ReferenceHit found = tracer.nearest(ray), expected = brute_force(scene, time, ray);
                CAPTURE(i);
                REQUIRE(found.object == expected.object);
                if (!found.valid()) continue;
                ++hits;
                REQUIRE(found.primitive == expected.primitive);
                REQUIRE(found.t == doctest::Approx(expected.t).epsilon(1e-11));
                const ReferenceHit again = tracer.intersect(ray, found.object, found.primitive);
                CHECK(again.t == doctest::Approx(found.t).epsilon(1e-12));
            }
            CHECK(hits > 1000); // otherwise the test covers nothing
        }
    }

    TEST_CASE("rays through the vertices and edges of a closed mesh do not leak") {
        Scene scene = test::empty_scene();
        Mesh mesh; // an octahedron, away from the origin
        for (const Vec3 p :
             {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)})
            mesh.positions.push_back(p + Vec3(0.3f, 0.7f, -0.1f));
        mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
        const Mesh copy = mesh;
        test::add(scene, std::move(mesh));
        const ReferenceTracer tracer(scene, 0);
        Random random(3);
        int leaks = 0;
        for (int i = 0; i < 5000; ++i) {
            const auto& t = copy.triangles[static_cast<std::size_t>(i) % copy.triangles.size()];
            const Vec3d a(copy.positions[t[0]]), b(copy.positions[t[1]]);
            const double s = i % 3 == 0 ? 0 : std::uniform_real_distribution<double>(0, 1)(random);
            Rayd ray;
            ray.origin = Vec3d(0.3, 0.7, -0.1) + random_vector(random, 0.3); // inside
            ray.direction = a * (1 - s) + b * s - ray.origin;
            if (!tracer.nearest(ray).valid()) ++leaks;
        }
        CHECK(leaks == 0);
    }

    TEST_CASE("equal distance: the lower object and primitive win") {
        Scene scene = test::empty_scene();
        const QuadList quad{{Quad{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, Quad{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}}};
        test::add(scene, quad);
        test::add(scene, quad);
        Rayd ray;
        ray.origin = {0.1, 0.2, 5};
        ray.direction = {0, 0, -1};
        const ReferenceHit hit = ReferenceTracer(scene, 0).nearest(ray);
        CHECK(hit.object == 0);
        CHECK(hit.primitive == 0);
        CHECK(hit.t == 5);
    }

    TEST_CASE("spheres: far, tiny, from inside, touched; cosines of both kinds of surface") {
        Scene scene = test::empty_scene();
        test::add(scene, Sphere{{0, 0, -1e6f}, 1.0f});
        test::add(scene, QuadList{{Quad{{-1, -1, -3e6f}, {2, 0, 0}, {0, 2, 2}}}});
        const ReferenceTracer tracer(scene, 0);
        Rayd ray;
        ray.direction = {0, 0, -1};
        CHECK(tracer.nearest(ray).t == doctest::Approx(1e6 - 1).epsilon(1e-14));
        CHECK(tracer.cosine(ray, 0, 0, 1e6 - 1) == doctest::Approx(1));
        CHECK(tracer.cosine(ray, 1, 0, 0) == doctest::Approx(std::sqrt(0.5)));
        ray.origin = {0, 0.5, -1e6};
        CHECK(tracer.nearest(ray).t == doctest::Approx(std::sqrt(0.75)));
        ray.origin = {1.0000001, 0, 0};
        CHECK_FALSE(tracer.intersect(ray, 0, 0).valid());
        ray.origin = {0.9999999, 0, 0};
        CHECK(tracer.intersect(ray, 0, 0).t == doctest::Approx(1e6).epsilon(1e-6));
    }
}
