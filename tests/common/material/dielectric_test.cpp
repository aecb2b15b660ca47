// These tests check refraction, reciprocity and energy of smooth, rough and thin dielectrics.
#include "common/material/fresnel.h"
#include "tests/common/material/test_materials.h"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>

using namespace duet;

TEST_SUITE("unit") {
    TEST_CASE("glass: Snell's law, η² for radiance only, a closed path through a slab keeps its radiance") {
        const float eta = 1.5f;
        const DielectricBsdf glass{eta, Rgb(1.0f)};
        for (const float z : kCosines) {
            CAPTURE(z);
            const Vec3 wo = direction(z, 1.1f);
            const auto radiance = glass.sample(wo, kOneMinusEpsilon, {}, TransportMode::kRadiance);
            const auto importance = glass.sample(wo, kOneMinusEpsilon, {}, TransportMode::kImportance);
            REQUIRE(radiance.has_value());
            if (!radiance->transmitted) { // total internal reflection
                CHECK(z < 0);
                CHECK(std::sqrt(1 - z * z) * eta > 0.999999f);
                continue;
            }
            const float relative = z > 0 ? eta : 1 / eta;
            CHECK(radiance->wi.x * relative == doctest::Approx(-wo.x).epsilon(1e-5));
            CHECK(radiance->wi.y * relative == doctest::Approx(-wo.y).epsilon(1e-5));
            CHECK(importance->weight == Rgb(1.0f));
            CHECK(radiance->weight.r * relative * relative == doctest::Approx(1).epsilon(1e-6));
            // Refraction back through the same interface must return the original direction and the inverse factor.
            const auto back = glass.sample(radiance->wi, kOneMinusEpsilon, {}, TransportMode::kRadiance);
            REQUIRE(back.has_value());
            REQUIRE(back->transmitted);
            // Near the critical angle a cosine is the square root of a rounded difference, so a float direction is
            // only accurate to √2⁻²³.
            const bool grazing = std::abs(z) < 0.01f;
            CHECK(length(back->wi - wo) < (grazing ? 5e-4f : 2e-5f));
            CHECK(back->weight.r * radiance->weight.r == doctest::Approx(1).epsilon(1e-6));
            if (!grazing) CHECK(back->pdf == doctest::Approx(radiance->pdf).epsilon(1e-4));
        }
        // An interface with η = 1 must not deflect light.
        const Vec3 w = direction(1e-6f, 0.4f);
        const auto through = DielectricBsdf{1.0f, Rgb(1.0f)}.sample(w, 0, {}, TransportMode::kRadiance);
        REQUIRE(through.has_value());
        CHECK(through->transmitted);
        CHECK(through->weight == Rgb(1.0f));
        CHECK(length(through->wi + w) < 1e-6f);
    }

    TEST_CASE("refraction by rough glass is reciprocal: radiance one way is importance the other") {
        for (const NamedBsdf& m : frosted_materials())
            for (int i = 0; i < 200; ++i) {
                const auto number = [&](int k) { return static_cast<float>((i * k) % 199 + 1) / 200; };
                const Vec3 a = direction(number(7), 6.28f * number(11)), b = direction(-number(13), 6.28f * number(29));
                CAPTURE(m.name);
                CAPTURE(i);
                for (const auto& [wo, wi] : {std::pair(a, b), std::pair(b, a)}) {
                    const Rgb there = eval(m.bsdf, wo, wi), back = eval(m.bsdf, wi, wo, TransportMode::kImportance);
                    for (std::size_t c = 0; c < 3; ++c) REQUIRE(there[c] == doctest::Approx(back[c]).epsilon(1e-4));
                }
                const Vec3 above = {b.x, b.y, -b.z};
                CHECK(eval(m.bsdf, a, above).g == doctest::Approx(eval(m.bsdf, above, a).g).epsilon(1e-5));
            }
    }

    TEST_CASE("white frosted glass returns all, from both sides, at any roughness and index") {
        for (const float alpha : {0.05f, 0.1f, 0.3f, 0.55f, 1.0f})
            for (const float eta : {1.05f, 1.2f, 1.33f, 1.5f, 1.7f, 2.4f, 3.9f, 1 / 1.5f})
                for (const float z : {1.0f, 0.7f, 0.3f, 0.1f, -0.9f, -0.7f, -0.4f, -0.05f}) {
                    CAPTURE(alpha);
                    CAPTURE(eta);
                    CAPTURE(z);
                    const Bsdf frosted = RoughDielectricBsdf{eta, Rgb(1.0f), alpha};
                    const double all = albedo(frosted, direction(z, 0.3f), TransportMode::kImportance, 4096).g;
                    CHECK(all == doctest::Approx(1).epsilon(0.01));
                }
    }

    TEST_CASE("frosted glass that hardly refracts does not blur: light goes on through all facets that it meets") {
        for (const float z : {0.9f, 0.4f, -0.9f, -0.4f}) {
            const RoughDielectricBsdf pane{1.01f, Rgb(1.0f), 0.5f};
            const Vec3 wo = direction(z, 0.3f);
            double ahead = 0, all = 0;
            for_numbers(4096, [&](float lobe, Vec2 u) {
                const auto s = pane.sample(wo, lobe, u, TransportMode::kImportance);
                if (!s) return;
                all += static_cast<double>(s->weight.g);
                if (dot(s->wi, wo) < -0.99f) ahead += static_cast<double>(s->weight.g);
            });
            CAPTURE(z);
            CHECK(ahead / all > 0.93);
        }
    }

    TEST_CASE("a pane of glass reflects and lets through what its two sides do, to and fro, summed") {
        for (const float z : {1.0f, 0.5f, 0.1f, 1e-3f}) {
            const ThinDielectricBsdf pane{1.5f, Rgb(1.0f, 0.8f, 0.0f)};
            const auto fractions = pane.fractions(z);
            const double f = fresnel_dielectric(static_cast<double>(z), 1.5);
            const double cos_t = std::sqrt(cos2_refracted(static_cast<double>(z), 1.5));
            for (std::size_t c = 0; c < 3; ++c) {
                const double t = std::pow(static_cast<double>(pane.tint[c]), 1 / cos_t);
                double through = 0, back = f, inside = 1 - f; // directed toward the far side
                for (int i = 0; i < 4000; ++i) {
                    inside *= t;
                    (i % 2 == 0 ? through : back) += inside * (1 - f);
                    inside *= f;
                }
                CHECK(static_cast<double>(fractions.transmitted[c]) == doctest::Approx(through).epsilon(2e-4));
                CHECK(static_cast<double>(fractions.reflected[c]) == doctest::Approx(back).epsilon(2e-4));
            }
        }
    }
}
