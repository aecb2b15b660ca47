// These tests compare the light of polygons and spheres, diffusely reflected and in lobes, with closed forms and
// integrals in double.
#include "common/material/ggx_albedo.h"
#include "raster/lighting/polygon_light.h"
#include "raster/lighting/sphere_light.h"
#include "tests/raster/lobe_lookup.h"
#include "tests/support/form_factor.h"
#include "tests/support/random.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raster;
using duet::test::Random;

namespace {

Floats lanes_of(float x) { return Floats(x); }
Vec3T<Floats> lanes_of(Vec3 v) { return broadcast<Floats>(v); }
CosineSpaceT<Floats> lanes_of(const CosineSpaceT<float>& s) {
    const Floats flat = Floats(s.determinant / s.yy);
    return CosineSpaceT<Floats>::of(Floats(s.zz), Floats(-s.xz), flat / Floats(s.yy), Floats(-s.zx), Floats(s.xx));
}
float lane(const Floats& x) { return Lanes<Floats>(x)[0]; }
const xsimd::batch_bool<float> kAllLanes = Floats(0.0f) < Floats(1.0f);

/// Returns a lobe for a viewer at this cosine.
CosineSpaceT<float> space_of(float alpha, float cosine) {
    const LobeMatrix m = ggx_lobe(alpha, cosine);
    return CosineSpaceT<float>::of(m.m11, m.m13, m.m22, m.m31, m.m33);
}

/// Returns π times the fraction of a lobe whose directions satisfy inside(w): of directions with a cosine distribution,
/// those that the inverse transformation maps to such directions. w is not normalized.
template <typename Inside> double part_of_lobe(const CosineSpaceT<float>& lobe, const Inside& inside) {
    constexpr int kSide = 300; // an error below 0.01
    const Vec3d row_x(static_cast<double>(lobe.xx), 0, static_cast<double>(lobe.xz)),
        row_z(static_cast<double>(lobe.zx), 0, static_cast<double>(lobe.zz));
    const double flat = row_x.x * row_z.z - row_x.z * row_z.x;
    int count = 0;
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j) {
            const double u = (i + 0.5) / kSide, r = std::sqrt(u), angle = 2 * kPiDouble * (j + 0.5 * (i % 2)) / kSide;
            const Vec3d v(r * std::cos(angle), r * std::sin(angle), std::sqrt(1 - u));
            count += inside(Vec3d((v.x * row_z.z - v.z * row_x.z) / flat, v.y / static_cast<double>(lobe.yy),
                                  (v.z * row_x.x - v.x * row_z.x) / flat));
        }
    return kPiDouble * count / (kSide * kSide);
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("math in lanes: angles from cosines, and the arc tangent less its argument") {
        double worst = 0, worst_cosine = 0, worst_tangent = 0;
        for (int i = 0; i <= 1000; ++i) {
            const float x = static_cast<float>(i) / 1000;
            const double d = static_cast<double>(x), sine = std::sqrt((1 - d) * (1 + d));
            worst = std::max(worst,
                             std::abs(static_cast<double>(angle_over_sine(x)) - (i < 1000 ? std::acos(d) / sine : 1)));
            for (const float s : {-x, x})
                worst_cosine = std::max(
                    worst_cosine, std::abs(static_cast<double>(arc_cosine(s)) - std::acos(static_cast<double>(s))));
            const double t = std::exp(d * 12 - 6), exact = std::atan(t) - t;
            worst_tangent = std::max(
                worst_tangent, std::abs(static_cast<double>(arc_tangent_excess(static_cast<float>(t))) / exact - 1));
            CHECK(lane(angle_over_sine(lanes_of(x))) == angle_over_sine(x));
        }
        CHECK(worst < 5e-7);
        CHECK(worst_cosine < 1e-6);
        CHECK(worst_tangent < 2e-6);
    }

    TEST_CASE("polygons: as in double, of any size and distance, through the horizon, and from behind") {
        Random random(1);
        double worst = 0, worst_relative = 0;
        for (int i = 0; i < 20000; ++i) {
            const float size = random.log_range(1e-3f, 1e2f), far = i % 4 == 0 ? 0 : 2;
            const float distance = size * random.log_range(0.05f, std::pow(10.0f, far));
            const float width = size * random.range(0.2f, 1);
            const Vec3 corner = random.direction() * distance;
            const Vec3 u = random.direction() * size, v = random.direction() * width;
            const bool quad = i % 2 == 0;
            const Vec3 fourth = corner + u + v;
            std::vector<Vec3> corners{corner, corner + u};
            if (quad) corners.push_back(fourth);
            corners.push_back(corner + v);
            const double exact = polygon_form_factor_times_pi(Vec3(), {0, 0, 1}, corners);
            const PolygonT<float> one{corner, u, v};
            const PolygonT<Floats> many{lanes_of(corner), lanes_of(u), lanes_of(v)};
            const float signed_result =
                quad ? polygon_form_factor_times_pi<4>(one, true) : polygon_form_factor_times_pi<3>(one, true);
            const float in_lanes = lane(quad ? polygon_form_factor_times_pi<4>(many, kAllLanes)
                                             : polygon_form_factor_times_pi<3>(many, kAllLanes));
            CHECK(std::abs(in_lanes - signed_result) < 2e-6f);
            const double result = std::abs(static_cast<double>(signed_result));
            if (exact > 1e-6) CHECK((signed_result > 0) == (dot(cross(u, v), corner) < 0));
            const double error = std::abs(result - exact);
            // Near the polygon's plane the result changes fast, from 0 to its double on the other side.
            const float height = std::abs(dot(cross(u, v), corner)) / (length(cross(u, v)) * length(corner));
            if (height < 1e-3f) {
                CHECK(error < 0.015);
                continue;
            }
            worst = std::max(worst, error);
            if (exact > 1e-9) worst_relative = std::max(worst_relative, std::min(error, error / exact));
        }
        CHECK(worst < 7e-5); // measured: 6.4e-5
        CHECK(worst_relative < 1e-2);
    }

    TEST_CASE("spheres: as in double, above, through and below the horizon") {
        Random random(2);
        double worst = 0, worst_of_zenith = 0;
        for (int i = 0; i < 20000; ++i) {
            const float sine = random.log_range(1e-4f, 0.999f);
            Vec3 d = random.direction();
            if (i % 2 == 0) { // near the horizon
                const float z = sine * random.range(-1.2f, 1.2f);
                d = normalize(Vec3(d.x, d.y, 0)) * std::sqrt(max(1 - z * z, 0.0f)) + Vec3(0, 0, z);
                if (!(std::abs(z) < 1)) continue;
            }
            const double exact = sphere_form_factor_times_pi(Vec3(), {0, 0, 1}, Sphere{d, sine});
            const float result = sphere_form_factor_times_pi(d.z, sine * sine, true);
            CHECK(std::abs(lane(sphere_form_factor_times_pi(lanes_of(d.z), lanes_of(sine * sine), kAllLanes)) -
                           result) < 1e-6f);
            const double error = std::abs(static_cast<double>(result) - exact);
            worst = std::max(worst, error);
            worst_of_zenith = std::max(worst_of_zenith, error / (kPiDouble * static_cast<double>(sine * sine)));
        }
        CHECK(worst < 1e-5);
        CHECK(worst_of_zenith < 3e-6);
    }

    TEST_CASE("spheres and polygons in lobes: the integral of the transformed cosine") {
        Random random(3);
        double worst = 0, worst_polygon = 0;
        for (int i = 0; i < 1000; ++i) {
            const float alpha = random.log_range(0.0025f, 1), to_viewer = random.range(0.02f, 1);
            const CosineSpaceT<float> lobe = space_of(alpha, to_viewer);
            // Near the lobe's axis, which the matrix maps to +z.
            const Vec3 axis = normalize(cross(Vec3(lobe.xx, 0, lobe.xz), Vec3(0, lobe.yy, 0)));
            const float off_axis = random.log_range(0.003f, 1);
            const Vec3 d = normalize(axis + random.direction() * off_axis);
            const float sine = random.log_range(0.003f, 0.9f), sine2 = sqr(sine);
            const double cosine = std::sqrt(1 - static_cast<double>(sine2));
            const double exact = part_of_lobe(lobe, [&](Vec3d w) { return dot(w, Vec3d(d)) > cosine * length(w); });
            worst = std::max(worst, std::abs(static_cast<double>(sphere_in_lobe(lobe, d, sine2, true)) - exact));
            CHECK(lane(sphere_in_lobe(lanes_of(lobe), lanes_of(d), lanes_of(sine2), kAllLanes)) ==
                  doctest::Approx(sphere_in_lobe(lobe, d, sine2, true)).epsilon(1e-3));

            const Vec3 u = random.direction() * sine, v = random.direction() * sine, corner = d - (u + v) * 0.5f;
            const std::array<Vec3d, 4> corners{Vec3d(corner), Vec3d(corner + u), Vec3d(corner + u + v),
                                               Vec3d(corner + v)};
            const double exact_polygon = part_of_lobe(lobe, [&](Vec3d w) {
                int left = 0;
                for (std::size_t k = 0; k < 4; ++k) left += dot(cross(corners[k], corners[(k + 1) % 4]), w) > 0;
                return dot(w, Vec3d(d)) > 0 && (left == 0 || left == 4);
            });
            const PolygonT<float> transformed{lobe(corner), lobe(u), lobe(v)};
            const float polygon = std::abs(polygon_form_factor_times_pi<4>(transformed, true));
            worst_polygon = std::max(worst_polygon, std::abs(static_cast<double>(polygon) - exact_polygon));
        }
        CHECK(worst < 0.022); // measured: 0.020 and 0.0032
        CHECK(worst_polygon < 0.0035);
    }

    TEST_CASE("tables in lanes: as the scalar look-ups") {
        LobeLookup lookup;
        Random random(4);
        double worst = 0;
        for (int i = 0; i < 500; ++i) {
            alignas(64) std::array<float, Floats::size> alphas, cosines;
            for (std::size_t k = 0; k < Floats::size; ++k)
                alphas[k] = i % 2 == 0 && k > 0 ? alphas[0] : random.log_range(1e-4f, 1),
                cosines[k] = random.range(0.001f, 1);
            const Floats alpha = Floats::load_aligned(alphas.data()), cosine = Floats::load_aligned(cosines.data());
            const LobeTables t = lookup(alpha, cosine, kAllLanes);
            const Floats lost = lookup.lost(alpha, cosine, kAllLanes);
            for (std::size_t k = 0; k < Floats::size; ++k) {
                const LobeMatrix m = ggx_lobe(alphas[k], cosines[k]);
                const GgxAlbedo albedo = ggx_albedo(alphas[k], cosines[k]);
                const auto check = [&](const Floats& lanes, float one) {
                    worst = std::max(worst, static_cast<double>(std::abs(Lanes<Floats>(lanes)[k] - one)));
                };
                check(t.m11, m.m11), check(t.m13, m.m13), check(t.m22, m.m22), check(t.m31, m.m31), check(t.m33, m.m33);
                check(t.energy, albedo.energy), check(t.share, albedo.schlick_weight), check(lost, 1 - albedo.energy);
                check(t.mean_lost, ggx_average_albedo(alphas[k]).energy_loss);
            }
        }
        CHECK(worst < 5e-7);
    }
}
