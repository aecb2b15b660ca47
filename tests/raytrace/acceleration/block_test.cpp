// These tests check that intersecting all primitives of a block at once gives the same hits as intersecting them one
// by one, bit for bit, and misses none.
#include "raytrace/acceleration/accelerator.h"
#include "raytrace/acceleration/bvh_block.h"
#include "raytrace/acceleration/bvh_spheres.h"
#include "tests/raytrace/acceleration/soup.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <optional>

using namespace duet;
using namespace duet::raytrace;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kScales[] = {1e-6f, 1.0f, 1e6f};
constexpr float kShifts[] = {0.0f, 1.0f, 1000.0f}; // distance of the block from the origin, relative to its scale

bool same(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }

bool same(const std::optional<TriangleHit>& a, const std::optional<TriangleHit>& b) {
    return a.has_value() == b.has_value() && (!a || (same(a->t, b->t) && same(a->u, b->u) && same(a->v, b->v)));
}

float signed_zero(Random& random) { return random.below(2) != 0 ? 0.0f : -0.0f; }

Vec3 along_axis(Random& random) {
    Vec3 d(signed_zero(random), signed_zero(random), signed_zero(random));
    d[static_cast<std::size_t>(random.below(3))] = random.below(2) != 0 ? 1.0f : -1.0f;
    return d;
}

// Returns the vertices of a triangle or a quad. Most are ordinary; some are in an axis-aligned plane, needles, or
// without area.
template <std::size_t kCorners> std::array<Vec3, kCorners> polygon(Random& random, float scale, Vec3 offset) {
    const Vec3 a = offset + random.vector() * scale;
    Vec3 u = random.vector() * scale, v = random.vector() * scale;
    switch (random.below(8)) {
    case 0:
        u[2] = v[2] = 0;
        break;
    case 1:
        u = {u.x, 0, 0}, v = {0, v.y, 0};
        break;
    case 2:
        v = v * 1e-5f;
        break;
    case 3:
        v = u * random.uniform();
        break;
    default:
        break;
    }
    const std::array<Vec3, 4> p = corners(Quad{a, u, v});
    if constexpr (kCorners == 4)
        return p;
    else
        return {p[0], p[1], p[3]};
}

// Returns a difficult ray: at the polygon's interior, edges and vertices, at a quad's diagonal, in its plane, away
// from it, or along the axes.
template <std::size_t kCorners> Ray polygon_ray(Random& random, const std::array<Vec3, kCorners>& p, float scale) {
    const std::size_t i = static_cast<std::size_t>(random.below(kCorners));
    const Vec3 a = p[i], b = p[(i + 1) % kCorners], c = p[(i + 2) % kCorners];
    const float s = random.uniform(0, 1), r = random.uniform(0, 1) * (1 - s);
    const Vec3 inside = a * (1 - s - r) + b * s + c * r;
    Ray ray;
    ray.origin = inside + random.vector() * scale;
    switch (random.below(7)) {
    case 0:
        ray.direction = inside - ray.origin;
        break;
    case 1:
        ray.direction = (random.below(2) != 0 ? a : lerp(a, b, s)) - ray.origin;
        break;
    case 2: // a quad's diagonal: the one that splits it, or the other one
        ray.direction = lerp(a, c, s) - ray.origin;
        break;
    case 3: // away from the polygon, or through it and beyond
        ray.origin = inside;
        ray.direction = random.direction();
        break;
    case 4:
        ray.origin = a;
        ray.direction = lerp(b, c, s) - a;
        break;
    case 5:
        ray.direction = along_axis(random);
        ray.origin = (random.below(2) != 0 ? a : inside) - ray.direction * scale;
        break;
    default:
        ray.direction = random.direction();
    }
    if (max_component(abs(ray.direction)) > 0 && random.below(2) != 0) ray.direction = normalize_scaled(ray.direction);
    if (!(max_component(abs(ray.direction)) > 0)) ray.direction = {0, 0, 1};
    return ray;
}

struct Counts {
    int certain = 0, needs_distance = 0, rest = 0, hits = 0, wrong = 0;
};

// Returns the block test's result for a lane. Where the block test is uncertain, the exact test decides.
template <std::size_t kCorners>
std::optional<TriangleHit> said(BlockTest<kCorners> test, const PolygonBlock<kCorners>& block, const ShearedRay& ray,
                                std::size_t lane, Counts& counts) {
    const auto has = [lane](unsigned lanes) { return (lanes >> lane & 1) != 0; };
    if (!has(test.candidates())) return std::nullopt;
    ++(has(test.certain()) ? counts.certain : has(test.needs_distance()) ? counts.needs_distance : counts.rest);
    if (test.needs_distance() != 0) test.compute_distances(ray, block);
    if (!has(test.certain())) return exact_hit(ray, block, lane);
    const Lanes t(test.t()), u(test.u()), v(test.v());
    const TriangleHit hit{t[lane], u[lane], v[lane]};
    if (!(hit.t > ray.t_min && hit.t <= ray.t_max)) return std::nullopt;
    return hit;
}

std::optional<TriangleHit> one_by_one(const ShearedRay& ray, const std::array<Vec3, 3>& p) {
    return intersect_triangle(ray, p[0], p[1], p[2]);
}
std::optional<TriangleHit> one_by_one(const ShearedRay& ray, const std::array<Vec3, 4>& p) {
    return intersect_quad(ray, p);
}

template <std::size_t kCorners> Counts polygons(float scale, float shift, int trials) {
    Random random(23);
    Counts counts;
    const Vec3 offset = Vec3(1, -0.5f, 0.25f) * (shift * scale);
    for (int trial = 0; trial < trials; ++trial) {
        PolygonBlock<kCorners> block;
        std::array<Vec3, kCorners> absent;
        absent.fill({kNaN, kNaN, kNaN});
        const auto present = static_cast<std::size_t>(1 + random.below(kBlockSize));
        for (std::size_t lane = 0; lane < kBlockSize; ++lane)
            block.set(lane, lane < present ? polygon<kCorners>(random, scale, offset) : absent, 0, 0);
        const auto aimed_at = static_cast<std::size_t>(random.below(static_cast<int>(present)));
        Ray ray = polygon_ray(random, block.corners(aimed_at), scale);
        if (trial % 3 == 0) // t_max equals the hit's distance, which still counts as a hit
            if (const auto hit = one_by_one(ShearedRay(ray), block.corners(aimed_at))) ray.t_max = hit->t;
        if (trial % 3 == 1) ray.t_max = random.uniform(0, 2) * scale / length(ray.direction);
        const ShearedRay sheared(ray);
        const BlockTest<kCorners> test(sheared.shear, block, ray.t_max);
        for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
            const auto expected = one_by_one(sheared, block.corners(lane));
            counts.hits += expected.has_value();
            counts.wrong += !same(said(test, block, sheared, lane, counts), expected);
        }
    }
    return counts;
}

// Returns rays at and beside the sphere: from far away, from its surface, from its interior and its exact center, and
// tangents.
Ray sphere_ray(Random& random, const Sphere& s) {
    const Vec3 n = random.direction();
    const Vec3 tangent = normalize(cross(n, random.direction()));
    Ray ray;
    switch (random.below(7)) {
    case 0:
        ray.origin = s.center + n * (s.radius * std::pow(10.0f, random.uniform(0, 6)));
        ray.direction = normalize_scaled(s.center + random.vector() * (s.radius * 1.5f) - ray.origin);
        break;
    case 1: // tangent up to rounding
        ray.direction = tangent;
        ray.origin = s.center + n * s.radius - tangent * (s.radius * random.uniform(0, 100));
        break;
    case 2:
        ray.origin = s.center + n * s.radius;
        ray.direction = random.direction();
        break;
    case 3: // along the surface
        ray.origin = s.center + n * s.radius;
        ray.direction = normalize(tangent + n * (random.uniform() * 1e-4f));
        break;
    case 4: // b = 0
        ray.origin = s.center;
        ray.direction = random.below(2) != 0 ? along_axis(random) : n;
        break;
    case 5:
        ray.origin = s.center + random.vector() * s.radius;
        ray.direction = along_axis(random);
        break;
    default:
        ray.origin = s.center + random.vector() * (s.radius * 3);
        ray.direction = random.vector() * random.uniform(0.01f, 10); // any length
        if (!(max_component(abs(ray.direction)) > 0)) ray.direction = n;
    }
    return ray;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE_TEMPLATE("triangles and quads of a block are hit as one by one, to the bit", Corners,
                       std::integral_constant<std::size_t, 3>, std::integral_constant<std::size_t, 4>) {
        for (const float scale : kScales)
            for (const float shift : kShifts) {
                CAPTURE(scale);
                CAPTURE(shift);
                const Counts counts = polygons<Corners::value>(scale, shift, 160000 / static_cast<int>(kBlockSize));
                CHECK(counts.wrong == 0);
                // The random rays must cover every result of the block test.
                CHECK(counts.hits > 5000);
                CHECK(counts.certain > 2000);
                CHECK(counts.needs_distance > 500);
                CHECK(counts.rest > 500);
            }
    }

    TEST_CASE("few rays are left to the exact tests") {
        // The rays and quads are random, none near the origin.
        Random random(29);
        int candidates = 0, certain = 0;
        for (int trial = 0; trial < 160000 / static_cast<int>(kBlockSize); ++trial) {
            QuadBlock block;
            for (std::size_t lane = 0; lane < kBlockSize; ++lane)
                block.set(lane, corners(Quad{random.vector(), random.vector(), random.vector()}), 0, 0);
            const Vec3 origin = random.direction() * 9.0f;
            const Ray ray{origin, normalize(random.vector() - origin)};
            const BlockTest<4> test(ShearedRay(ray).shear, block, kInfinity);
            candidates += std::popcount(test.candidates());
            certain += std::popcount(test.certain());
        }
        CHECK(candidates > 5000);
        CHECK(candidates - certain < candidates / 10); // mostly needles, as viewed from the origin
    }

    TEST_CASE("spheres of a block are hit as one by one, to the bit") {
        for (const float scale : kScales)
            for (const float shift : kShifts) {
                CAPTURE(scale);
                CAPTURE(shift);
                Random random(31);
                const Vec3 offset = Vec3(1, -0.5f, 0.25f) * (shift * scale);
                int hits = 0, wrong = 0;
                for (int trial = 0; trial < 160000 / static_cast<int>(kBlockSize); ++trial) {
                    SphereBlock block;
                    const auto present = static_cast<std::size_t>(1 + random.below(kBlockSize));
                    for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
                        const float radius = scale * std::pow(10.0f, random.uniform(-4, 2));
                        if (lane < present)
                            block.set(lane, {offset + random.vector() * scale, radius}, 0);
                        else
                            block.set(lane, {{kNaN, kNaN, kNaN}, kNaN}, 0);
                    }
                    const auto aimed_at = static_cast<std::size_t>(random.below(static_cast<int>(present)));
                    Ray ray = sphere_ray(random, block.sphere(aimed_at));
                    if (trial % 3 == 0)
                        if (const auto t = intersect_sphere(ray, block.sphere(aimed_at))) ray.t_max = *t;
                    if (trial % 3 == 1) ray.t_min = random.uniform(0, 1) * scale;
                    const SphereBlockTest test(SphereRay(ray), block, ray.t_max);
                    for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
                        const auto expected = intersect_sphere(ray, block.sphere(lane));
                        const bool hit = (test.hits() >> lane & 1) != 0;
                        hits += expected.has_value();
                        wrong += hit != expected.has_value() || (hit && !same(test.t(lane), *expected));
                    }
                }
                CHECK(wrong == 0);
                CHECK(hits > 10000);
            }
    }

    TEST_CASE("a sphere is hit by many rays as by each, to the bit; those left out surely miss it") {
        constexpr std::size_t kRays = kMaxSimdLanes;
        using Batch = FloatBatch<kRays>;
        for (const float scale : kScales)
            for (const float shift : kShifts) {
                CAPTURE(scale);
                CAPTURE(shift);
                Random random(43);
                const Vec3 offset = Vec3(1, -0.5f, 0.25f) * (shift * scale);
                int hits = 0, wrong = 0, misses = 0, left_out = 0;
                for (int trial = 0; trial < 60000 / static_cast<int>(kRays); ++trial) {
                    const Sphere sphere{offset + random.vector() * scale,
                                        scale * std::pow(10.0f, random.uniform(-4, 2))};
                    const Sphere beside{sphere.center + random.vector() * (4 * sphere.radius), sphere.radius};
                    std::array<Ray, kRays> rays;
                    alignas(64) LineLanes<kRays> lines;
                    alignas(64) std::array<float, kRays> t_min, ends;
                    for (std::size_t i = 0; i < kRays; ++i) {
                        Ray& ray = rays[i] = sphere_ray(random, i % 2 == 0 ? sphere : beside);
                        if (i % 3 == 0)
                            if (const auto t = intersect_sphere(ray, sphere)) ray.t_max = *t;
                        if (i % 3 == 1) ray.t_min = random.uniform(0, 1) * scale;
                        if (i % 5 == 4) ray.direction = ray.direction * std::pow(10.0f, random.uniform(-15, 15));
                        for (std::size_t axis = 0; axis < 3; ++axis)
                            lines[axis][i] = ray.origin[axis], lines[3 + axis][i] = ray.direction[axis];
                        t_min[i] = ray.t_min, ends[i] = ray.t_max;
                    }
                    const unsigned candidates = SphereFilter(lines).may_hit(sphere);
                    const SphereRaysTest test(lines, candidates, sphere, Batch::load_aligned(t_min.data()),
                                              Batch::load_aligned(ends.data()));
                    const Lanes t(test.t());
                    for (std::size_t i = 0; i < kRays; ++i) {
                        const auto expected = intersect_sphere(rays[i], sphere);
                        const bool hit = (test.hits() >> i & 1) != 0;
                        (expected ? hits : misses)++;
                        left_out += (candidates >> i & 1) == 0;
                        wrong += hit != expected.has_value() || (hit && !same(t[i], *expected));
                    }
                }
                CHECK(wrong == 0);
                CHECK(hits > 5000);
                CHECK(left_out > misses / 4); // of the rays that miss the sphere
            }
    }

    TEST_CASE("few primitives are a list, many a tree; both are hit as by testing every primitive") {
        Random random(37);
        int lists = 0, trees = 0;
        for (int count = 1; count <= 160; count += count < 20 ? 1 : 20) {
            SceneBuilder builder;
            const std::uint32_t grey = builder.material(Diffuse{});
            for (int i = 0; i < count; ++i) {
                const Vec3 p = random.vector(), u = random.vector(), v = random.vector();
                if (i % 3 == 0)
                    builder.add(quad(p, u, v), grey);
                else if (i % 3 == 1)
                    builder.add(Sphere{p, random.uniform(0.01f, 0.3f)}, grey);
                else
                    builder.add(Mesh{.positions = {p, p + u, p + v},
                                     .normals = {},
                                     .uvs = {},
                                     .triangles = {{0, 1, 2}},
                                     .material_slots = {}},
                                grey);
            }
            const Scene scene = builder.finish();
            const Accelerator accelerator(scene, 1);
            CAPTURE(count);
            (accelerator.world().use_tree() ? trees : lists)++;
            CHECK((count > 1) == !accelerator.world().nodes.empty());
            for (int trial = 0; trial < 200; ++trial) {
                const Ray ray{random.vector() * 3.0f, random.direction()};
                const Hit expected = brute_force_hit(scene, ray);
                CHECK(accelerator.closest(ray) == expected);
                Hit end;
                end.t = 5;
                CHECK(accelerator.occluded(ray, end) == (expected.t < 5));
                if (expected.valid()) CHECK(!accelerator.occluded(ray, expected));
            }
        }
        CHECK(lists > 10);
        CHECK(trees > 3);
    }
}
