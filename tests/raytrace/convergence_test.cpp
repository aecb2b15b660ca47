// These tests check that errors decrease with the sample count at the expected rate, up to 65,536 samples, without a
// lower limit. The reference images are known in double precision.
#include "raytrace/render.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/integrating_sphere.h"

#include <doctest/doctest.h>

#include <array>
#include <string>

using namespace duet;
using namespace duet::raytrace;

namespace {

constexpr int kSide = 8; // pixels

// The scene is a floor viewed straight from above and a light beside the visible part.
constexpr double kAlbedo = 0.5, kLightRadiance = 4;
constexpr std::array<Vec3d, 4> kAreaLight{Vec3d(-1.6, 0.2, 0.8), Vec3d(-1.6, 0.2, -0.8), Vec3d(-1.6, 1.2, -0.8),
                                          Vec3d(-1.6, 1.2, 0.8)};

Scene lit_floor() {
    SceneBuilder builder;
    builder.add(quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}), builder.material(Diffuse{{Rgb(static_cast<float>(kAlbedo))}}));
    const std::uint32_t area_light = builder.material(Emissive{Rgb(static_cast<float>(kLightRadiance))});
    builder.add(quad(Vec3(kAreaLight[0]), Vec3(kAreaLight[1] - kAreaLight[0]), Vec3(kAreaLight[3] - kAreaLight[0])),
                area_light);
    Camera& camera = builder.scene.camera;
    camera.projection = Camera::Projection::kOrthographic;
    camera.eye = {0, 5, 0};
    camera.look_at = {0, 0, 0};
    camera.up = {0, 0, -1};
    camera.height = 2;
    return builder.finish();
}

// Returns the irradiance at a point of the floor by Lambert's formula for a polygon above the horizon (1760).
double irradiance(Vec3d p) {
    double sum = 0;
    for (std::size_t i = 0; i < kAreaLight.size(); ++i) {
        const Vec3d a = normalize(kAreaLight[i] - p), b = normalize(kAreaLight[(i + 1) % kAreaLight.size()] - p);
        const Vec3d normal = cross(a, b);
        sum += std::atan2(length(normal), dot(a, b)) * normalize(normal).y;
    }
    return std::abs(sum) * kLightRadiance / 2;
}

// Returns the mean radiance of the floor over each pixel. Gauss-Legendre quadrature with 5 × 5 points is exact to
// 1e-9 for such a smooth function.
Image<double> floor_truth() {
    constexpr std::array<double, 5> at{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                       0.9061798459386640};
    constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                           0.4786286704993665, 0.2369268850561891};
    Image<double> truth(kSide, kSide);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            for (std::size_t i = 0; i < 5; ++i)
                for (std::size_t j = 0; j < 5; ++j) {
                    const Vec3d p(-1 + (2 * x + 1 + at[i]) / kSide, 0, -1 + (2 * y + 1 + at[j]) / kSide);
                    truth(x, y) += weight[i] * weight[j] / 4 * irradiance(p) * kAlbedo / kPiDouble;
                }
    return truth;
}

Image<double> sphere_truth() {
    return {kSide, kSide, kIntegratingSphere};
}

// Returns the mean squared error over pixels and seeds.
double squared_error(const PathTracerScene& prepared, const Scene& scene, const Image<double>& truth,
                     PathTracerSettings settings) {
    constexpr int kSeeds = 2;
    double sum = 0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
        settings.seed = static_cast<std::uint64_t>(seed);
        Control control;
        const ImageRgb image = render(prepared, View{scene.camera, kSide, kSide}, settings, control).radiance;
        for (std::size_t i = 0; i < truth.size(); ++i) sum += sqr(static_cast<double>(image[i].g) - truth[i]);
    }
    return sum / (kSeeds * static_cast<double>(truth.size()));
}

// Returns the slope of a line through points whose sample counts increase by factors of 4.
double slope(const std::vector<double>& log_errors) {
    const double n = static_cast<double>(log_errors.size()), middle = (n - 1) / 2;
    double across = 0, along = 0;
    for (std::size_t i = 0; i < log_errors.size(); ++i) {
        const double t = static_cast<double>(i) - middle;
        across += t * log_errors[i];
        along += t * t;
    }
    return across / along / std::log(4.0);
}

void check_slope(const std::string& name, const PathTracerScene& prepared, const Scene& scene,
                 const Image<double>& truth, PathTracerSettings settings) {
    std::vector<double> log_errors; // of the root mean squared error
    for (int spp = 16; spp <= 65536; spp *= 4) {
        settings.samples_per_pixel = spp;
        log_errors.push_back(0.5 * std::log(squared_error(prepared, scene, truth, settings)));
    }
    // For normal errors a mean of 128 squares has a relative standard deviation of √(2/128), and the logarithm of its
    // root half of that: 0.063. For the slopes of seven points and of the last three that gives 0.063/(ln 4 √28) =
    // 0.0085 and 0.063/(ln 4 √2) = 0.032. The bounds are five times these values, because the tails are heavier than
    // a normal distribution's.
    const double all = slope(log_errors), last = slope({log_errors.end() - 3, log_errors.end()});
    MESSAGE(name, ": slope ", all, ", of the last three points ", last, ", error at 65536 ",
            std::exp(log_errors.back()));
    CHECK(all < -0.5 + 0.043);
    CHECK(last < -0.5 + 0.16);
}

} // namespace

TEST_SUITE("statistical") {

    TEST_CASE("direct light: every sampler, estimator and schedule converges to Lambert's formula") {
        const Scene scene = lit_floor();
        const Image<double> truth = floor_truth();
        const PathTracerScene prepared = prepare(scene, {});
        for (const SamplerKind sampler :
             {SamplerKind::kSobol, SamplerKind::kBlueNoise, SamplerKind::kStratified, SamplerKind::kIndependent}) {
            PathTracerSettings settings;
            settings.sampler = sampler;
            check_slope(message("path, ", sampler_name(sampler)), prepared, scene, truth, settings);
        }
        PathTracerSettings settings;
        settings.integrator = Integrator::kNaive;
        check_slope("naive, sobol", prepared, scene, truth, settings);
        settings.integrator = Integrator::kPath;
        settings.adaptive = true;
        check_slope("path, sobol, adaptive", prepared, scene, truth, settings);
    }

    TEST_CASE("light of many bounces, ended by roulette, converges to the integrating sphere's") {
        const Scene scene = integrating_sphere();
        const Image<double> truth = sphere_truth();
        const PathTracerScene prepared = prepare(scene, {});
        for (const SamplerKind sampler : {SamplerKind::kSobol, SamplerKind::kIndependent}) {
            PathTracerSettings settings;
            settings.sampler = sampler;
            check_slope(message("roulette, ", sampler_name(sampler)), prepared, scene, truth, settings);
        }
    }
}
