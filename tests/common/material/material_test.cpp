// Every material by the same laws: density, weight, reciprocity, energy; both sides, grazing angles.
#include "common/material/fresnel.h"
#include "common/material/ggx.h"
#include "common/material/ggx_albedo.h"
#include "common/material/material.h"
#include "common/sampling/hash.h"
#include "common/sampling/sampler.h"
#include "common/sampling/warp.h"
#include "common/system/error.h"
#include "common/vec/simd.h"
#include "compare/stress/chi_squared.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

using namespace duet;

namespace {

Vec3 direction(float z, float phi) {
    const float r = std::sqrt((1 - z) * (1 + z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

struct Named {
    std::string name;
    Bsdf bsdf;
    float narrowest = 1;    ///< alpha of its narrowest lobe
    bool lossless = false;  ///< sends on all it receives
    double found = 0.997;   ///< the density's integral is at least this: what else is drawn falls below the surface
};

LayeredBsdf layers(Rgb color, float metallic, float roughness, float coat = 0, float coat_roughness = 0) {
    return LayeredBsdf({color, metallic, 0.04f, roughness, coat, coat_roughness});
}
Bsdf coated(Rgb albedo, float roughness) { return bsdf_at(Coated{{albedo}, roughness}, {}, SurfacePoint{}); }
Bsdf gold(float alpha) { return MetalBsdf(*find_conductor("gold"), alpha); }

/// Materials that reflect, and not as mirrors.
std::vector<Named> rough_materials() {
    const Rgb red(0.8f, 0.5f, 0.2f), white(1.0f);
    return {{"diffuse", DiffuseBsdf{red}},
            {"metal 1", MetalBsdf{Rgb(0.9f, 0.6f, 0.3f), 1.0f}, 1, false, 0.45},
            {"metal 0.3", MetalBsdf{white, 0.3f}, 0.3f, true, 0.8},
            {"metal 0.05", MetalBsdf{Rgb(0.5f), 0.05f}, 0.05f, false, 0.8},
            {"white metal 1", MetalBsdf{white, 1.0f}, 1, true, 0.45},
            {"gold 0.1", gold(0.1f), 0.1f, false, 0.8},
            {"gold 0.5", gold(0.5f), 0.5f, false, 0.6},
            {"clay 0.3", RoughDiffuseBsdf{red, 0.3f}},
            {"clay 1", RoughDiffuseBsdf{red, 1}},
            {"white clay 1", RoughDiffuseBsdf{white, 1}, 1, true},
            {"plastic 0.3", coated(red, 0.55f), 0.3f, false, 0.8},
            {"white plastic 0.3", coated(white, 0.55f), 0.3f, true, 0.8},
            {"white plastic 1", coated(white, 1), 1, true, 0.5},
            {"principled 0.5", layers(red, 0.5f, 0.6f), 0.36f, false, 0.8},
            {"white principled 0.4, metal", layers(white, 1, 0.6f), 0.36f, true, 0.8},
            {"white principled 0.4, dielectric", layers(white, 0, 0.6f), 0.36f, true, 0.8},
            {"clear coat", layers(red, 0.3f, 0.8f, 0.7f, 0.5f), 0.25f, false, 0.6}};
}
/// Those that light goes through, and not as through lenses.
std::vector<Named> frosted_materials() {
    return {{"frosted glass 0.3", RoughDielectricBsdf{1.5f, Rgb(1.0f), 0.3f}, 0.3f, true, 0.8},
            {"frosted water 0.5", RoughDielectricBsdf{1.33f, Rgb(0.9f, 1.0f, 0.8f), 0.5f}, 0.5f, false, 0.6},
            {"frosted diamond 1", RoughDielectricBsdf{2.4f, Rgb(1.0f), 1.0f}, 1, true, 0.4}};
}
std::vector<Named> all_materials() {
    std::vector<Named> all = rough_materials();
    for (Named& frosted : frosted_materials()) all.push_back(std::move(frosted));
    all.push_back({"metal 0.001", MetalBsdf{Rgb(0.9f), 0.001f}});
    all.push_back({"frosted 0.0005", RoughDielectricBsdf{1.5f, Rgb(1.0f), 0.0005f}});
    all.push_back({"shiny plastic", coated(Rgb(0.7f), 0)});
    all.push_back({"mirror", MetalBsdf{Rgb(0.9f, 0.8f, 0.7f), 0.0f}});
    all.push_back({"gold mirror", gold(0)});
    all.push_back({"glass", DielectricBsdf{1.5f, Rgb(0.9f, 1.0f, 0.8f)}});
    all.push_back({"air", DielectricBsdf{1.0f, Rgb(1.0f)}});
    all.push_back({"diamond", DielectricBsdf{2.4f, Rgb(1.0f)}});
    all.push_back({"window", ThinDielectricBsdf{1.5f, Rgb(0.9f, 1.0f, 0.8f)}});
    all.push_back({"clear window", ThinDielectricBsdf{1.5f, Rgb(1.0f)}, 1, true});
    all.push_back({"black film of no index", ThinDielectricBsdf{1.0f, Rgb(0.0f)}});
    all.push_back({"frosted, hardly refracting", RoughDielectricBsdf{1.002f, Rgb(1.0f), 0.3f}});
    return all;
}

/// Cosines of wo from straight above to 1e-7, on both sides.
constexpr float kCosines[] = {1.0f,  0.999f, 0.7f,   0.3f,  0.05f, 1e-3f, 1e-5f,
                              1e-7f, -1e-7f, -1e-4f, -0.2f, -0.9f, -1.0f};

/// Calls f(lobe, u) over a jittered set of `n` numbers and all corners of the cube.
template <typename F> void for_numbers(int n, F f) {
    for (const float x : {0.0f, kOneMinusEpsilon})
        for (const float y : {0.0f, kOneMinusEpsilon})
            for (const float z : {0.0f, kOneMinusEpsilon}) f(x, Vec2{y, z});
    Sampler sampler(SamplerKind::kSobol, 17, n);
    for (int i = 0; i < n; ++i) {
        sampler.start(0, 0, static_cast<std::uint32_t>(i));
        const float lobe = sampler.get_1d();
        f(lobe, sampler.get_2d());
    }
}

/// Share of uniform incoming light of radiance 1 that is sent to wo: the mean weight.
Rgbd albedo(const Bsdf& bsdf, Vec3 wo, TransportMode mode, int n) {
    Rgbd sum;
    Sampler sampler(SamplerKind::kSobol, 23, n);
    for (int i = 0; i < n; ++i) {
        sampler.start(0, 0, static_cast<std::uint32_t>(i));
        const float lobe = sampler.get_1d();
        if (const auto s = sample(bsdf, wo, lobe, sampler.get_2d(), mode)) sum += Rgbd(s->weight);
    }
    return sum / static_cast<double>(n);
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("a sample's weight is eval·|cos|/pdf and its density is pdf's; nothing is negative or infinite") {
        for (const Named& m : all_materials())
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
        for (const Named& m : all_materials())
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
                        // What eval lets through, sampling must be able to find.
                        if (!is_black(f)) REQUIRE(density > 0);
                        if (zo * zi < 0 && !is_transmissive(m.bsdf)) REQUIRE(is_black(f));
                    }
        for (const Named& m : all_materials()) { // exactly edge-on
            CHECK_FALSE(sample(m.bsdf, {1, 0, 0}, 0.5f, {0.5f, 0.5f}).has_value());
            CHECK(is_black(eval(m.bsdf, {1, 0, 0}, {0, 0, 1})));
            CHECK(pdf(m.bsdf, {0, 0, 1}, {1, 0, 0}) == 0);
        }
    }

    TEST_CASE("reflection is reciprocal, and the same from below and in both modes") {
        for (const Named& m : rough_materials())
            for (int i = 0; i < 200; ++i) {
                const auto number = [&](int k) { return static_cast<float>((i * k) % 199 + 1) / 200; };
                Vec3 a = direction(number(7), 6.28f * number(11));
                Vec3 b = direction(number(13), 6.28f * number(29));
                // Nearly opposite: wo and wi of lengths that differ by a rounding have very different cosines with h.
                if (i % 2) a = direction(1e-5f * number(7), 6.28f * number(11)), b = {-a.x, -a.y, 1e-5f * number(13)};
                const Rgb ab = eval(m.bsdf, a, b), ba = eval(m.bsdf, b, a);
                const Rgb below = eval(m.bsdf, {a.x, a.y, -a.z}, {b.x, b.y, -b.z});
                CAPTURE(m.name);
                for (std::size_t c = 0; c < 3; ++c) REQUIRE(ab[c] == doctest::Approx(ba[c]).epsilon(1e-5));
                REQUIRE(below == ab);
                REQUIRE(eval(m.bsdf, a, b, TransportMode::kImportance) == ab);
            }
    }

    TEST_CASE("refraction by rough glass is reciprocal: radiance one way is importance the other") {
        for (const Named& m : frosted_materials())
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

    TEST_CASE("furnace: no material sends out more than it receives, lossless ones send all") {
        for (const Named& m : all_materials())
            for (const float z : kCosines) {
                CAPTURE(m.name);
                CAPTURE(z);
                const bool exact = is_specular(m.bsdf) && !std::holds_alternative<ThinDielectricBsdf>(m.bsdf); // of one colour
                const Rgbd a = albedo(m.bsdf, direction(z, 0.3f), TransportMode::kImportance,
                                       exact ? 256 : is_transmissive(m.bsdf) ? 65536 : 16384); // of which the lobe is drawn by chance
                // Specular ones are exact; 0.007 are the quadrature's, and the tables' of microfacets' energy.
                // Where glass hardly refracts its table is coarse, at grazing angles.
                const double tolerance = exact ? 1e-6 : std::holds_alternative<RoughDielectricBsdf>(m.bsdf) && refraction_index(m.bsdf) < 1.01f ? 0.05 : 0.007;
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
                    REQUIRE(max_component(s->weight) == doctest::Approx(1).epsilon(4e-7)); // each sample, so without variance
                });
    }

    TEST_CASE("glass: Snell's law, η² for radiance only, a closed path through a slab keeps its radiance") {
        const float eta = 1.5f;
        const DielectricBsdf glass{eta, Rgb(1.0f)};
        for (const float z : kCosines) {
            CAPTURE(z);
            const Vec3 wo = direction(z, 1.1f);
            const auto radiance = glass.sample(wo, kOneMinusEpsilon, {}, TransportMode::kRadiance);
            const auto importance = glass.sample(wo, kOneMinusEpsilon, {}, TransportMode::kImportance);
            REQUIRE(radiance.has_value());
            if (!radiance->transmitted) { // total reflection, from inside only
                CHECK(z < 0);
                CHECK(std::sqrt(1 - z * z) * eta > 0.999999f);
                continue;
            }
            const float relative = z > 0 ? eta : 1 / eta;
            CHECK(radiance->wi.x * relative == doctest::Approx(-wo.x).epsilon(1e-5));
            CHECK(radiance->wi.y * relative == doctest::Approx(-wo.y).epsilon(1e-5));
            CHECK(importance->weight == Rgb(1.0f));
            CHECK(radiance->weight.r * relative * relative == doctest::Approx(1).epsilon(1e-6));
            // Back through the same boundary: the same way, with the inverse factor.
            const auto back = glass.sample(radiance->wi, kOneMinusEpsilon, {}, TransportMode::kRadiance);
            REQUIRE(back.has_value());
            REQUIRE(back->transmitted);
            // Near the critical angle a cosine is the root of a rounded difference: √2⁻²³ is all a float direction
            // holds.
            const bool grazing = std::abs(z) < 0.01f;
            CHECK(length(back->wi - wo) < (grazing ? 5e-4f : 2e-5f));
            CHECK(back->weight.r * radiance->weight.r == doctest::Approx(1).epsilon(1e-6));
            if (!grazing) CHECK(back->pdf == doctest::Approx(radiance->pdf).epsilon(1e-4));
        }
        // η = 1: as if it were not there.
        const Vec3 w = direction(1e-6f, 0.4f);
        const auto through = DielectricBsdf{1.0f, Rgb(1.0f)}.sample(w, 0, {}, TransportMode::kRadiance);
        REQUIRE(through.has_value());
        CHECK(through->transmitted);
        CHECK(through->weight == Rgb(1.0f));
        CHECK(length(through->wi + w) < 1e-6f);
    }

    TEST_CASE("Fresnel: known values, limits, symmetry") {
        CHECK(fresnel_dielectric(1.0, 1.5) == doctest::Approx(0.04).epsilon(1e-12));
        CHECK(fresnel_dielectric(1.0, 1 / 1.5) == doctest::Approx(0.04).epsilon(1e-12));
        CHECK(fresnel_dielectric(0.0, 1.5) == doctest::Approx(1));
        CHECK(fresnel_dielectric(1e-7f, 1.5f) == doctest::Approx(1).epsilon(1e-5));
        CHECK(fresnel_dielectric(0.5, 1 / 1.5) == 1.0); // sin 60° · 1.5 > 1
        for (const double z : {0.0, 1e-9, 0.5, 1.0}) CHECK(fresnel_dielectric(z, 1.0) == 0);
        // Brewster's angle: the parallel part vanishes, ½ of the perpendicular one is left: ½((η² − 1)/(η² + 1))².
        const double eta = 1.5, brewster = std::cos(std::atan(eta)), rest = (eta * eta - 1) / (eta * eta + 1);
        CHECK(fresnel_dielectric(brewster, eta) == doctest::Approx(0.5 * rest * rest).epsilon(1e-12));
        for (int i = 1; i <= 100; ++i) { // the same from both sides, along one ray
            const double cos_i = i / 100.0, cos_t = std::sqrt(cos2_refracted(cos_i, eta));
            CHECK(fresnel_dielectric(cos_i, eta) == doctest::Approx(fresnel_dielectric(cos_t, 1 / eta)).epsilon(1e-9));
        }
        const Rgb metal{0.9f, 0.5f, 0.0f};
        CHECK(fresnel_schlick(metal, 1.0f) == metal);
        CHECK(fresnel_schlick(metal, 0.0f) == Rgb(1.0f));
        CHECK(fresnel_schlick(Rgb(1.0f), 0.37f) == Rgb(1.0f));
    }

    TEST_CASE("conductors: Fresnel's curve is that of a dielectric without absorption, and a mirror's with much; SIMD") {
        for (const double z : {1.0, 0.7, 0.3, 0.01}) {
            CHECK(fresnel_conductor(z, 1.5, 0.0) == doctest::Approx(fresnel_dielectric(z, 1.5)).epsilon(1e-9));
            CHECK(fresnel_conductor(z, 0.01, 1000.0) > 0.9999);
        }
        // Born and Wolf 1999, §14.2: ((n − 1)² + k²)/((n + 1)² + k²) at normal incidence.
        CHECK(fresnel_conductor(1.0, 0.47, 2.4) == doctest::Approx((0.53 * 0.53 + 5.76) / (1.47 * 1.47 + 5.76)).epsilon(1e-12));
        using Lanes = FloatBatch<kSimdLanes>;
        std::array<float, kSimdLanes> cosines{}, together{};
        for (std::size_t i = 0; i < kSimdLanes; ++i) cosines[i] = (static_cast<float>(i) + 0.5f) / kSimdLanes;
        fresnel_conductor(Lanes::load_unaligned(cosines.data()), Lanes(0.3f), Lanes(3.1f)).store_unaligned(together.data());
        for (std::size_t i = 0; i < kSimdLanes; ++i) CHECK(together[i] == fresnel_conductor(cosines[i], 0.3f, 3.1f));
    }

    TEST_CASE("named conductors: colours known from elsewhere, and a curve near the measured spectrum's at all angles") {
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
                    CHECK(metal->average[c] >= metal->normal[c] - 0.02f);
                }
            }
        }
        CHECK_FALSE(find_conductor("unobtainium").has_value());
        const auto near = [](std::string_view name, Rgb known, float bound) {
            const Rgb normal = find_conductor(name)->normal;
            CAPTURE(name);
            for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(normal[c] - known[c]) < bound);
        };
        // Linear Rec. 709 at normal incidence: by the same measurements as physicallybased.info has it; by others as in
        // Akenine-Möller et al. 2018, «Real-Time Rendering», table 9.2.
        near("iron", {0.531f, 0.512f, 0.496f}, 0.01f);
        near("nickel", {0.697f, 0.641f, 0.563f}, 0.01f);
        near("copper", {0.932f, 0.623f, 0.522f}, 0.01f);
        near("titanium", {0.616f, 0.582f, 0.544f}, 0.01f);
        near("platinum", {0.679f, 0.642f, 0.588f}, 0.01f);
        near("gold", {1.0f, 0.782f, 0.344f}, 0.07f);
        near("silver", {0.972f, 0.960f, 0.915f}, 0.07f);
        near("aluminium", {0.913f, 0.922f, 0.924f}, 0.03f);
    }

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
                CHECK(std::abs(static_cast<double>(table.energy * table.share) - share) < 0.015);
            }
    }

    TEST_CASE("a pane of glass reflects and lets through what its two sides do, to and fro, summed") {
        for (const float z : {1.0f, 0.5f, 0.1f, 1e-3f}) {
            const ThinDielectricBsdf pane{1.5f, Rgb(1.0f, 0.8f, 0.0f)};
            const auto parts = pane.parts(z);
            const double f = fresnel_dielectric(static_cast<double>(z), 1.5);
            const double cos_t = std::sqrt(cos2_refracted(static_cast<double>(z), 1.5));
            for (std::size_t c = 0; c < 3; ++c) {
                const double t = std::pow(static_cast<double>(pane.tint[c]), 1 / cos_t);
                double through = 0, back = f, inside = 1 - f; // towards the far side
                for (int i = 0; i < 4000; ++i) {
                    inside *= t;
                    (i % 2 == 0 ? through : back) += inside * (1 - f);
                    inside *= f;
                }
                CHECK(static_cast<double>(parts.transmitted[c]) == doctest::Approx(through).epsilon(2e-4));
                CHECK(static_cast<double>(parts.reflected[c]) == doctest::Approx(back).epsilon(2e-4));
            }
        }
    }

    TEST_CASE("clay: what is reflected is the sum of its samples; at roughness 0 it is Lambert's") {
        for (const float z : {1.0f, 0.6f, 0.1f}) {
            const RoughDiffuseBsdf clay{Rgb(0.7f, 0.5f, 1.0f), 0.8f};
            const Rgbd sum = albedo(clay, direction(z, 0.3f), TransportMode::kRadiance, 8192);
            for (std::size_t c = 0; c < 3; ++c)
                CHECK(sum[c] == doctest::Approx(static_cast<double>(clay.reflected(z)[c])).epsilon(0.003));
            const RoughDiffuseBsdf flat{Rgb(0.7f), 0};
            CHECK(flat.eval(direction(z, 1), direction(0.4f, 2), TransportMode::kRadiance).g ==
                  doctest::Approx(0.7f * kInvPi).epsilon(1e-5));
        }
    }

    TEST_CASE("float formulas agree with double ones from narrow to wide lobes and at grazing angles") {
        for (const float alpha : {1e-3f, 1e-2f, 0.1f, 1.0f})
            for (const float z : {1.0f, 0.9f, 0.1f, 1e-3f, 1e-7f})
                for (const float tilt : {0.0f, 0.5f, 1.0f, 3.0f}) { // of the normal, in units of alpha
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
                    // Definitions, in double: G₁ = 1/(1 + Λ), G₂ = 1/(1 + Λₒ + Λᵢ)
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

    TEST_CASE("descriptions become scattering functions; colours stay within [0, 1]; emission knows its side") {
        const TextureSet none;
        SurfacePoint point{};
        point.ng = {0, 0, 1};
        CHECK(std::get<MetalBsdf>(bsdf_at(Metal{{Rgb(2.0f, 0.5f, -1.0f)}, 0.5f}, none, point)).reflectance ==
              Rgb(1, 0.5f, 0));
        CHECK(std::get<MetalBsdf>(bsdf_at(Metal{{Rgb(1.0f)}, 0.5f}, none, point)).alpha == 0.25f);
        CHECK(is_specular(bsdf_at(Metal{}, none, point)));
        CHECK(is_specular(bsdf_at(Dielectric{}, none, point)));
        CHECK_FALSE(is_specular(bsdf_at(Dielectric{1.01f, {Rgb(1.0f)}, {0.5f}}, none, point)));
        CHECK(is_specular(bsdf_at(Dielectric{1.000001f, {Rgb(1.0f)}, {0.5f}}, none, point))); // bends no light
        CHECK_FALSE(is_specular(bsdf_at(Diffuse{}, none, point)));
        const Material lamp = Emissive{Rgb(3.0f), false, {Rgb(0.25f)}};
        CHECK(emitted(lamp, none, point, {0, 0.6f, 0.8f}) == Rgb(3.0f));
        CHECK(is_black(emitted(lamp, none, point, {0, 0.6f, -0.8f})));
        CHECK(emitted(Emissive{Rgb(3.0f), true, {}}, none, point, {0, 0.6f, -0.8f}) == Rgb(3.0f));
        CHECK(is_black(emitted(Diffuse{}, none, point, {0, 0, 1})));
        CHECK(base_color(lamp, none, point) == Rgb(0.25f));
        CHECK(base_color(Dielectric{1.5f, {Rgb(0.5f)}}, none, point) == Rgb(0.5f));
    }
}

TEST_SUITE("statistical") {
    TEST_CASE("directions are distributed as pdf says, from both sides") {
        // Odds of a false alarm 1e-4 for all together.
        const float cosines[] = {1.0f, 0.6f, 0.1f, 1e-3f, -0.6f};
        std::vector<Named> materials = rough_materials();
        for (Named& frosted : frosted_materials()) materials.push_back(std::move(frosted));
        const int tests = static_cast<int>(materials.size() * std::size(cosines));
        for (const Named& m : materials)
            for (const float z : cosines) {
                const Vec3 wo = direction(z, 0.9f);
                // Cells close in on the mirror direction, where a narrow lobe is.
                compare::DirectionTest setup;
                if (!is_diffuse(m.bsdf)) setup.axis = {-wo.x, -wo.y, wo.z}, setup.axis_power = m.narrowest < 0.1f ? 4 : 2;
                setup.samples = 50'000;
                // The density jumps at the horizon, and at the critical angle, which cut through cells.
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
                              result.chi_squared.account);
                CHECK(result.integral < 1.003);
                CHECK(result.integral > m.found);
            }
    }

    TEST_CASE("GGX: ∫ D cos = 1, and visible normals have the density G₁ max(0, w·h) D / cos") {
        for (const double alpha : {1e-3, 0.05, 0.5, 1.0}) {
            // Over t = tan²/α², ∫ D cos dω = ∫ 1/(1 + t)² dt: midpoint rule in s = t/(1 + t), in which the integrand
            // is 1.
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
                CHECK_MESSAGE(result.chi_squared.p_value > compare::sidak_level(1e-4, 9), result.chi_squared.account);
            }
    }

    TEST_CASE("the mean weight is the integral of eval·cos: sampling leaves nothing out but what falls below") {
        // Two independent estimates of the albedo, by the material's own samples and by uniform directions; 4.5
        // standard errors, odds of a false alarm 7e-6 a comparison.
        std::vector<Named> materials = rough_materials();
        for (Named& frosted : frosted_materials()) materials.push_back(std::move(frosted));
        for (const Named& m : materials)
            for (const float z : {0.9f, 0.3f, -0.6f}) {
                const Vec3 wo = direction(z, 0.4f);
                constexpr int kSamples = 100'000;
                Sampler sampler(SamplerKind::kIndependent, 3, kSamples);
                double own = 0, own2 = 0, uniform = 0, uniform2 = 0;
                for (int i = 0; i < kSamples; ++i) {
                    sampler.start(0, 0, static_cast<std::uint32_t>(i));
                    const float lobe = sampler.get_1d();
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
