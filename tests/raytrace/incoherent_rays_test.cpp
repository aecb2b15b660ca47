// These tests trace batches of incoherent rays among few and many spheres. The hits must equal those of single rays,
// bit for bit.
#include "raytrace/render.h"
#include "raytrace/render_pass.h"

#include "common/sampling/warp.h"
#include "raytrace/acceleration/accelerator.h"
#include "raytrace/sampling/sampler.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

#include <limits>
#include <numeric>
#include <vector>

using namespace duet;
using namespace duet::raytrace;

namespace {

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN(),
                kInfinite = std::numeric_limits<float>::infinity();

struct Placement {
    float scale = 1;
    Vec3 at{0, 0, 0};
    Vec3 operator()(Vec3 p) const { return p * scale + at; }
};

class RandomNumbers {
public:
    explicit RandomNumbers(int stream) : sampler_(SamplerKind::kIndependent, 11, 1), stream_(stream) {}
    void start(int i) { sampler_.start(i, stream_, 0); }
    float one() { return sampler_.get_2d().x; }
    Vec2 two() { return sampler_.get_2d(); }
    Vec3 in_cube() { // of side 2 around the origin
        const Vec2 u = two();
        return Vec3(2 * u.x - 1, 2 * u.y - 1, 2 * one() - 1);
    }
    Vec3 direction() { return uniform_sphere(two()); }

private:
    Sampler sampler_;
    int stream_;
};

// Returns small, tiny and giant spheres, some of them duplicates and some concentric.
std::vector<Sphere> spheres_of_all_sizes(int count, const Placement& place, int seed) {
    RandomNumbers numbers(seed);
    std::vector<Sphere> spheres;
    for (int i = 0; i < count; ++i) {
        numbers.start(i);
        const Vec3 center = place(numbers.in_cube());
        float radius = (0.05f + 0.1f * numbers.one()) * place.scale;
        if (i % 17 == 0) radius *= 1e-6f;
        if (i % 71 == 0) radius *= 1e6f;
        if (i % 29 == 0) radius *= 10;
        Sphere sphere{center, radius};
        if (i % 13 == 5) sphere = spheres.back();
        if (i % 19 == 5) sphere.center = spheres.back().center;
        spheres.push_back(sphere);
    }
    return spheres;
}

// Returns rays from any point and from the spheres, many of them toward other spheres, with every kind of float value
// that a ray may have.
std::vector<Ray> rays_among(const std::vector<Sphere>& spheres, int count, const Placement& place, int seed) {
    RandomNumbers numbers(seed);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        numbers.start(i);
        const auto sphere = [&](int k) { return spheres[static_cast<std::size_t>(k) % spheres.size()]; };
        Ray ray{place(numbers.in_cube() * 1.5f), numbers.direction()};
        if (i % 3 == 0) ray.origin = sphere(i).center + numbers.direction() * sphere(i).radius;
        if (i % 4 == 0) {
            const Vec3 to = sphere(7 * i).center + numbers.direction() * sphere(7 * i).radius - ray.origin;
            if (max_component(abs(to)) > 0) ray.direction = normalize(to);
        }
        const float sign = i % 2 == 0 ? 1.0f : -1.0f;
        if (i % 5 == 0) ray.direction = Vec3(sign, -0.0f, 0);
        if (i % 7 == 0) ray.t_max = 3 * place.scale * numbers.one();
        if (i % 11 == 0) ray.t_min = place.scale * numbers.one();
        if (i % 13 == 0) ray.direction = ray.direction * (i % 2 == 0 ? 1e12f : 1e-12f);
        if (i % 101 == 0) ray.direction = ray.direction * 1e-37f;
        if (i % 103 == 0) ray.direction = ray.direction * 1e36f;
        if (i % 31 == 30) ray.direction = {};
        if (i % 37 == 36) ray.t_max = kNotANumber;
        if (i % 41 == 40) ray.t_min = kNotANumber;
        if (i % 43 == 42) ray.direction.y = kNotANumber;
        if (i % 47 == 46) ray.origin.z = kInfinite;
        if (i % 53 == 52) ray.t_max = -1;
        if (i % 59 == 58) ray.t_max = 0;
        if (i % 61 == 60) ray.direction.x = -0.0f;
        if (i % 67 == 66) ray.t_min = kInfinite;
        if (i % 71 == 70) ray.direction = Vec3(1e-44f, 1, 1e-39f);
        if (i % 73 == 72) ray.origin = ray.origin * 1e20f;
        rays.push_back(ray);
    }
    return rays;
}

std::vector<std::uint32_t> every(std::size_t count, std::size_t step = 1) {
    std::vector<std::uint32_t> which;
    for (std::size_t i = 0; i < count; i += step) which.push_back(static_cast<std::uint32_t>(i));
    return which;
}

// Returns how many rays hit anything. Rays that are not listed must keep their hits, and stale hits of listed rays
// must be overwritten.
int check_hits(const Accelerator& accelerator, const std::vector<Ray>& rays, const std::vector<std::uint32_t>& which) {
    Hit stale;
    stale.object = 5;
    stale.t = 1e-9f;
    std::vector<Hit> hits(rays.size(), stale);
    accelerator.closest_of_incoherent(rays, which, hits);
    std::vector<Hit> expected(rays.size(), stale);
    int found = 0;
    for (const std::uint32_t i : which) {
        expected[i] = accelerator.closest(rays[i]);
        found += expected[i].valid();
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
        CAPTURE(i);
        REQUIRE(hits[i] == expected[i]);
    }
    return found;
}

void add_all(SceneBuilder& builder, const std::vector<Sphere>& spheres, std::uint32_t material) {
    for (const Sphere& sphere : spheres) builder.add(sphere, material);
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("batched rays among spheres hit what each alone does, at every scale and far from the origin") {
        const Placement places[] = {{1, {}},
                                    {1e-6f, {}},
                                    {1e6f, {}},
                                    {1e-3f, {1, 2, 3}},
                                    {1, {1e4f, -1e4f, 5e3f}},
                                    {1e-6f, {3, -3, 1.5f}},
                                    {1e3f, {1e7f, -1e7f, 5e6f}}};
        int seed = 0, lists = 0;
        for (const Placement& place : places)
            for (const int count : {8, 40, 300}) {
                CAPTURE(place.scale);
                CAPTURE(count);
                ++seed;
                SceneBuilder builder;
                const std::uint32_t white = builder.material(Diffuse{{Rgb(0.7f)}});
                const auto spheres = spheres_of_all_sizes(count, place, seed);
                add_all(builder, spheres, white);
                const float s = place.scale;
                if (seed % 2 == 0) builder.add(quad(place({-1, -1, 0}), {s, 0, 0}, {0, s, 0}), white);
                if (seed % 3 == 0) builder.add(icosphere(0, 0.4f * s, place.at, true), white);
                const Scene scene = builder.finish();
                const PathTracerScene prepared = prepare(scene, PathTracerSettings());
                const Accelerator& accelerator = prepared.data().accelerator;
                lists += accelerator.few_primitives();
                const auto rays = rays_among(spheres, 3000, place, seed + 100);
                CHECK(check_hits(accelerator, rays, every(rays.size())) > 300);
            }
        CHECK(lists > 3);
        CHECK(lists < 18);
    }

    TEST_CASE("and in any number, some of a list or none") {
        const auto spheres = spheres_of_all_sizes(12, {}, 1);
        SceneBuilder builder;
        add_all(builder, spheres, builder.material(Diffuse{{Rgb(0.7f)}}));
        const Scene scene = builder.finish();
        const PathTracerScene prepared = prepare(scene, PathTracerSettings());
        const Accelerator& accelerator = prepared.data().accelerator;
        REQUIRE(accelerator.few_primitives());
        int found = 0;
        for (int count = 0; count < 300; count = count < 70 ? count + 1 : 2 * count) {
            CAPTURE(count);
            const auto rays = rays_among(spheres, count, {}, 1000 + count);
            found += check_hits(accelerator, rays, every(rays.size()));
            check_hits(accelerator, rays, every(rays.size(), 3));
        }
        CHECK(found > 500);
        check_hits(accelerator, rays_among(spheres, 50, {}, 7), {});
    }

    TEST_CASE("and through holes") {
        SceneBuilder builder;
        const std::uint32_t white = builder.material(Diffuse{{Rgb(0.7f)}});
        const auto spheres = spheres_of_all_sizes(150, {}, 2);
        add_all(builder, spheres, white);
        const std::uint32_t fence = builder.material(Diffuse{{Rgb(0.7f)}});
        SurfaceMaps half_open;
        half_open.opacity = 0.5f;
        builder.scene.maps = {SurfaceMaps{}, half_open};
        for (const float z : {-0.6f, 0.0f, 0.6f}) builder.add(quad(Vec3(-2, -2, z), {4, 0, 0}, {0, 4, 0}), fence);
        const Scene scene = builder.finish();
        REQUIRE(scene.needs.alpha);
        const PathTracerScene prepared = prepare(scene, PathTracerSettings());
        const auto rays = rays_among(spheres, 2000, {}, 8);
        CHECK(check_hits(prepared.data().accelerator, rays, every(rays.size())) > 300);
    }
}
