// These tests compare microfacet normals, masking and densities with their definitions, and the energy tables with
// sums.
#include "common/material/fresnel.h"
#include "common/material/ggx.h"
#include "common/material/ggx_albedo.h"
#include "compare/stress/chi_squared.h"
#include "tests/common/material/test_materials.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace duet;

TEST_SUITE("unit") {
    TEST_CASE("what microfacets return is in the tables: energy to 0.006, Schlick's part of it to 0.015") {
        for (const float alpha : {1e-4f, 1e-3f, 0.01f, 0.1f, 0.3f, 1.0f})
            for (const float z : {1.0f, 0.7f, 0.3f, 0.05f, 0.01f, 1e-3f}) {
                CAPTURE(alpha);
                CAPTURE(z);
                const Vec3 wo = direction(z, 0.3f);
                Sampler sampler(SamplerKind::kSobol, 5, 8192);
                double energy = 0, share = 0;
                for (std::uint32_t i = 0; i < 8192; ++i) {
                    sampler.start(0, 0, i);
                    const Vec3 h = ggx_sample_visible_normal(wo, alpha, sampler.get_2d()), wi = reflect(wo, h);
                    if (!(wi.z > 0)) continue;
                    const double weight = static_cast<double>(ggx_g2_over_g1(wo, wi, alpha)) / 8192;
                    energy += weight;
                    share += weight * std::pow(1 - static_cast<double>(dot(wo, h)), 5);
                }
                const GgxAlbedo table = ggx_albedo(alpha, z);
                CHECK(std::abs(static_cast<double>(table.energy) - energy) < 0.006);
                CHECK(std::abs(static_cast<double>(table.energy * table.schlick_weight) - share) < 0.015);
            }
    }

    TEST_CASE("float formulas agree with double ones from narrow to wide lobes and at grazing angles") {
        for (const float alpha : {1e-3f, 1e-2f, 0.1f, 1.0f})
            for (const float z : {1.0f, 0.9f, 0.1f, 1e-3f, 1e-7f})
                for (const float tilt : {0.0f, 0.5f, 1.0f, 3.0f}) { // tilt of the normal, in units of alpha
                    CAPTURE(alpha);
                    CAPTURE(z);
                    CAPTURE(tilt);
                    const Vec3 wo = direction(z, 0.2f), wi = direction(0.5f * z + 0.2f, 2.0f);
                    const Vec3 h = normalize(Vec3(tilt * alpha, 0.3f * tilt * alpha, 1));
                    const Vec3d wod(wo), wid(wi), hd(h);
                    const double a = static_cast<double>(alpha);
                    CHECK(static_cast<double>(ggx_d(h, alpha)) == doctest::Approx(ggx_d(hd, a)).epsilon(3e-6));
                    CHECK(static_cast<double>(ggx_g1(wo, alpha)) == doctest::Approx(ggx_g1(wod, a)).epsilon(3e-6));
                    CHECK(static_cast<double>(ggx_lambda(wo, alpha)) ==
                          doctest::Approx(ggx_lambda(wod, a)).epsilon(3e-6));
                    CHECK(static_cast<double>(ggx_visibility(wo, wi, alpha)) ==
                          doctest::Approx(ggx_visibility(wod, wid, a)).epsilon(3e-6));
                    CHECK(static_cast<double>(ggx_reflection_pdf(wo, h, alpha)) ==
                          doctest::Approx(ggx_reflection_pdf(wod, hd, a)).epsilon(3e-6));
                    // The definitions, computed in double precision, are G₁ = 1/(1 + Λ) and G₂ = 1/(1 + Λₒ + Λᵢ).
                    const double lo = ggx_lambda(wod, a), li = ggx_lambda(wid, a);
                    CHECK(ggx_g1(wod, a) == doctest::Approx(1 / (1 + lo)).epsilon(1e-12));
                    CHECK(ggx_visibility(wod, wid, a) * 4 * wod.z * wid.z ==
                          doctest::Approx(1 / (1 + lo + li)).epsilon(1e-12));
                    CHECK(ggx_g2_over_g1(wod, wid, a) == doctest::Approx((1 + lo) / (1 + lo + li)).epsilon(1e-12));
                }
        for (const double eta : {1.0001, 1.5, 1 / 1.5, 2.4})
            for (const double z : {1.0, 0.5, 0.01, 1e-6})
                CHECK(static_cast<double>(fresnel_dielectric(static_cast<float>(z), static_cast<float>(eta))) ==
                      doctest::Approx(fresnel_dielectric(static_cast<double>(static_cast<float>(z)),
                                                         static_cast<double>(static_cast<float>(eta))))
                          .epsilon(1e-5));
    }
}

TEST_SUITE("statistical") {
    TEST_CASE("GGX: ∫ D cos = 1, and visible normals have the density G₁ max(0, w·h) D / cos") {
        for (const double alpha : {1e-3, 0.05, 0.5, 1.0}) {
            // With t = tan²/α², the integral is ∫ D cos dω = ∫ 1/(1 + t)² dt. The midpoint rule runs over s = t/(1 +
            // t), in which the integrand is 1.
            double sum = 0;
            constexpr int kSteps = 1000;
            for (int i = 0; i < kSteps; ++i) {
                const double s = (i + 0.5) / kSteps, tan2 = alpha * alpha * s / (1 - s), cos2 = 1 / (1 + tan2);
                const Vec3d h(std::sqrt(tan2 * cos2), 0, std::sqrt(cos2));
                const double dt = 1 / ((1 - s) * (1 - s)) / kSteps; // dω cos = π cos⁴ d(tan²)
                sum += ggx_d(h, alpha) * kPiDouble * cos2 * cos2 * alpha * alpha * dt;
            }
            CHECK(sum == doctest::Approx(1).epsilon(1e-6));
        }
        for (const float alpha : {0.1f, 0.5f, 1.0f})
            for (const float z : {0.9f, 0.2f, 0.01f}) {
                const Vec3 w = direction(z, 0.4f);
                compare::DirectionTest setup;
                setup.axis_power = 2;
                setup.subdivisions = 32; // the density has a kink where w·h = 0
                const auto result = compare::test_directions(
                    setup, [&](Vec2 u) { return ggx_sample_visible_normal(w, alpha, u); },
                    [&](Vec3 h) {
                        return h.z > 0 ? static_cast<double>(ggx_g1(w, alpha) * std::max(0.0f, dot(w, h)) *
                                                             ggx_d(h, alpha) / w.z)
                                       : 0.0;
                    });
                CAPTURE(alpha);
                CAPTURE(z);
                CHECK(result.integral == doctest::Approx(1).epsilon(2e-3));
                CHECK_MESSAGE(result.chi_squared.p_value > compare::sidak_level(1e-4, 9), result.chi_squared.details);
            }
    }
}
