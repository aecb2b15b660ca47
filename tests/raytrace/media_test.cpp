// These tests check paths in media against closed forms and independent numerical integrals. Where a comparison is
// statistical, the estimate has ten seeds: it fails by chance if it is off by six standard errors, once in 5,000 times.
#include "raytrace/integrator/medium_sampling.h"
#include "raytrace/integrator/scattered_light.h"

#include "common/image/bitwise_equal.h"
#include "common/medium/density_grid.h"
#include "common/sampling/hash.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/h_function.h"
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

/// Returns a medium whose density is highest in the middle of its box and 0 on its sides.
Medium bell(const Box3& box, float scattering, float absorption = 0) {
    constexpr int kPoints = 21;
    std::vector<float> densities;
    const auto height = [](int i) { return std::sin(kPi * static_cast<float>(i) / (kPoints - 1)); };
    for (int z = 0; z < kPoints; ++z)
        for (int y = 0; y < kPoints; ++y)
            for (int x = 0; x < kPoints; ++x) densities.push_back(std::max(height(x) * height(y) * height(z), 0.0f));
    Medium medium = fog(box, Rgb(scattering), Rgb(absorption));
    medium.density = std::make_shared<const DensityGrid>(std::array{kPoints, kPoints, kPoints}, std::move(densities));
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
    double error() const { return std::sqrt(std::max(squares_ / count_ - sqr(mean()), 0.0) / count_); }

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
                MediaOnRay on_ray(media, Ray{{0, 0, 0}, {0, 0, 1}}, distance);
                const auto collision = sample_collision(on_ray, u, throughput, emitted);
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
        // A cloud is denser in its middle; the fog overlaps it.
        const Medium cloud = bell(cube(4), 1.0f), haze = fog({{-9, -9, 2}, {9, 9, 6}}, Rgb(0.1f), Rgb(0.1f));
        const Medium colored = fog(Medium::unbounded(), Rgb(3, 0.03f, 0.0f), Rgb(0.0f, 0.01f, 0.0f));
        const auto even = [](float extinction) { return fog(Medium::unbounded(), Rgb(extinction), Rgb(0.0f)); };
        struct {
            std::optional<Vec3> light;
            Interval range;
            std::vector<Medium> media;
        } const cases[] = {{Vec3(2, 0, 3), {0.5f, 8}, {even(1e-6f)}},
                           {Vec3(1, -2, 3), {0, 5}, {even(0.2f)}},
                           {Vec3(1, -2.01f, 3), {2, kInfinity}, {even(3)}},
                           {Vec3(1000, 0, 0), {4, 4.001f}, {even(1e-6f)}},
                           {Vec3(1, 3, -1e4f), {0, kInfinity}, {even(1e-6f)}},
                           {Vec3(1, -1, 1e6f), {0, 1}, {even(50)}},
                           {std::nullopt, {0.1f, 5}, {even(2)}},
                           {std::nullopt, {0, 3.4f}, {cloud}},
                           {Vec3(0.5f, -2, 1), {0.2f, 3}, {cloud}},
                           {std::nullopt, {0, 5.4f}, {cloud, haze}},
                           {std::nullopt, {0, 5}, {colored}}};
        for (std::size_t i = 0; i < std::size(cases); ++i) {
            CAPTURE(i);
            const auto& [light, range, media] = cases[i];
            MediaOnRay on_ray(media, ray, range.end);
            StoppedDistance stopped(on_ray, range);
            REQUIRE(stopped.possible());
            std::optional<EquiangularDistance> angle;
            if (light) angle.emplace(ray, range, *light);
            ScatteringDistance distance(stopped, angle);
            constexpr int kSamples = 20000;
            std::vector<float> samples;
            for (int k = 0; k < kSamples; ++k)
                if (const float t = distance.sample((static_cast<float>(k) + 0.5f) / kSamples); t < kInfinity)
                    samples.push_back(t);
            CHECK(samples.size() > 0.98 * kSamples); // a medium that stops 98 % may leave the rest without a sample
            std::vector<float> sorted = samples;
            std::sort(sorted.begin(), sorted.end());
            CHECK(sorted.front() >= range.begin);
            CHECK(sorted.back() <= range.end);
            // The mean of 1/pdf over the samples below a limit is the length up to there.
            for (const std::size_t rank : {5000u, 10000u, 15000u, 19000u}) {
                CAPTURE(rank);
                double total = 0;
                for (const float t : samples)
                    if (t <= sorted[rank]) total += 1.0 / static_cast<double>(distance.at(t).pdf) / kSamples;
                CHECK(total == doctest::Approx(static_cast<double>(sorted[rank] - range.begin)).epsilon(0.02));
                const Rgb exact = transmittance(media, ray, sorted[rank]);
                CHECK(distance.at(sorted[rank]).transmittance.g == doctest::Approx(exact.g).epsilon(1e-4));
            }
        }
    }

    TEST_CASE("Transmittance by Russian roulette has the mean of the exact one") {
        Medium cloud = bell(cube(1), 1);
        cloud.scattering = Rgb(2, 6, 3);
        cloud.absorption = Rgb(1, 0.5f, 0.0f);
        for (const float scale : {0.1f, 1.0f, 3.0f}) {
            CAPTURE(scale);
            Medium scaled = cloud;
            scaled.scattering = cloud.scattering * scale;
            const Medium media[] = {scaled, fog(cube(2), Rgb(0.1f), Rgb(0.0f))};
            const Ray ray{{0.2f, -0.1f, -1}, {0, 0, 1}};
            const Rgb exact = transmittance(media, ray, 2);
            WeightMean found[3];
            for (std::uint64_t i = 0; i < 100000; ++i) {
                const float u = unit_float(high_bits(stream_number(mix_bits(12), i)));
                const Rgb estimate = estimate_transmittance(media, ray, 2, u);
                for (std::size_t c = 0; c < 3; ++c) found[c].add(static_cast<double>(estimate[c]));
            }
            // One of these 9 comparisons fails by chance once in 190,000 times.
            for (std::size_t c = 0; c < 3; ++c)
                CHECK(std::abs(found[c].mean() - static_cast<double>(exact[c])) <=
                      5 * found[c].error() + 1e-5 * static_cast<double>(exact[c]));
        }
    }

    TEST_CASE("A collision's weights have the mean of the exact integrals in a cloud, too") {
        // What is scattered along a ray depends on the column alone: σs/(σs + σa) (1 − exp(−(σs + σa) column)).
        Medium cloud = bell(cube(1), 1);
        cloud.scattering = Rgb(3, 1, 0.2f);
        cloud.absorption = Rgb(0.0f, 0.5f, 2);
        const Medium media[] = {cloud};
        const Ray ray{{0.2f, -0.1f, -1}, {0, 0, 1}};
        const double column = static_cast<double>(column_of(cloud, ray.origin, ray.direction, Interval{0, 2}));
        WeightMean arrived[3], scattered[3];
        double density = 0, mean_density = 0;
        constexpr int kSamples = 200000;
        for (std::uint64_t i = 0; i < kSamples; ++i) {
            Rgb throughput(1, 1, 1), emitted;
            const float u = unit_float(high_bits(stream_number(mix_bits(9), i)));
            MediaOnRay on_ray(media, ray, 3);
            const auto collision = sample_collision(on_ray, u, throughput, emitted);
            for (std::size_t c = 0; c < 3; ++c) {
                arrived[c].add(collision ? 0 : static_cast<double>(throughput[c]));
                scattered[c].add(collision ? static_cast<double>(throughput[c]) : 0);
            }
            if (collision) density += static_cast<double>(throughput.g * density_at(cloud, ray.at(collision->t)));
        }
        for (std::size_t c = 0; c < 3; ++c) {
            const double s = static_cast<double>(cloud.scattering[c]),
                         sigma = s + static_cast<double>(cloud.absorption[c]);
            const double through = std::exp(-sigma * column), lost = s / sigma * (1 - through);
            // One of these 6 comparisons fails by chance once in 290,000 times.
            CHECK(std::abs(arrived[c].mean() - through) <= 5 * arrived[c].error() + 1e-5 * through);
            CHECK(std::abs(scattered[c].mean() - lost) <= 5 * scattered[c].error() + 1e-5 * lost);
        }
        // Where it is scattered: ∫ σs ρ² exp(−σ column(t)) dt by the midpoint rule.
        constexpr int kSteps = 2000;
        for (int i = 0; i < kSteps; ++i) {
            const float t = 2 * (static_cast<float>(i) + 0.5f) / kSteps;
            const double rho = static_cast<double>(density_at(cloud, ray.at(t)));
            const double before = static_cast<double>(column_of(cloud, ray.origin, ray.direction, Interval{0, t}));
            mean_density += rho * rho * std::exp(-1.5 * before) * 2 / kSteps;
        }
        CHECK(density / kSamples == doctest::Approx(mean_density).epsilon(0.01));
    }

    TEST_CASE("What overlapping media emit has the mean of its integral") {
        // Each alone has a closed form; together they need a sample. The truth is a sum over short steps.
        Medium flame = bell(cube(1), 0.5f, 2), glow = fog({{-1, -1, -0.5f}, {1, 1, 1}}, Rgb(1, 0.2f, 0.0f), Rgb(0.5f));
        flame.radiance = Rgb(1, 2, 0.5f);
        glow.radiance = Rgb(0.5f, 0.0f, 1);
        const Medium media[] = {flame, glow};
        const Ray ray{{0.2f, -0.1f, -1}, {0, 0, 1}};
        WeightMean found[3];
        for (std::uint64_t i = 0; i < 100000; ++i) {
            Rgb throughput(1, 1, 1), emitted;
            MediaOnRay on_ray(media, ray, 2);
            sample_collision(on_ray, unit_float(high_bits(stream_number(mix_bits(10), i))), throughput, emitted);
            for (std::size_t c = 0; c < 3; ++c) found[c].add(static_cast<double>(emitted[c]));
        }
        Rgbd truth;
        constexpr int kSteps = 4000;
        for (int i = 0; i < kSteps; ++i) {
            const float t = 2 * (static_cast<float>(i) + 0.5f) / kSteps;
            const Rgbd through(transmittance(media, ray, t));
            for (const Medium& medium : media) {
                if (!medium.box.contains(ray.at(t))) continue;
                const double density = static_cast<double>(density_at(medium, ray.at(t)));
                truth += through * Rgbd(medium.absorption * medium.radiance) * (density * 2 / kSteps);
            }
        }
        for (std::size_t c = 0; c < 3; ++c) {
            CHECK(std::abs(found[c].mean() - truth[c]) < 5 * found[c].error() + 1e-3 * truth[c]);
            CHECK(found[c].error() < 0.01 * truth[c]);
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
                               fog(cube(1), Rgb(0.2f), Rgb(0.0f)), bell(cube(0.7f), 3)};
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
    TEST_CASE("A sun's light that colored fog scatters once equals the integral of each channel") {
        // From a half space, that is σs/(4π) / (2 σt) for light along the view: also far behind the depth at which the
        // fog is opaque in another channel.
        SceneBuilder builder = looking_down_z();
        const Rgb scattering(3, 0.03f, 0.3f), absorption(1, 0.0f, 0.1f);
        builder.scene.media = {fog({{-1e4f, -1e4f, -1e4f}, {1e4f, 1e4f, 0}}, scattering, absorption)};
        builder.scene.lights = {SunLight{{0, 0, -1}, Rgb(1.0f)}};
        const Scene scene = builder.finish();
        Rgbd sum, squares;
        constexpr int kSeeds = 10;
        for (int seed = 0; seed < kSeeds; ++seed) {
            PathTracerSettings settings = path_settings(4096, 1);
            settings.seed = static_cast<std::uint64_t>(seed);
            const Rgbd color(render_scene(scene, 1, settings).radiance(0, 0));
            sum += color, squares += color * color;
        }
        for (std::size_t c = 0; c < 3; ++c) {
            const double s = static_cast<double>(scattering[c]), sigma = s + static_cast<double>(absorption[c]);
            const double truth = s / (8 * kPiDouble * sigma), mean = sum[c] / kSeeds;
            const double error = std::sqrt(std::max(squares[c] / kSeeds - mean * mean, 0.0) / kSeeds);
            CAPTURE(c);
            CHECK(std::abs(mean - truth) < 6 * error + 1e-4 * truth);
            CHECK(error < 0.01 * truth);
        }
    }

    TEST_CASE("Fog that is opaque at once scatters like a surface") {
        // What a sun scatters once is σs / (8π σt), however short the way is in floats.
        // From about 1e9 mean free paths on, the light's own way through the fog is lost to rounding.
        for (const float extinction : {1e3f, 1e6f, 1e9f, 1e12f}) {
            CAPTURE(extinction);
            SceneBuilder builder = looking_down_z();
            builder.scene.media = {fog(cube(1), Rgb(0.8f * extinction), Rgb(0.2f * extinction))};
            builder.scene.lights = {SunLight{{0, 0, -1}, Rgb(1.0f)}};
            const Estimate found = estimate(builder.finish(), 4, path_settings(256, 1));
            const double truth = 0.8 / (8 * kPiDouble);
            if (extinction < 1e8f) check_close(found, truth, 0.01);
            CHECK(found.mean > 0.99 * truth);
            CHECK(found.mean < 2.01 * truth);
        }
    }

    TEST_CASE("A spot light's single scattering in a cloud equals a numerical integral") {
        SceneBuilder builder = looking_down_z();
        const Medium cloud = bell(cube(1), 2, 0.5f);
        const Vec3 position(0.3f, 1.5f, 0.2f);
        const SpotLight spot{position, normalize(Vec3(-0.2f, -1, -0.1f)), Rgb(5.0f), 0.9f, 0.8f};
        builder.scene.media = {cloud};
        builder.scene.lights = {spot};
        double truth = 0;
        constexpr int kSteps = 4000;
        const Ray view{{0, 0, 3}, {0, 0, -1}};
        for (int i = 0; i < kSteps; ++i) {
            const float t = 2 + 2 * (static_cast<float>(i) + 0.5f) / kSteps;
            const Vec3 p = view.at(t);
            const std::optional<LightSample> light = sample_light(spot, p, {});
            if (!light) continue;
            const Rgb through = transmittance(builder.scene.media, view, t) *
                                transmittance(builder.scene.media, Ray{p, light->wi}, light->distance);
            truth +=
                static_cast<double>(2 * density_at(cloud, p) * kInvPi / 4 * (through * light->radiance).g) * 2 / kSteps;
        }
        REQUIRE(truth > 0);
        check_close(estimate(builder.finish(), 4, path_settings(4096, 1)), truth, 2e-3);
    }

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

    TEST_CASE("A cloud that absorbs nothing is invisible in a white furnace") {
        SceneBuilder builder = looking_down_z();
        builder.scene.camera.fov_degrees = 50;
        builder.add(Sphere{{0.2f, 0, 0}, 0.4f}, builder.material(Diffuse{{Rgb(1.0f)}}));
        Medium cloud = bell(cube(1), 8);
        cloud.asymmetry = 0.7f;
        builder.scene.media = {cloud, fog(cube(0.5f), Rgb(0.2f, 1, 0.5f), Rgb(0.0f))};
        builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
        check_close(estimate(builder.finish(), 16, path_settings(64, 1000)), 1);
    }

    TEST_CASE("A cloud of even density is fog") {
        for (const float scale : {1e-6f, 1.0f, 1e6f}) {
            CAPTURE(scale);
            const auto image_with = [&](std::shared_ptr<const DensityGrid> density) {
                SceneBuilder builder = looking_down_z(scale);
                builder.scene.camera.fov_degrees = 40;
                builder.add(Sphere{Vec3(0, -0.3f, 0) * scale, 0.4f * scale}, builder.material(Diffuse{{Rgb(0.7f)}}));
                builder.scene.lights = {PointLight{Vec3(0.5f, 0.6f, 0.2f) * scale, Rgb(5 * scale * scale)},
                                        SunLight{{-0.6f, -0.8f, 0}, Rgb(1.0f)}};
                builder.scene.environment = SkyEnvironment{Rgb(0.2f), Rgb(0.5f)};
                Medium medium = fog(cube(scale), Rgb(0.9f, 0.5f, 0.3f) * (1 / scale), Rgb(0.1f / scale), 0.5f);
                medium.density = std::move(density);
                builder.scene.media = {medium};
                return estimate(builder.finish(), 16, path_settings(256));
            };
            const Estimate a = image_with(nullptr);
            const Estimate b =
                image_with(std::make_shared<const DensityGrid>(std::array{5, 12, 20}, std::vector<float>(1200, 1.0f)));
            CAPTURE(a.mean);
            CAPTURE(b.mean);
            CHECK(deviations(a, b) < 6);
            CHECK(b.error < 5e-3 * b.mean);
        }
    }

    TEST_CASE("A deep layer of fog reflects what Chandrasekhar's H function says") {
        // The camera and a sun look straight down at 30 mean free paths of fog, 100 times as wide as deep.
        const float albedo = 0.9f;
        SceneBuilder builder = looking_down_z();
        builder.scene.media = {fog({{-1000, -1000, -30}, {1000, 1000, 0}}, Rgb(albedo), Rgb(1 - albedo))};
        builder.scene.lights = {SunLight{{0, 0, -1}, Rgb(1.0f)}};
        const double h = HFunction(static_cast<double>(albedo))(1);
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
            builder.scene.media = {fog(cube(1.2f), Rgb(0.9f, 0.5f, 0.3f), Rgb(0.1f), g), bell(cube(1), 1)};
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
