// These tests check every material for the same laws: density, weight, reciprocity and energy, on both sides and at
// grazing angles.
#include "common/sampling/hash.h"
#include "common/sampling/warp.h"
#include "compare/stress/chi_squared.h"
#include "tests/common/material/test_materials.h"

#include <doctest/doctest.h>

#include <cmath>
#include <optional>

using namespace duet;

TEST_SUITE("unit") {
    TEST_CASE("a sample's weight is eval·|cos|/pdf and its density is pdf's; nothing is negative or infinite") {
        for (const NamedBsdf& m : all_materials())
            for (const float z : kCosines) {
                const Vec3 wo = direction(z, 0.7f);
                CAPTURE(m.name);
                CAPTURE(z);
                for_numbers(200, [&](float lobe, Vec2 u) {
                    const auto s = sample(m.bsdf, wo, lobe, u);
                    if (!s) return;
                    CAPTURE(s->wi.z);
                    REQUIRE(is_finite(s->weight));
                    REQUIRE(is_finite(s->wi));
                    REQUIRE(length(s->wi) == doctest::Approx(1).epsilon(1e-5));
                    REQUIRE((s->weight.r >= 0 && s->weight.g >= 0 && s->weight.b >= 0));
                    REQUIRE((s->pdf > 0 && std::isfinite(s->pdf)));
                    REQUIRE(s->transmitted == !same_hemisphere(wo, s->wi));
                    REQUIRE(s->specular == is_specular(m.bsdf));
                    const Rgb f = eval(m.bsdf, wo, s->wi);
                    const float density = pdf(m.bsdf, wo, s->wi);
                    if (s->specular) {
                        REQUIRE(is_black(f));
                        REQUIRE(density == 0);
                        return;
                    }
                    REQUIRE(density == s->pdf);
                    for (std::size_t c = 0; c < 3; ++c)
                        REQUIRE(static_cast<double>(f[c]) * static_cast<double>(abs_cos_theta(s->wi)) /
                                    static_cast<double>(density) ==
                                doctest::Approx(s->weight[c]).epsilon(2e-5));
                });
            }
    }

    TEST_CASE("eval and pdf are finite, not negative and 0 or positive together for any two directions") {
        for (const NamedBsdf& m : all_materials())
            for (const float zo : kCosines)
                for (const float zi : kCosines)
                    for (const float phi : {0.7f, 2.0f, 0.7f + kPi}) {
                        CAPTURE(m.name);
                        CAPTURE(zo);
                        CAPTURE(zi);
                        const Vec3 wo = direction(zo, 0.7f), wi = direction(zi, phi);
                        const Rgb f = eval(m.bsdf, wo, wi);
                        const float density = pdf(m.bsdf, wo, wi);
                        REQUIRE(is_finite(f));
                        REQUIRE((f.r >= 0 && f.g >= 0 && f.b >= 0));
                        REQUIRE((std::isfinite(density) && density >= 0));
                        // Every direction with a nonzero BSDF must have a nonzero sampling density.
                        if (!is_black(f)) REQUIRE(density > 0);
                        if (zo * zi < 0 && !is_transmissive(m.bsdf)) REQUIRE(is_black(f));
                    }
        for (const NamedBsdf& m : all_materials()) { // exactly edge-on
            CHECK_FALSE(sample(m.bsdf, {1, 0, 0}, 0.5f, {0.5f, 0.5f}).has_value());
            CHECK(is_black(eval(m.bsdf, {1, 0, 0}, {0, 0, 1})));
            CHECK(pdf(m.bsdf, {0, 0, 1}, {1, 0, 0}) == 0);
        }
    }

    TEST_CASE("reflection is reciprocal, and the same from below and in both modes") {
        for (const NamedBsdf& m : rough_materials())
            for (int i = 0; i < 200; ++i) {
                const auto number = [&](int k) { return static_cast<float>((i * k) % 199 + 1) / 200; };
                Vec3 a = direction(number(7), 6.28f * number(11));
                Vec3 b = direction(number(13), 6.28f * number(29));
                // The directions are nearly opposite. If the lengths of wo and wi differ by a rounding error, their
                // cosines with h differ greatly.
                if (i % 2) a = direction(1e-5f * number(7), 6.28f * number(11)), b = {-a.x, -a.y, 1e-5f * number(13)};
                const Rgb ab = eval(m.bsdf, a, b), ba = eval(m.bsdf, b, a);
                const Rgb below = eval(m.bsdf, {a.x, a.y, -a.z}, {b.x, b.y, -b.z});
                CAPTURE(m.name);
                for (std::size_t c = 0; c < 3; ++c) REQUIRE(ab[c] == doctest::Approx(ba[c]).epsilon(1e-5));
                REQUIRE(below == ab);
                REQUIRE(eval(m.bsdf, a, b, TransportMode::kImportance) == ab);
            }
    }

    TEST_CASE("furnace: no material sends out more than it receives, lossless ones send all") {
        for (const NamedBsdf& m : all_materials())
            for (const float z : kCosines) {
                CAPTURE(m.name);
                CAPTURE(z);
                // The albedo of a single lobe with one color is exact.
                const bool exact = is_specular(m.bsdf) && !std::holds_alternative<ThinDielectricBsdf>(m.bsdf);
                const Rgbd a = albedo(m.bsdf, direction(z, 0.3f), TransportMode::kImportance,
                                       // Transmissive materials need more samples because they choose a lobe at random.
                                       exact ? 256 : is_transmissive(m.bsdf) ? 65536 : 16384);
                // Specular materials are exact. The tolerance 0.007 covers the quadrature and the microfacet energy
                // tables. The table is coarse at grazing angles where glass hardly refracts.
                const bool coarse =
                    std::holds_alternative<RoughDielectricBsdf>(m.bsdf) && refraction_index(m.bsdf) < 1.01f;
                const double tolerance = exact ? 1e-6 : coarse ? 0.05 : 0.007;
                CAPTURE(a.g);
                CHECK((a.r <= 1 + tolerance && a.g <= 1 + tolerance && a.b <= 1 + tolerance));
                if (m.lossless) CHECK(a.g >= 1 - 0.007);
            }
        const Bsdf lossless[] = {DiffuseBsdf{Rgb(1.0f)}, MetalBsdf{Rgb(1.0f), 0.0f}, DielectricBsdf{1.5f, Rgb(1.0f)},
                                 ThinDielectricBsdf{1.5f, Rgb(1.0f)}};
        for (const Bsdf& b : lossless)
            for (const float z : kCosines)
                for_numbers(64, [&](float lobe, Vec2 u) {
                    const auto s = sample(b, direction(z, 0.3f), lobe, u, TransportMode::kImportance);
                    REQUIRE(s.has_value());
                    // Each sample is checked separately, so the variance is zero.
                    REQUIRE(max_component(s->weight) == doctest::Approx(1).epsilon(4e-7));
                });
    }

    TEST_CASE("clay: what is reflected is the sum of its samples; at roughness 0 it is Lambert's") {
        for (const float z : {1.0f, 0.6f, 0.1f}) {
            const RoughDiffuseBsdf clay{Rgb(0.7f, 0.5f, 1.0f), 0.8f};
            const Rgbd sum = albedo(clay, direction(z, 0.3f), TransportMode::kRadiance, 8192);
            for (std::size_t c = 0; c < 3; ++c)
                CHECK(sum[c] == doctest::Approx(static_cast<double>(clay.directional_albedo(z)[c])).epsilon(0.003));
            const RoughDiffuseBsdf flat{Rgb(0.7f), 0};
            CHECK(flat.eval(direction(z, 1), direction(0.4f, 2), TransportMode::kRadiance).g ==
                  doctest::Approx(0.7f * kInvPi).epsilon(1e-5));
        }
    }

    TEST_CASE("descriptions become scattering functions; colors stay within [0, 1]; emission knows its side") {
        const TextureSet none;
        SurfacePoint point{};
        point.ng = {0, 0, 1};
        CHECK(std::get<MetalBsdf>(bsdf_at(Metal{{Rgb(2.0f, 0.5f, -1.0f)}, 0.5f}, none, point)).reflectance ==
              Rgb(1, 0.5f, 0));
        CHECK(std::get<MetalBsdf>(bsdf_at(Metal{{Rgb(1.0f)}, 0.5f}, none, point)).alpha == 0.25f);
        CHECK(is_specular(bsdf_at(Metal{}, none, point)));
        CHECK(is_specular(bsdf_at(Dielectric{}, none, point)));
        CHECK_FALSE(is_specular(bsdf_at(Dielectric{1.01f, {Rgb(1.0f)}, {0.5f}}, none, point)));
        CHECK(is_specular(bsdf_at(Dielectric{1.000001f, {Rgb(1.0f)}, {0.5f}}, none, point))); // does not refract
        CHECK_FALSE(is_specular(bsdf_at(Diffuse{}, none, point)));
        const Material area_light = Emissive{Rgb(3.0f), false, {Rgb(0.25f)}};
        CHECK(emitted(area_light, none, point, {0, 0.6f, 0.8f}) == Rgb(3.0f));
        CHECK(is_black(emitted(area_light, none, point, {0, 0.6f, -0.8f})));
        CHECK(emitted(Emissive{Rgb(3.0f), true, {}}, none, point, {0, 0.6f, -0.8f}) == Rgb(3.0f));
        CHECK(is_black(emitted(Diffuse{}, none, point, {0, 0, 1})));
        CHECK(base_color(area_light, none, point) == Rgb(0.25f));
        CHECK(base_color(Dielectric{1.5f, {Rgb(0.5f)}}, none, point) == Rgb(0.5f));
    }
}

TEST_SUITE("statistical") {
    TEST_CASE("directions are distributed as pdf says, from both sides") {
        // A false alarm has odds of 1e-4 for all comparisons together.
        const float cosines[] = {1.0f, 0.6f, 0.1f, 1e-3f, -0.6f};
        std::vector<NamedBsdf> materials = rough_materials();
        for (NamedBsdf& frosted : frosted_materials()) materials.push_back(std::move(frosted));
        const int tests = static_cast<int>(materials.size() * std::size(cosines));
        for (const NamedBsdf& m : materials)
            for (const float z : cosines) {
                const Vec3 wo = direction(z, 0.9f);
                // The cells become smaller toward the mirror direction, where a narrow lobe is.
                compare::DirectionTest setup;
                if (!is_diffuse(m.bsdf))
                    setup.axis = {-wo.x, -wo.y, wo.z}, setup.axis_power = m.narrowest < 0.1f ? 4 : 2;
                setup.samples = 50'000;
                // The density is discontinuous at the horizon and at the critical angle, which cross cells.
                setup.subdivisions = is_transmissive(m.bsdf) ? 24 : 16;
                std::uint64_t count = 0;
                const auto result = compare::test_directions(
                    setup,
                    [&](Vec2 u) -> std::optional<Vec3> {
                        const auto s = sample(m.bsdf, wo, unit_float(high_bits(mix_bits(++count))), u);
                        return s ? std::optional<Vec3>(s->wi) : std::nullopt;
                    },
                    [&](Vec3 wi) { return static_cast<double>(pdf(m.bsdf, wo, wi)); });
                CAPTURE(m.name);
                CAPTURE(z);
                CHECK_MESSAGE(result.chi_squared.p_value > compare::sidak_level(1e-4, tests),
                              result.chi_squared.details);
                CHECK(result.integral < 1.003);
                CHECK(result.integral > m.found);
            }
    }

    TEST_CASE("the mean weight is the integral of eval·cos: sampling leaves nothing out but what falls below") {
        // The albedo is estimated twice, from the material's own samples and from uniform directions. The tolerance
        // is 4.5 standard errors, so a false alarm has odds of 7e-6 per comparison.
        std::vector<NamedBsdf> materials = rough_materials();
        for (NamedBsdf& frosted : frosted_materials()) materials.push_back(std::move(frosted));
        for (const NamedBsdf& m : materials)
            for (const float z : {0.9f, 0.3f, -0.6f}) {
                const Vec3 wo = direction(z, 0.4f);
                constexpr int kSamples = 100'000;
                Sampler sampler(SamplerKind::kIndependent, 3, kSamples);
                double own = 0, own2 = 0, uniform = 0, uniform2 = 0;
                for (int i = 0; i < kSamples; ++i) {
                    sampler.start(0, 0, static_cast<std::uint32_t>(i));
                    const float lobe = sampler.get_2d().x;
                    const auto s = sample(m.bsdf, wo, lobe, sampler.get_2d());
                    const double a = s ? static_cast<double>(s->weight.r) : 0.0;
                    const Vec3 wi = uniform_sphere(sampler.get_2d());
                    const double b =
                        static_cast<double>(eval(m.bsdf, wo, wi).r * abs_cos_theta(wi) / kUniformSpherePdf);
                    own += a / kSamples, own2 += a * a / kSamples, uniform += b / kSamples,
                        uniform2 += b * b / kSamples;
                }
                const double error = std::sqrt((own2 - own * own + uniform2 - uniform * uniform) / kSamples);
                CAPTURE(m.name);
                CAPTURE(z);
                CAPTURE(own);
                CAPTURE(uniform);
                CHECK(std::abs(own - uniform) < 4.5 * error + 1e-6);
            }
    }
}
