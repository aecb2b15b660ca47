// These tests intersect rays with triangles, quads and spheres. Intersection must be watertight, symmetric, and
// accurate from tiny to huge sizes.
#include "common/geometry/quad.h"
#include "common/geometry/shape.h"
#include "common/geometry/sphere.h"
#include "common/geometry/surface_point.h"
#include "common/geometry/triangle.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

using namespace duet;

namespace {

struct Random {
    std::mt19937 engine{12345};
    float uniform(float low = -1, float high = 1) { return std::uniform_real_distribution<float>(low, high)(engine); }
    Vec3 vector() { return {uniform(), uniform(), uniform()}; }
};

Ray toward(Vec3 origin, Vec3 target) { return {origin, normalize(target - origin)}; }

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a fan of triangles around a vertex lets no ray aimed at the vertex or a spoke through") {
        Random random;
        int leaks = 0;
        for (int trial = 0; trial < 20000; ++trial) {
            const float scale = std::exp(random.uniform(-12, 12));
            const Vec3 hub = random.vector() * scale + random.vector() * (trial % 2 ? 100 * scale : 0.0f);
            const Vec3 eye = hub + Vec3(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(1, 9)) * scale;
            constexpr int kSpokes = 7;
            std::array<Vec3, kSpokes> rim;
            for (int i = 0; i < kSpokes; ++i) {
                const float angle = 2 * kPi * (static_cast<float>(i) + random.uniform(0, 0.9f)) / kSpokes;
                rim[static_cast<std::size_t>(i)] =
                    hub + Vec3(std::cos(angle), std::sin(angle), random.uniform(-0.3f, 0.3f)) * scale;
            }
            const Vec3 on_spoke = lerp(hub, rim[static_cast<std::size_t>(trial % kSpokes)], random.uniform(0, 0.5f));
            const ShearedRay ray(toward(eye, trial % 3 ? on_spoke : hub));
            bool hit = false;
            for (std::size_t i = 0; i < kSpokes; ++i)
                hit = hit || intersect_triangle(ray, hub, rim[i], rim[(i + 1) % kSpokes]).has_value();
            leaks += hit ? 0 : 1;
        }
        CHECK(leaks == 0);
    }

    TEST_CASE("triangle hits agree with a double-precision plane, at all scales") {
        Random random;
        int tried = 0, hits = 0;
        for (int trial = 0; trial < 20000; ++trial) {
            const float scale = std::pow(10.0f, random.uniform(-6, 6));
            const Vec3 a = random.vector() * scale, b = random.vector() * scale, c = random.vector() * scale;
            const float u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
            const Vec3 target = a * (1 - u - v) + b * u + c * v;
            const Vec3d n = cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
            const Ray ray = toward(random.vector() * (3 * scale), target);
            const Vec3d d(ray.direction);
            const double cosine = dot(n, d) / length(n);
            if (std::abs(cosine) < 1e-3 || length(n) < 1e-3 * static_cast<double>(scale) * static_cast<double>(scale))
                continue;
            ++tried;
            const auto hit = intersect_triangle(ShearedRay(ray), a, b, c);
            if (!hit) continue; // rounding may have moved the target out of the triangle; the fan test covers leaks
            ++hits;
            const double exact = dot(n, Vec3d(a) - Vec3d(ray.origin)) / dot(n, d);
            CHECK(std::abs(static_cast<double>(hit->t) - exact) * std::abs(cosine) <= 2e-6 * std::abs(exact));
            CHECK(std::abs(hit->u - u) < 1e-3f);
            CHECK(std::abs(hit->v - v) < 1e-3f);
        }
        CHECK(hits > 0.9 * tried);
    }

    TEST_CASE("the distance is within its error bound of a double-precision plane's, for rays of any length") {
        Random random;
        std::array<int, 13> tried{}; // indexed by the decimal exponent of the length, from −6 to 6
        double worst = 0;
        for (int trial = 0; trial < 400000; ++trial) {
            const float scale = std::pow(10.0f, random.uniform(-3, 3)), away = trial % 3 ? 1.0f : 30.0f;
            const Vec3 a = random.vector() * scale, b = random.vector() * scale;
            // Every other triangle is thin, as seen from any direction. Thin triangles make the bound tight or make
            // it give up.
            const Vec3 c = trial % 2 ? random.vector() * scale
                                     : lerp(a, b, random.uniform(0, 1)) + random.vector() * (scale * 1e-2f);
            const float u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
            const Vec3 target = a * (1 - u - v) + b * u + c * v, origin = random.vector() * (away * scale);
            const int power = trial % 13 - 6;
            const Ray ray{origin, normalize(target - origin) * std::pow(10.0f, static_cast<float>(power))};
            const ShearedRay sheared(ray);
            const TriangleTest<float> test(sheared.shear, a, b, c);
            const float low = min(min(test.e0, test.e1), test.e2), high = max(max(test.e0, test.e1), test.e2);
            if (!(low > 0 || high < 0)) continue;
            const float inv_det = 1 / test.det();
            if (test.is_needle(inv_det, sheared.shear.depth_per_t)) continue;
            const Vec3d n = cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
            const double exact = dot(n, Vec3d(a) - Vec3d(origin)) / dot(n, Vec3d(ray.direction));
            const double error = std::abs(static_cast<double>(test.distance(inv_det)) - exact);
            worst = max(worst, error / static_cast<double>(test.distance_error(inv_det, sheared.shear.depth_per_t)));
            ++tried[static_cast<std::size_t>(power + 6)];
        }
        CHECK(worst <= 1);
        CHECK(worst > 0.01); // the bound is not trivially loose
        for (const int count : tried) CHECK(count > 10000);
    }

    TEST_CASE("a ray of any length finds the very triangles that one of length 1 does, or touches them") {
        Random random;
        for (int trial = 0; trial < 20000; ++trial) {
            const Vec3 a = random.vector(), b = random.vector(), c = random.vector();
            const Ray unit = toward(random.vector() * 3.0f, a * 0.3f + b * 0.3f + c * 0.4f);
            const auto expected = intersect_triangle(ShearedRay(unit), a, b, c);
            for (const int power : {-20, -10, 10, 20}) { // scaling by a power of two changes only the exponents
                Ray ray = unit;
                ray.direction = unit.direction * std::ldexp(1.0f, power);
                const auto found = intersect_triangle(ShearedRay(ray), a, b, c);
                REQUIRE(found.has_value() == expected.has_value());
                if (!found) continue;
                REQUIRE(found->t == std::ldexp(expected->t, -power));
                REQUIRE(found->u == expected->u);
                REQUIRE(found->v == expected->v);
            }
        }
    }

    TEST_CASE("a triangle seen almost edge-on is hit where it is, not far beside it in its plane") {
        Random random;
        int hits = 0;
        double worst = 0;
        for (int trial = 0; trial < 200000; ++trial) {
            const Vec3 origin = random.vector() * 3.0f, a = random.vector();
            const Vec3 along = normalize(a - origin), aside = normalize(cross(along, random.vector()));
            const Vec3 off = cross(along, aside) * (1e-5f * random.uniform());
            const Vec3 b = a + (along + aside * random.uniform() + off) * 0.03f, c = a + (along - aside + off) * 0.02f;
            const ShearedRay ray(toward(origin, a));
            const auto hit = intersect_triangle(ray, a, b, c);
            if (!hit) continue;
            ++hits;
            const Vec3d d(ray.direction);
            double low = std::numeric_limits<double>::infinity(), high = -low;
            for (const Vec3& p : {a, b, c}) {
                const double t = dot(Vec3d(p) - Vec3d(origin), d) / dot(d, d);
                low = min(low, t), high = max(high, t);
            }
            worst = max(worst, max(low - static_cast<double>(hit->t), static_cast<double>(hit->t) - high));
        }
        CHECK(hits > 1000);
        CHECK(worst < 4e-6); // a few rounding errors at distances up to 5
    }

    TEST_CASE("degenerate triangles and rays are missed, not hit at NaN") {
        const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
        const Ray down{{0.2f, 0.2f, 1}, {0, 0, -1}};
        CHECK(intersect_triangle(ShearedRay(down), a, b, c).has_value());
        CHECK_FALSE(intersect_triangle(ShearedRay(down), a, a, a).has_value());
        CHECK_FALSE(intersect_triangle(ShearedRay(down), a, b, b).has_value());
        CHECK_FALSE(intersect_triangle(ShearedRay({{0.2f, 0.2f, 1}, {0, 0, 0}}), a, b, c).has_value());
        CHECK_FALSE(intersect_triangle(ShearedRay({{0.2f, 0.2f, 1}, {NAN, 0, -1}}), a, b, c).has_value());
        CHECK_FALSE(intersect_triangle(ShearedRay({{-1, 0.2f, 0}, {1, 0, 0}}), a, b, c).has_value()); // edge-on
        const Ray minus_zero{{0.2f, 0.2f, 1}, {-0.0f, -0.0f, -1}};
        CHECK(intersect_triangle(ShearedRay(minus_zero), a, b, c).has_value());
    }

    TEST_CASE("what touches a surface ten kilometres wide is told from the surface itself") {
        Random random;
        const float half = 1e4f;
        const Quad ground{{-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half}};
        const Shape shape = QuadList{{ground}};
        for (int trial = 0; trial < 5000; ++trial) {
            const float height = std::pow(10.0f, random.uniform(-6, 1));
            const Vec3 above(random.uniform(-half, half) * 0.9f, height, random.uniform(-half, half) * 0.9f);
            const Vec3 down = normalize(Vec3(random.uniform(), -0.1f - std::abs(random.uniform()), random.uniform()));
            const auto hit = intersect_quad(ShearedRay({above, down}), ground);
            REQUIRE(hit.has_value());
            const double exact = -static_cast<double>(above.y) / static_cast<double>(down.y);
            CHECK(std::abs(static_cast<double>(hit->t) - exact) <= 4e-3); // rounding of the vertices' distances
            const SurfacePoint point =
                surface_point(shape, {0, 0, hit->u, hit->v, hit->t}, {above, down}, Mat4(), Mat4(), true);
            const Vec3 up(down.x, -down.y, down.z);
            CHECK_FALSE(intersect_quad(ShearedRay({offset_origin(point, up), up}), ground).has_value());
        }
    }

    TEST_CASE("triangles of the size of atoms and of galaxies are hit, at finite distances") {
        for (const float scale : {1e-15f, 1e-12f, 1e-6f, 1.0f, 1e6f, 1e12f, 1e15f, 1e17f}) {
            const auto hit = intersect_triangle(ShearedRay({Vec3(0.2f, 0.2f, 2) * scale, {0, 0, -1}}), Vec3(0, 0, 0),
                                                Vec3(1, 0, 0) * scale, Vec3(0, 1, 0) * scale);
            CAPTURE(scale);
            REQUIRE(hit.has_value());
            CHECK(hit->t == doctest::Approx(2 * scale).epsilon(1e-5));
            CHECK(hit->u == doctest::Approx(0.2).epsilon(1e-5));
        }
    }

    TEST_CASE("a quad's coordinates run along its edges, across both halves") {
        Random random;
        const Quad quad{{1, 2, 3}, {2, 0.5f, 0}, {-0.3f, 1, 1}};
        for (int trial = 0; trial < 2000; ++trial) {
            const float u = random.uniform(0.001f, 0.999f), v = random.uniform(0.001f, 0.999f);
            const Vec3 target = quad.corner + quad.u * u + quad.v * v;
            const auto hit = intersect_quad(ShearedRay(toward({0, 3, -8}, target)), quad);
            REQUIRE(hit.has_value());
            CHECK(hit->u == doctest::Approx(u).epsilon(1e-4));
            CHECK(hit->v == doctest::Approx(v).epsilon(1e-4));
        }
    }

    TEST_CASE("sphere hits lie on the sphere: far, huge and tiny ones, from outside and inside") {
        Random random;
        for (int trial = 0; trial < 20000; ++trial) {
            const float radius = std::pow(10.0f, random.uniform(-6, 6));
            const Sphere sphere{random.vector() * radius * 3.0f, radius};
            const float distance = std::pow(10.0f, random.uniform(0.1f, 4));
            const Vec3 eye = sphere.center + normalize(random.vector()) * (radius * distance);
            const Vec3 aim = sphere.center + random.vector() * (0.5f * radius);
            const Ray ray = toward(eye, aim);
            const auto t = intersect_sphere(ray, sphere);
            REQUIRE(t.has_value());
            const Vec3d p = Vec3d(ray.origin) + Vec3d(ray.direction) * static_cast<double>(*t);
            // t is rounded once, so the point may be off the sphere by half an ulp of t.
            const double off = std::abs(length(p - Vec3d(sphere.center)) - static_cast<double>(radius));
            CHECK(off <= 6.0e-8 * static_cast<double>(*t) + 1e-12 * static_cast<double>(radius));
            const auto from_inside = intersect_sphere(toward(aim, eye), sphere);
            CHECK(from_inside.has_value());
        }
    }

    TEST_CASE("a ray that leaves a sphere of radius 1000 from 1e-7 above it does not meet it again") {
        const Sphere ground{{0, -1000, 0}, 1000};
        CHECK_FALSE(intersect_sphere({{0, 1e-7f, 0}, normalize(Vec3(1, 1e-3f, 0))}, ground).has_value());
        CHECK(intersect_sphere({{0, 1e-7f, 0}, normalize(Vec3(1, -1e-3f, 0))}, ground).has_value());
    }

    TEST_CASE("texture coordinates on a sphere and in a lat-long sky, and their inverses") {
        CHECK(sphere_uv({0, 0, 1}).x == doctest::Approx(0.5f));
        CHECK(sphere_uv({1, 0, 0}).x == doctest::Approx(0.75f));
        CHECK(latlong_uv({0, 0, -1}).x == doctest::Approx(0.5f));
        CHECK(latlong_uv({1, 0, 0}).x == doctest::Approx(0.75f));
        for (const auto uv : {sphere_uv, latlong_uv}) {
            CHECK(uv({0, 1, 0}).y == doctest::Approx(1.0f));
            CHECK(uv({0, -1, 0}).y == doctest::Approx(0.0f));
        }
        Random random;
        for (int trial = 0; trial < 2000; ++trial) {
            const Vec3 n = normalize(random.vector());
            CHECK(length(sphere_direction(sphere_uv(n)) - n) < 1e-5f);
            CHECK(latlong_uv(n) == sphere_uv({n.x, n.y, -n.z}));
        }
    }

    // Text on a globe must be readable: for a viewer outside with v up, u increases to the right. So (∂p/∂u, ∂p/∂v,
    // n) is right-handed, as on a quad and on a mesh whose texture is not mirrored. A sky is viewed from the inside.
    TEST_CASE("a texture on a sphere is not mirrored, seen from outside; a sky is not, seen from inside") {
        Random random;
        const float step = 1e-3f;
        for (int trial = 0; trial < 2000; ++trial) {
            const Vec3 n = normalize(random.vector());
            if (std::abs(n.y) > 0.95f || (n.z < 0 && std::abs(n.x) < 0.05f)) continue; // near a pole or the seam
            const Vec3 right = normalize(cross(Vec3(0, 1, 0), n)); // for a viewer outside who looks along −n
            CHECK(sphere_uv(normalize(n + right * step)).x > sphere_uv(n).x);
            const Vec3 w = -n, right_inside = normalize(cross(w, Vec3(0, 1, 0)));
            if (w.z > 0 && std::abs(w.x) < 0.05f) continue; // the seam of the sky
            CHECK(latlong_uv(normalize(w + right_inside * step)).x > latlong_uv(w).x);

            const Sphere sphere{random.vector(), 2};
            const Ray ray{sphere.center + n * 5.0f, -n};
            const auto t = intersect_sphere(ray, sphere);
            REQUIRE(t.has_value());
            const SurfacePoint point = surface_point(Shape(sphere), Hit{0, 0, 0, 0, *t}, ray, Mat4(), Mat4(), true);
            CHECK(dot(cross(point.dpdu, point.dpdv), point.ng) > 0);
            // Finite differences of the position must agree with the derivatives.
            const Vec2 uv = point.uv;
            const float h = 1e-3f;
            const auto at = [&](Vec2 at_uv) { return sphere.center + sphere_direction(at_uv) * sphere.radius; };
            CHECK(length((at({uv.x + h, uv.y}) - at({uv.x - h, uv.y})) / (2 * h) - point.dpdu) < 0.02f);
            CHECK(length((at({uv.x, uv.y + h}) - at({uv.x, uv.y - h})) / (2 * h) - point.dpdv) < 0.02f);
        }
    }

    TEST_CASE("a ray spawned from any surface point does not hit that surface, at scales from 1e-6 to 1e6 and far from "
              "the origin") {
        Random random;
        int self_hits = 0;
        for (int trial = 0; trial < 30000; ++trial) {
            const float scale = std::pow(10.0f, random.uniform(-6, 6));
            const Vec3 away = random.vector() * (trial % 3 == 0 ? 1e3f * scale : 0.0f);
            Shape shape;
            if (trial % 3 == 0)
                shape = Sphere{away + random.vector() * scale, scale};
            else if (trial % 3 == 1)
                shape =
                    QuadList{{Quad{away + random.vector() * scale, random.vector() * scale, random.vector() * scale}}};
            else {
                Mesh mesh;
                mesh.positions = {away + random.vector() * scale, away + random.vector() * scale,
                                  away + random.vector() * scale};
                mesh.triangles = {{0, 1, 2}};
                shape = mesh;
            }
            Hit hit;
            hit.object = 0;
            hit.u = random.uniform(0, 1);
            hit.v = random.uniform(0, 1 - hit.u);
            Ray ray{away + random.vector() * (4 * scale), random.vector()};
            if (const auto* sphere = std::get_if<Sphere>(&shape)) {
                const auto t = intersect_sphere(ray, *sphere);
                if (!t) continue;
                hit.t = *t;
            }
            const SurfacePoint point = surface_point(shape, hit, ray, Mat4(), Mat4(), true);
            if (!is_finite(point.ng)) continue; // a degenerate triangle cannot be hit
            Vec3 w = normalize(random.vector());
            if (trial % 5 == 0) w = normalize(w - point.ng * (0.999f * dot(w, point.ng))); // grazing incidence
            if (std::holds_alternative<Sphere>(shape) && dot(w, point.ng) < 0)
                w = -w; // an inward ray correctly hits the far side
            const Ray spawned{offset_origin(point, w), w};
            bool again = false;
            if (const auto* sphere = std::get_if<Sphere>(&shape))
                again = intersect_sphere(spawned, *sphere).has_value();
            else if (const auto* list = std::get_if<QuadList>(&shape))
                again = intersect_quad(ShearedRay(spawned), list->quads[0]).has_value();
            else {
                const Mesh& mesh = std::get<Mesh>(shape);
                again = intersect_triangle(ShearedRay(spawned), mesh.positions[0], mesh.positions[1], mesh.positions[2])
                            .has_value();
            }
            self_hits += again ? 1 : 0;
        }
        CHECK(self_hits == 0);
    }

    TEST_CASE("a box has eight corners, whatever rounding does to its edges") {
        Random random;
        for (int trial = 0; trial < 1000; ++trial) {
            const Vec3 low = random.vector();
            const Vec3 high = low + Vec3(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)) * 3.0f;
            std::vector<Vec3> distinct;
            for (const Quad& quad : box_quads(low, high).quads)
                for (const Vec3& p : corners(quad))
                    if (std::find(distinct.begin(), distinct.end(), p) == distinct.end()) distinct.push_back(p);
            REQUIRE(distinct.size() == 8);
        }
    }

    TEST_CASE("closedness is judged by position, orientation by volume") {
        Mesh tetrahedron;
        tetrahedron.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
        CHECK(is_closed_outwards(tetrahedron));
        Mesh seamed = tetrahedron; // the last face uses its own vertices, at the same positions
        seamed.positions.insert(seamed.positions.end(), {{1, 0, 0}, {0, 1, 0}, {-0.0f, 0, 1}});
        seamed.triangles[3] = {4, 5, 6};
        CHECK(is_closed_outwards(seamed));
        Mesh open = tetrahedron;
        open.triangles.pop_back();
        CHECK_FALSE(is_closed_outwards(open));
        Mesh inside_out = tetrahedron;
        for (auto& t : inside_out.triangles) std::swap(t[1], t[2]);
        CHECK_FALSE(is_closed_outwards(inside_out));
        Mesh two_parts = tetrahedron; // a large outward-facing part and a small inside-out part beside it
        for (const Vec3& p : tetrahedron.positions) two_parts.positions.push_back(p * 0.5f + Vec3(3, 0, 0));
        for (const auto& t : tetrahedron.triangles) two_parts.triangles.push_back({t[0] + 4, t[2] + 4, t[1] + 4});
        CHECK_FALSE(is_closed_outwards(two_parts));
        Mesh one_flipped = tetrahedron;
        std::swap(one_flipped.triangles[0][0], one_flipped.triangles[0][1]);
        CHECK_FALSE(is_closed_outwards(one_flipped));
        Mesh doubled = tetrahedron; // each edge belongs to four triangles
        for (const auto& t : tetrahedron.triangles) doubled.triangles.push_back(t);
        CHECK_FALSE(is_closed_outwards(doubled));
        Mesh bicone; // two vertices with many edges
        constexpr std::uint32_t kSides = 1000;
        bicone.positions = {{0, 1, 0}, {0, -1, 0}};
        for (std::uint32_t i = 0; i < kSides; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i) / kSides;
            bicone.positions.emplace_back(std::cos(angle), 0.0f, -std::sin(angle));
            const std::uint32_t a = 2 + i, b = 2 + (i + 1) % kSides;
            bicone.triangles.push_back({0, a, b});
            bicone.triangles.push_back({1, b, a});
        }
        CHECK(is_closed_outwards(bicone));
    }

    TEST_CASE("bounds contain the surface points of a transformed shape") {
        Random random;
        for (int trial = 0; trial < 500; ++trial) {
            const Mat4 m = Mat4(translation(Vec3d(random.vector()) * 10.0) *
                                rotation(normalize(Vec3d(random.vector())), 2.0) * scaling(Vec3d(0.3, 1, 4)));
            const Shape shape = Sphere{random.vector(), 0.5f};
            const Box3 box = bounds(shape, m);
            for (int i = 0; i < 20; ++i) {
                const Sphere& s = std::get<Sphere>(shape);
                CHECK(box.contains(transform_point(m, s.center + normalize(random.vector()) * s.radius)));
            }
        }
        for (const Quad& quad : box_quads({-1, -2, -3}, {1, 2, 3}).quads) // normals point outward
            CHECK(dot(cross(quad.u, quad.v), quad.corner + quad.u * 0.5f + quad.v * 0.5f) > 0);
    }

} // TEST_SUITE
