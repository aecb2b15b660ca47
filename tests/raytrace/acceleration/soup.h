// This header provides random scenes of all primitive types, difficult rays, and the hit that brute force finds.
#pragma once

#include "common/geometry/quad.h"
#include "common/geometry/sphere.h"
#include "common/system/error.h"
#include "compare/stress/accelerated_scene.h"
#include "raytrace/acceleration/bvh_leaf.h"
#include "tests/raytrace/scene_builder.h"

#include <random>
#include <string>

namespace duet::raytrace {

struct Random {
    std::mt19937 engine;
    explicit Random(unsigned seed) : engine(seed) {}
    float uniform(float low = -1, float high = 1) { return std::uniform_real_distribution<float>(low, high)(engine); }
    int below(int n) { return static_cast<int>(engine() % static_cast<unsigned>(n)); }
    Vec3 vector() {
        const float x = uniform(), y = uniform();
        return {x, y, uniform()};
    }
    Vec3 direction() {
        for (;;) {
            const Vec3 v = vector();
            if (length_squared(v) > 0.01f && length_squared(v) <= 1) return normalize(v);
        }
    }
};

using compare::brute_force_hit;

struct Soup {
    Random random;
    float scale;
    Vec3 offset;

    Vec3 point() { return offset + random.vector() * scale; }

    Mesh triangles(int count, float size) {
        Mesh mesh;
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
            const Vec3 p = point();
            for (int k = 0; k < 3; ++k) mesh.positions.push_back(p + random.vector() * (scale * size));
            mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        // The mesh includes duplicates, for ties, and axis-aligned triangles, whose boxes are flat.
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count) / 8; ++i)
            mesh.triangles.push_back(mesh.triangles[i]);
        for (int i = 0; i < count / 8; ++i) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            const auto axis = static_cast<std::size_t>(i % 3);
            Vec3 p = point();
            for (int k = 0; k < 3; ++k) {
                Vec3 q = p + random.vector() * (scale * size);
                q[axis] = p[axis];
                mesh.positions.push_back(q);
            }
            mesh.triangles.push_back({first, first + 1, first + 2});
        }
        return mesh;
    }

    Scene scene(bool with_instances) {
        SceneBuilder builder;
        const std::uint32_t grey = builder.material(Diffuse{});
        builder.add(triangles(120, 0.3f), grey);
        QuadList quads;
        for (int i = 0; i < 40; ++i) quads.quads.push_back({point(), random.vector() * scale, random.vector() * scale});
        for (std::size_t i = 0; i < 5; ++i) quads.quads.push_back(quads.quads[i]);
        builder.add(quads, grey);
        builder.add(box_quads(offset - Vec3(0.5f, 0.5f, 0.5f) * scale, offset + Vec3(0.5f, 0.25f, 0.5f) * scale), grey);
        for (int i = 0; i < 40; ++i) builder.add(Sphere{point(), scale * random.uniform(0.01f, 0.3f)}, grey);
        builder.add(builder.scene.shapes[4], grey); // a duplicate of a sphere
        if (with_instances) {
            const Soup own{random, 1, {}};
            const std::uint32_t mesh = builder.shape(Soup(own).triangles(30, 0.5f));
            const std::uint32_t sphere = builder.shape(Sphere{{0.2f, 0, 0}, 0.5f});
            for (int i = 0; i < 12; ++i) {
                const auto placed = [&] {
                    return translation(point()) * rotation(random.direction(), random.uniform(0, 6)) *
                           scaling(Vec3(1, random.uniform(-1, -0.5f), 0.5f) * (scale * random.uniform(0.1f, 0.5f)));
                };
                const Mat4 begin = placed();
                builder.place_moving(i % 2 ? mesh : sphere, grey, begin,
                                     i % 4 < 2 ? begin : translation(random.vector() * scale) * begin);
            }
        }
        return builder.finish();
    }

    // Returns random rays, rays at vertices, and rays along the axes with zeros of both signs, from points that share
    // coordinates with the scene.
    Ray ray(const Scene& scene, int trial) {
        const auto& positions = std::get<Mesh>(scene.shapes[0]).positions;
        const Vec3 vertex = positions[static_cast<std::size_t>(random.below(static_cast<int>(positions.size())))];
        Ray ray;
        ray.time = random.uniform(0, 1);
        ray.origin = trial % 2 ? point() : offset + random.direction() * (scale * 4);
        switch (trial % 4) {
        case 0:
            ray.direction = random.direction();
            break;
        case 1:
            ray.direction = normalize(vertex - ray.origin);
            break;
        default: {
            const auto axis = static_cast<std::size_t>(random.below(3));
            const float zero = random.below(2) ? 0.0f : -0.0f;
            ray.direction = {zero, -zero, zero};
            if (trial % 4 == 3) ray.direction[(axis + 1) % 3] = random.uniform();
            ray.direction[axis] = random.below(2) ? 1.0f : -1.0f;
            ray.origin = vertex - ray.direction * scale;
        }
        }
        return ray;
    }
};

inline std::string described(const Hit& hit) {
    return message("object ", hit.object, " primitive ", hit.primitive, " t ", hit.t, " u ", hit.u, " v ", hit.v);
}

} // namespace duet::raytrace
