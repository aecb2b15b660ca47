// These tests check how a path samples media along one ray, against closed forms and numerical integrals.
#include "raytrace/integrator/medium_sampling.h"
#include "raytrace/integrator/scattered_light.h"
#include "tests/raytrace/media.h"
#include "tests/support/random.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;
using duet::test::Random;

namespace {

/// Holds the mean of a color and its standard error.
class MeanColor {
public:
    void add(const Rgb& color) { ++count_, sum_ += Rgbd(color), squares_ += Rgbd(color) * Rgbd(color); }
    double mean(std::size_t c) const { return sum_[c] / count_; }
    double error(std::size_t c) const {
        return std::sqrt(std::max(squares_[c] / count_ - sqr(mean(c)), 0.0) / count_);
    }
    /// Checks each channel with a tolerance of five standard errors and this fraction of the true value.
    void check(const Rgbd& truth, double tolerance = 1e-5) const {
        for (std::size_t c = 0; c < 3; ++c) {
            CAPTURE(c);
            CHECK(std::abs(mean(c) - truth[c]) <= 5 * error(c) + tolerance * truth[c]);
        }
    }

private:
    double count_ = 0;
    Rgbd sum_, squares_;
};

/// Holds the weights of samples that pass media without a collision, and of those that collide.
struct CollisionWeights {
    MeanColor passed, scattered;

    void add(bool collides, const Rgb& weight) {
        passed.add(collides ? Rgb() : weight);
        scattered.add(collides ? weight : Rgb());
    }
    /// Checks them against exp(−(σs + σa) column) and σs/(σs + σa) (1 − exp(…)).
    void check(const Rgb& scattering, const Rgb& absorption, double column) const {
        Rgbd through, lost;
        for (std::size_t c = 0; c < 3; ++c) {
            const double s = static_cast<double>(scattering[c]), extinction = s + static_cast<double>(absorption[c]);
            through[c] = std::exp(-extinction * column);
            lost[c] = extinction > 0 ? s / extinction * -std::expm1(-extinction * column) : 0;
        }
        passed.check(through);
        scattered.check(lost);
    }
};

} // namespace

TEST_SUITE("unit") {
    TEST_CASE("A collision's weights have the mean of the exact integrals") {
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
            Random random(seed);
            CollisionWeights weights;
            MeanColor asymmetry;
            for (int i = 0; i < 200000; ++i) {
                Rgb throughput(1, 0.5f, 2), emitted;
                MediaOnRay on_ray(media, Ray{{0, 0, 0}, {0, 0, 1}}, distance);
                const auto collision = sample_collision(on_ray, random(), throughput, emitted);
                CHECK(is_black(emitted));
                if (collision) CHECK((collision->t >= 0 && collision->t <= distance));
                if (collision) asymmetry.add(Rgb(collision->asymmetry));
                weights.add(collision.has_value(), throughput / Rgb(1, 0.5f, 2));
            }
            // One of these 30 comparisons fails by chance once in 58,000 times.
            weights.check(scattering, absorption, static_cast<double>(distance));
            asymmetry.check(Rgbd(0.375), 0);
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
            Random random(12);
            MeanColor found;
            for (int i = 0; i < 100000; ++i) found.add(estimate_transmittance(media, ray, 2, random()));
            found.check(Rgbd(exact)); // one of these 9 comparisons fails by chance once in 190,000 times
        }
    }

    TEST_CASE("A collision's weights have the mean of the exact integrals in a cloud, too") {
        // How much is scattered along a ray depends on the column alone.
        Medium cloud = bell(cube(1), 1);
        cloud.scattering = Rgb(3, 1, 0.2f);
        cloud.absorption = Rgb(0.0f, 0.5f, 2);
        const Medium media[] = {cloud};
        const Ray ray{{0.2f, -0.1f, -1}, {0, 0, 1}};
        const double column = static_cast<double>(column_of(cloud, ray.origin, ray.direction, Interval{0, 2}));
        Random random(9);
        CollisionWeights weights;
        double density = 0, mean_density = 0;
        constexpr int kSamples = 200000;
        for (int i = 0; i < kSamples; ++i) {
            Rgb throughput(1, 1, 1), emitted;
            MediaOnRay on_ray(media, ray, 3);
            const auto collision = sample_collision(on_ray, random(), throughput, emitted);
            weights.add(collision.has_value(), throughput);
            if (collision) density += static_cast<double>(throughput.g * density_at(cloud, ray.at(collision->t)));
        }
        // One of these 6 comparisons fails by chance once in 290,000 times.
        weights.check(cloud.scattering, cloud.absorption, column);
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
        Random random(10);
        MeanColor found;
        for (int i = 0; i < 100000; ++i) {
            Rgb throughput(1, 1, 1), emitted;
            MediaOnRay on_ray(media, ray, 2);
            sample_collision(on_ray, random(), throughput, emitted);
            found.add(emitted);
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
        found.check(truth, 1e-3);
        for (std::size_t c = 0; c < 3; ++c) CHECK(found.error(c) < 0.01 * truth[c]);
    }
}
