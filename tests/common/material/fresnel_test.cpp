// These tests check the Fresnel equations and the colors of the named conductors computed from them.
#include "common/material/fresnel.h"
#include "common/material/material.h"
#include "common/vec/simd.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

using namespace duet;

TEST_SUITE("unit") {
    TEST_CASE("Fresnel: known values, limits, symmetry") {
        CHECK(fresnel_dielectric(1.0, 1.5) == doctest::Approx(0.04).epsilon(1e-12));
        CHECK(fresnel_dielectric(1.0, 1 / 1.5) == doctest::Approx(0.04).epsilon(1e-12));
        CHECK(fresnel_dielectric(0.0, 1.5) == doctest::Approx(1));
        CHECK(fresnel_dielectric(1e-7f, 1.5f) == doctest::Approx(1).epsilon(1e-5));
        CHECK(fresnel_dielectric(0.5, 1 / 1.5) == 1.0); // sin 60° · 1.5 > 1
        for (const double z : {0.0, 1e-9, 0.5, 1.0}) CHECK(fresnel_dielectric(z, 1.0) == 0);
        // At Brewster's angle the parallel component vanishes and half of the perpendicular one remains: ½((η² −
        // 1)/(η² + 1))².
        const double eta = 1.5, brewster = std::cos(std::atan(eta)), rest = (eta * eta - 1) / (eta * eta + 1);
        CHECK(fresnel_dielectric(brewster, eta) == doctest::Approx(0.5 * rest * rest).epsilon(1e-12));
        for (int i = 1; i <= 100; ++i) { // both sides must give the same value along one ray
            const double cos_i = i / 100.0, cos_t = std::sqrt(cos2_refracted(cos_i, eta));
            CHECK(fresnel_dielectric(cos_i, eta) == doctest::Approx(fresnel_dielectric(cos_t, 1 / eta)).epsilon(1e-9));
        }
        const Rgb metal{0.9f, 0.5f, 0.0f};
        CHECK(fresnel_schlick(metal, 1.0f) == metal);
        CHECK(fresnel_schlick(metal, 0.0f) == Rgb(1.0f));
        CHECK(fresnel_schlick(Rgb(1.0f), 0.37f) == Rgb(1.0f));
    }

    TEST_CASE("conductors: Fresnel's curve is that of a dielectric without absorption, and a mirror's with "
              "much; SIMD") {
        for (const double z : {1.0, 0.7, 0.3, 0.01}) {
            CHECK(fresnel_conductor(z, 1.5, 0.0) == doctest::Approx(fresnel_dielectric(z, 1.5)).epsilon(1e-9));
            CHECK(fresnel_conductor(z, 0.01, 1000.0) > 0.9999);
        }
        // The formula at normal incidence is ((n − 1)² + k²)/((n + 1)² + k²) (Born and Wolf 1999, §14.2).
        CHECK(fresnel_conductor(1.0, 0.47, 2.4) ==
              doctest::Approx((0.53 * 0.53 + 5.76) / (1.47 * 1.47 + 5.76)).epsilon(1e-12));
        using Lanes = FloatBatch<kSimdLanes>;
        std::array<float, kSimdLanes> cosines{}, together{};
        for (std::size_t i = 0; i < kSimdLanes; ++i) cosines[i] = (static_cast<float>(i) + 0.5f) / kSimdLanes;
        fresnel_conductor(Lanes::load_unaligned(cosines.data()), Lanes(0.3f), Lanes(3.1f))
            .store_unaligned(together.data());
        for (std::size_t i = 0; i < kSimdLanes; ++i) CHECK(together[i] == fresnel_conductor(cosines[i], 0.3f, 3.1f));
    }

    TEST_CASE("named conductors: colors known from elsewhere, and a curve near the measured spectrum's at all angles") {
        for (const std::string_view name : conductor_names()) {
            CAPTURE(name);
            const auto metal = find_conductor(name);
            REQUIRE(metal.has_value());
            const MetalBsdf mirror(*metal, 0);
            for (const double z : {1.0, 0.8, 0.6, 0.4, 0.2, 0.1}) {
                CAPTURE(z);
                const Rgb seen = mirror.fresnel(static_cast<float>(z));
                const Rgbd measured = spectral_reflectance(name, z);
                for (std::size_t c = 0; c < 3; ++c) {
                    CHECK(std::abs(static_cast<double>(seen[c]) - std::min(measured[c], 1.0)) < 0.02);
                    CHECK(metal->average_fresnel[c] >= metal->f0[c] - 0.02f);
                }
            }
        }
        CHECK_FALSE(find_conductor("unobtainium").has_value());
        const auto near = [](std::string_view name, Rgb known, float bound) {
            const Rgb normal = find_conductor(name)->f0;
            CAPTURE(name);
            for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(normal[c] - known[c]) < bound);
        };
        // The reference colors are linear Rec. 709 at normal incidence. One group is from the same measurements as on
        // physicallybased.info, the other from table 9.2 of Akenine-Möller et al. 2018, "Real-Time Rendering".
        near("iron", {0.531f, 0.512f, 0.496f}, 0.01f);
        near("nickel", {0.697f, 0.641f, 0.563f}, 0.01f);
        near("copper", {0.932f, 0.623f, 0.522f}, 0.01f);
        near("titanium", {0.616f, 0.582f, 0.544f}, 0.01f);
        near("platinum", {0.679f, 0.642f, 0.588f}, 0.01f);
        near("gold", {1.0f, 0.782f, 0.344f}, 0.07f);
        near("silver", {0.972f, 0.960f, 0.915f}, 0.07f);
        near("aluminium", {0.913f, 0.922f, 0.924f}, 0.03f);
    }
}
