// These tests compare the hierarchy's hits with those of testing every primitive, on triangles that are hard to
// separate.
#include "raytrace/acceleration/accelerator.h"
#include "tests/raytrace/acceleration/soup.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;
using namespace duet::raytrace;

namespace {

// Returns small triangles with long thin ones between them, none axis-aligned, so boxes overlap widely.
Mesh thicket(Random& random, int count) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
        const bool is_long = i % 8 == 0;
        const Vec3 way = random.direction() * (is_long ? 2.0f : 0.02f), p = random.vector() - way * 0.5f;
        for (const Vec3& q : {p, p + way, p + way * 0.5f + random.vector() * 0.02f}) mesh.positions.push_back(q);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

// Returns rays at the scene's vertices and at points of its triangles, along the axes with zeros of both signs, and
// random ones.
Ray hard_ray(Random& random, const Mesh& mesh, float scale, Vec3 offset, int trial) {
    const auto& t = mesh.triangles[static_cast<std::size_t>(random.below(static_cast<int>(mesh.triangles.size())))];
    const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    const float u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
    const Vec3 target = trial % 3 == 0 ? a : trial % 3 == 1 ? lerp(a, b, u) : a + (b - a) * u + (c - a) * v;
    Ray ray;
    ray.origin = trial % 2 ? offset + random.vector() * scale : offset + random.direction() * (scale * 4);
    ray.direction = normalize(target - ray.origin);
    if (trial % 5 == 0) {
        const auto axis = static_cast<std::size_t>(random.below(3));
        const float zero = random.below(2) ? 0.0f : -0.0f;
        ray.direction = {zero, -zero, zero};
        ray.direction[axis] = random.below(2) ? 1.0f : -1.0f;
        ray.origin = target - ray.direction * scale;
    } else if (trial % 5 == 1) { // nearly in the triangle's plane
        ray.origin = target + (b - a) * random.uniform(1, 3) + random.vector() * (1e-5f * scale);
        ray.direction = normalize(target - ray.origin);
    }
    return ray;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("thin triangles that overlap have the hits of testing every primitive, to the bit") {
        for (const float scale : {1e-6f, 1.0f, 1e6f})
            for (const float shift : {0.0f, 30.0f}) {
                CAPTURE(scale);
                CAPTURE(shift);
                Random random(24);
                Mesh mesh = thicket(random, 3000);
                const Vec3 offset = Vec3(1, -0.5f, 0.25f) * (shift * scale);
                for (Vec3& p : mesh.positions) p = offset + p * scale;
                // The duplicates cause ties.
                for (std::size_t i = 0; i < 100; ++i) mesh.triangles.push_back(mesh.triangles[i]);
                SceneBuilder builder;
                builder.add(mesh, builder.material(Diffuse{}));
                const Scene scene = builder.finish();
                const Accelerator accelerator(scene, 2);
                int hits = 0, different = 0, wrong_shadows = 0;
                std::string first;
                for (int trial = 0; trial < 2000; ++trial) {
                    const Ray ray = hard_ray(random, mesh, scale, offset, trial);
                    const Hit expected = brute_force_hit(scene, ray), found = accelerator.closest(ray);
                    hits += expected.valid();
                    if (!(expected == found) && different++ == 0)
                        first = described(found) + ", expected " + described(expected);
                    // Skip rays in a triangle's plane: the computed distance of an edge-on triangle may be in front
                    // of the triangle, so a ray that ends there may miss it.
                    if (trial % 5 == 1) continue;
                    Hit end;
                    end.t = expected.valid() ? expected.t : std::numeric_limits<float>::max();
                    wrong_shadows += accelerator.occluded(ray, end) != expected.valid();
                    if (expected.valid()) wrong_shadows += accelerator.occluded(ray, expected);
                }
                CHECK(hits > 800);
                CHECK_MESSAGE(different == 0, first);
                CHECK(wrong_shadows == 0);
            }
    }
}
