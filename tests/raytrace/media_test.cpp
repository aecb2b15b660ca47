// These tests check paths in media against closed forms and independent numerical integrals. Where a comparison is
// statistical, the estimate has ten seeds: it fails by chance if it is off by six standard errors, once in 5,000 times.
#include "raytrace/integrator/medium_sampling.h"

#include "common/image/bitwise_equal.h"
#include "common/sampling/hash.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

Medium fog(const Box3& box, Rgb scattering, Rgb absorption, float asymmetry = 0) {
    Medium medium;
    medium.box = box;
    medium.scattering = scattering;
    medium.absorption = absorption;
    medium.asymmetry = asymmetry;
    return medium;
}

/// Returns a scene whose camera looks along −z from z = 3·scale, through so narrow an angle that all pixels see the
/// same.
SceneBuilder looking_down_z(float scale = 1) {
    SceneBuilder builder;
    builder.scene.camera.eye = Vec3d(0, 0, 3) * static_cast<double>(scale);
    builder.scene.camera.look_at = {0, 0, 0};
    builder.scene.camera.fov_degrees = 0.01;
    builder.material(Diffuse{{Rgb(0.0f)}}); // a scene has a material
    return builder;
}
Box3 cube(float half) { return {Vec3(-half, -half, -half), Vec3(half, half, half)}; }

PathTracerSettings path_settings(int samples, int depth = 64) {
    PathTracerSettings settings;
    settings.samples_per_pixel = samples;
    settings.max_depth = depth;
    return settings;
}

void check_close(const Estimate& found, double truth, double tolerance = 1e-5) {
    CAPTURE(found.mean);
    CAPTURE(found.error);
    CAPTURE(truth);
    CHECK(std::abs(found.mean - truth) < 6 * found.error + tolerance * std::abs(truth));
    CHECK(found.error < 5e-3 * truth);
}

/// Holds means of a weight and their standard errors.
class WeightMean {
public:
    void add(double x) { ++count_, sum_ += x, squares_ += x * x; }
    double mean() const { return sum_ / count_; }
    double error() const { return std::sqrt((squares_ / count_ - sqr(mean())) / count_); }

private:
    double count_ = 0, sum_ = 0, squares_ = 0;
};

/// Returns the radiance that a fog without bounds within ±half of z scatters from a point light toward the camera, by
/// the midpoint rule: ∫ σs p(cos θ) exp(−σt (t + r)) I / r² dt.
double single_scattering(const Medium& medium, Vec3d light, double intensity, double half) {
    const double scattering = static_cast<double>(medium.scattering.g);
    const double extinction = scattering + static_cast<double>(medium.absorption.g);
    const int steps = 200000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double along = 2 * half * (i + 0.5) / steps; // from the front of the fog
        const Vec3d p(0, 0, half - along);
        const Vec3d to_light = light - p;
        const double r = length(to_light), cosine = -to_light.z / r;
        const double g = static_cast<double>(medium.asymmetry);
        const double phase = (1 - g * g) / (4 * kPiDouble * std::pow(1 + g * g - 2 * g * cosine, 1.5));
        sum += scattering * phase * std::exp(-extinction * (along + r)) * intensity / (r * r);
    }
    return sum * 2 * half / steps;
}

/// Returns Chandrasekhar's H(1) for isotropic scattering, by iteration of the form that converges for every albedo:
/// 1/H(μ) = √(1 − ϖ) + ½ϖ ∫ μ' H(μ') / (μ + μ') dμ' ("Radiative Transfer", 1950, §38).
double h_function_at_1(double albedo) {
    const int n = 400;
    std::vector<double> h(n, 1.0);
    const auto value = [&](double mu) {
        double integral = 0;
        for (int i = 0; i < n; ++i) {
            const double x = (i + 0.5) / n;
            integral += x * h[static_cast<std::size_t>(i)] / (mu + x) / n;
        }
        return 1 / (std::sqrt(1 - albedo) + 0.5 * albedo * integral);
    };
    for (int iteration = 0; iteration < 60; ++iteration) {
        std::vector<double> next(n);
        for (int i = 0; i < n; ++i) next[static_cast<std::size_t>(i)] = value((i + 0.5) / n);
        h = next;
    }
    return value(1);
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("Media that only absorb have no noise: the law of Beer and Lambert") {
        for (const float scale : {1e-6f, 1e-3f, 1.0f, 1e6f}) {
            CAPTURE(scale);
            SceneBuilder builder = looking_down_z(scale);
            builder.scene.environment = ConstantEnvironment{Rgb(2.0f)};
            builder.scene.media = {
                fog(cube(scale), Rgb(0.0f), Rgb(0.1f, 0.7f, 2) * (1 / scale)),
                fog({Vec3(-9, -9, -9) * scale, Vec3(9, 9, 0) * scale}, Rgb(0.0f), Rgb(0.02f / scale))};
            const Rgb color = render_scene(builder.finish(), 2, path_settings(3)).radiance(1, 1);
            const double shared = 9 * 0.02;
            CHECK(static_cast<double>(color.r) == doctest::Approx(2 * std::exp(-0.2 - shared)).epsilon(1e-5));
            CHECK(static_cast<double>(color.g) == doctest::Approx(2 * std::exp(-1.4 - shared)).epsilon(1e-5));
            CHECK(static_cast<double>(color.b) == doctest::Approx(2 * std::exp(-4 - shared)).epsilon(1e-5));
        }
    }

    TEST_CASE("A medium that glows has its radiance times what it absorbs") {
        SceneBuilder builder = looking_down_z();
        Medium flame = fog(cube(1), Rgb(0.0f), Rgb(1e-6f, 0.5f, 1e6f));
        flame.radiance = Rgb(3.0f);
        builder.scene.media = {flame};
        const Scene scene = builder.finish();
        for (const int depth : {0, 1, 64}) {
            const Rgb color = render_scene(scene, 2, path_settings(3, depth)).radiance(0, 1);
            CHECK(static_cast<double>(color.r) == doctest::Approx(6e-6).epsilon(1e-5));
            CHECK(static_cast<double>(color.g) == doctest::Approx(3 * (1 - std::exp(-1.0))).epsilon(1e-5));
            CHECK(static_cast<double>(color.b) == doctest::Approx(3).epsilon(1e-5));
        }
    }

    TEST_CASE("Glass displaces fog") {
        // Glass of index 1 does nothing else. The ray passes 4 m of fog, 2 of which are a ball of glass.
        SceneBuilder builder = looking_down_z();
        builder.add(Sphere{{0, 0, 0}, 1}, builder.material(Dielectric{1.0f, {Rgb(1.0f)}}));
        builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
        builder.scene.media = {fog(cube(2), Rgb(0.0f), Rgb(0.3f))};
        const Rgb color = render_scene(builder.finish(), 2, path_settings(3)).radiance(0, 0);
        CHECK(static_cast<double>(color.g) == doctest::Approx(std::exp(-0.6)).epsilon(1e-5));
    }

    TEST_CASE("A collision's weights have the mean of the exact integrals") {
        // Of one channel each: what arrives is exp(−(σs + σa) d), what is scattered is σs/(σs + σa) (1 − exp(…)).
        const Rgb cases[][2] = {{Rgb(0.5f), Rgb(0.0f)},
                                {Rgb(0.5f), Rgb(0.25f, 0.5f, 0)},
                                {Rgb(2, 0.5f, 0.1f), Rgb(0.0f, 0.1f, 0.4f)},
                                {Rgb(0.0f, 1e-3f, 1e6f), Rgb(1e-6f, 0.0f, 1)},
                                {Rgb(1, 0.999f, 1e-3f), Rgb(0.5f)}};
        const float distance = 1.5f;
        std::uint64_t seed = 0;
        for (const auto& [scattering, absorption] : cases) {
            ++seed;
            CAPTURE(seed);
            // Two media, one of which is thinner than the distance, have the same sum there.
            const std::vector<Medium> media = {
                fog({Vec3(-1, -1, -1), Vec3(1, 1, distance)}, scattering * 0.25f, absorption),
                fog(Medium::unbounded(), scattering * 0.75f, Rgb(0.0f), 0.5f)};
            WeightMean arrived[3], scattered[3];
            WeightMean asymmetry;
            for (std::uint64_t i = 0; i < 200000; ++i) {
                Rgb throughput(1, 0.5f, 2), emitted;
                const float u = unit_float(high_bits(stream_number(mix_bits(seed), i)));
                const auto collision =
                    sample_collision(media, Ray{{0, 0, 0}, {0, 0, 1}}, distance, u, throughput, emitted);
                CHECK(is_black(emitted));
                if (collision) CHECK((collision->t >= 0 && collision->t <= distance));
                if (collision) asymmetry.add(static_cast<double>(collision->asymmetry));
                for (std::size_t c = 0; c < 3; ++c) {
                    const double weight = static_cast<double>(throughput[c] / Rgb(1, 0.5f, 2)[c]);
                    arrived[c].add(collision ? 0 : weight);
                    scattered[c].add(collision ? weight : 0);
                }
            }
            for (std::size_t c = 0; c < 3; ++c) {
                CAPTURE(c);
                const double s = static_cast<double>(scattering[c]),
                             extinction = s + static_cast<double>(absorption[c]);
                const double through = std::exp(-extinction * static_cast<double>(distance));
                const double lost =
                    extinction > 0 ? s / extinction * -std::expm1(-extinction * static_cast<double>(distance)) : 0;
                // One of these 30 comparisons fails by chance once in 58,000 times.
                CHECK(std::abs(arrived[c].mean() - through) <= 5 * arrived[c].error() + 1e-5 * through);
                CHECK(std::abs(scattered[c].mean() - lost) <= 5 * scattered[c].error() + 1e-5 * lost);
            }
            CHECK(std::abs(asymmetry.mean() - 0.375) < 5 * asymmetry.error());
        }
    }

    TEST_CASE("Distances of scattered light have their density") {
        const Ray ray{{1, -2, 0.5f}, {0, 0, 1}};
        struct {
            Vec3 light;
            Interval range;
            float extinction;
        } const cases[] = {{{2, 0, 3}, {0.5f, 8}, 0},           {{1, -2, 3}, {0, 5}, 0.2f},
                           {{1, -2.01f, 3}, {2, kInfinity}, 3}, {{1000, 0, 0}, {4, 4.001f}, 0},
                           {{1, 3, -1e4f}, {0, kInfinity}, 0},  {{1, -1, 1e6f}, {0, 1}, 50}};
        for (const auto& c : cases) {
            CAPTURE(c.light.x);
            CAPTURE(c.extinction);
            const Interval range = c.range;
            const ScatteringDistance distance(ray, c.light, range, c.extinction);
            std::vector<float> samples;
            for (int i = 0; i < 20000; ++i) samples.push_back(distance.sample((static_cast<float>(i) + 0.5f) / 20000));
            std::vector<float> sorted = samples;
            std::sort(sorted.begin(), sorted.end());
            CHECK(sorted.front() >= range.begin);
            CHECK(sorted.back() <= range.end);
            // The mean of 1/pdf over the samples below a limit is the length up to there.
            for (const std::size_t rank : {5000u, 10000u, 15000u, 19000u}) {
                CAPTURE(rank);
                double total = 0;
                for (const float t : samples)
                    if (t <= sorted[rank]) total += 1.0 / static_cast<double>(distance.pdf(t)) / 20000;
                CHECK(total == doctest::Approx(static_cast<double>(sorted[rank] - range.begin)).epsilon(0.02));
            }
        }
    }

    TEST_CASE("Images with media have the same bits for any number of threads") {
        SceneBuilder builder = looking_down_z();
        builder.scene.camera.fov_degrees = 60;
        builder.add(quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}), builder.material(Diffuse{{Rgb(0.6f)}}));
        builder.add(Sphere{{0.4f, 0, 0}, 0.5f}, builder.material(Dielectric{1.5f, {Rgb(1.0f)}}));
        builder.scene.lights = {PointLight{{-0.5f, 0.8f, 0}, Rgb(2.0f)}, SunLight{{0, -1, 0}, Rgb(1.0f)}};
        builder.scene.environment = SkyEnvironment{};
        builder.scene.media = {fog(cube(1.5f), Rgb(0.4f, 0.2f, 0.1f), Rgb(0.1f), 0.6f),
                               fog(cube(1), Rgb(0.2f), Rgb(0.0f))};
        const Scene scene = builder.finish();
        PathTracerSettings one = path_settings(4), three = path_settings(4);
        one.threads = 1;
        three.threads = 3;
        const ImageRgb a = render_scene(scene, 40, one).radiance, b = render_scene(scene, 40, three).radiance;
        CHECK(bitwise_equal(a, b));
        for (const Rgb& pixel : a) CHECK(is_finite(pixel));
    }
}

TEST_SUITE("statistical") {
    TEST_CASE("Light of a point light that fog scatters once equals a numerical integral") {
        for (const float scale : {1e-6f, 1.0f, 1e6f})
            for (const float g : {-0.7f, 0.0f, 0.9f})
                for (const float extinction : {0.05f, 1.0f, 30.0f}) {
                    CAPTURE(scale);
                    CAPTURE(g);
                    CAPTURE(extinction);
                    SceneBuilder builder = looking_down_z(scale);
                    const Medium medium =
                        fog(cube(scale), Rgb(0.8f * extinction / scale), Rgb(0.2f * extinction / scale), g);
                    builder.scene.media = {medium};
                    builder.scene.lights = {PointLight{Vec3(0.3f, 0.1f, 0.7f) * scale, Rgb(5 * scale * scale)}};
                    const double s = static_cast<double>(scale);
                    const double truth = single_scattering(medium, Vec3d(Vec3(0.3f, 0.1f, 0.7f) * scale), 5 * s * s, s);
                    check_close(estimate(builder.finish(), 4, path_settings(256, 1)), truth, 1e-4);
                }
    }

    TEST_CASE("Fog that absorbs nothing is invisible in a white furnace") {
        for (const float g : {-0.8f, 0.0f, 0.8f})
            for (const float scattering : {0.1f, 3.0f}) {
                CAPTURE(g);
                SceneBuilder builder = looking_down_z();
                builder.scene.camera.fov_degrees = 50;
                builder.add(Sphere{{0.2f, 0, 0}, 0.4f}, builder.material(Diffuse{{Rgb(1.0f)}}));
                builder.add(Sphere{{-0.6f, 0.3f, 0}, 0.3f}, builder.material(Dielectric{1.5f, {Rgb(1.0f)}}));
                builder.scene.media = {fog(cube(1), Rgb(0.5f * scattering, scattering, 0.0f), Rgb(0.0f), g)};
                builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
                PathTracerSettings settings = path_settings(64, 1000);
                check_close(estimate(builder.finish(), 16, settings), 1);
            }
    }

    TEST_CASE("A deep layer of fog reflects what Chandrasekhar's H function says") {
        // The camera and a sun look straight down at 30 mean free paths of fog, 100 times as wide as deep.
        const float albedo = 0.9f;
        SceneBuilder builder = looking_down_z();
        builder.scene.media = {fog({{-1000, -1000, -30}, {1000, 1000, 0}}, Rgb(albedo), Rgb(1 - albedo))};
        builder.scene.lights = {SunLight{{0, 0, -1}, Rgb(1.0f)}};
        const double h = h_function_at_1(static_cast<double>(albedo));
        const double truth = static_cast<double>(albedo) / (4 * kPiDouble) * 0.5 * h * h;
        check_close(estimate(builder.finish(), 8, path_settings(1024, 1000)), truth, 1e-3);
    }

    TEST_CASE("All ways to find light in fog agree") {
        // The naive path tracer finds area lights and the environment by chance.
        for (const float g : {0.0f, 0.8f}) {
            SceneBuilder builder = looking_down_z();
            builder.scene.camera.fov_degrees = 40;
            const std::uint32_t white = builder.material(Diffuse{{Rgb(0.7f)}});
            builder.add(quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}), white);
            builder.add(Sphere{{0, -0.3f, 0}, 0.4f}, builder.material(Metal{{Rgb(0.9f)}, 0.4f}));
            builder.add(quad({-0.5f, 0.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}), builder.material(Emissive{Rgb(6.0f)}));
            builder.scene.environment = SkyEnvironment{Rgb(0.2f), Rgb(0.5f)};
            builder.scene.media = {fog(cube(1.2f), Rgb(0.9f, 0.5f, 0.3f), Rgb(0.1f), g)};
            const Scene scene = builder.finish();
            PathTracerSettings naive = path_settings(1024);
            naive.integrator = Integrator::kNaive;
            const Estimate a = estimate(scene, 16, path_settings(256)), b = estimate(scene, 16, naive);
            CAPTURE(a.mean);
            CAPTURE(b.mean);
            CHECK(deviations(a, b) < 6);
            CHECK(b.error < 5e-3 * b.mean);
        }
    }
}
