// These tests compare estimates with exact values, both of parts of the estimators and of whole renders. Each
// estimate has a million independent samples, so the standard error of the mean follows from their variance. Three
// standard errors are exceeded by chance once in 370 times, and once in 260 for a mean over 64 seeds. One of these 55
// comparisons therefore fails by chance once in 5 times. The seeds are fixed. If a change of the random numbers makes
// one comparison fail, a different seed shows whether that was chance.
#include "common/light/environment.h"
#include "tests/support/form_factor.h"
#include "raytrace/sampling/sampler.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

#include <array>
#include <string>

using namespace duet;
using namespace duet::raytrace;

namespace {

constexpr int kSamples = 1 << 20, kSeeds = 64, kSide = 16;
constexpr float kAlbedo = 0.6f;

struct Known {
    std::string name;
    Scene scene;
    double radiance; ///< mean over the image
};

// Float arithmetic has a relative error of a few millionths, which is the same for all samples.
void check(const Estimate& found, double truth) {
    CAPTURE(found.mean);
    CAPTURE(found.error);
    CAPTURE(truth);
    CHECK(std::abs(found.mean - truth) <= 3 * found.error + 4e-6 * truth);
    CHECK(found.error < 4e-3 * truth);
}

class Mean {
public:
    void add(double value) { ++count_, sum_ += value, squares_ += value * value; }
    Estimate estimate() const {
        const double mean = sum_ / count_;
        return {mean, std::sqrt(std::max(0.0, squares_ / count_ - mean * mean) / (count_ - 1))};
    }

private:
    double count_ = 0, sum_ = 0, squares_ = 0;
};

// Returns a floor with an orthographic camera above the origin, which views a square of it at the given cosine to the
// normal.
SceneBuilder floor_seen(Material material, double seen, double cosine = 1) {
    SceneBuilder builder;
    const std::uint32_t floor = builder.material(std::move(material));
    builder.add(quad({-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1}), floor);
    Camera& camera = builder.scene.camera;
    camera.projection = Camera::Projection::kOrthographic;
    camera.eye = Vec3d(0, cosine, std::sqrt(1 - cosine * cosine)) * 0.4;
    camera.look_at = {0, 0, 0};
    camera.up = {0, cosine, -1};
    camera.height = seen;
    return builder;
}

constexpr double kSpot = 1e-3; // so small that the irradiance is constant over it

Known lit_spot(const std::string& name, const Shape& area_light) {
    SceneBuilder builder = floor_seen(Diffuse{{Rgb(kAlbedo)}}, kSpot);
    builder.add(area_light, builder.material(Emissive{Rgb(5.0f)}));
    Known known{name, builder.finish(), 0};
    for (const Light& light : known.scene.lights)
        known.radiance +=
            static_cast<double>(surface_light_irradiance(std::get<SurfaceLight>(light), {0, 0, 0}, {0, 1, 0}).g) *
            static_cast<double>(kAlbedo) / kPiDouble;
    return known;
}

std::vector<Known> lit_spots() {
    Mesh triangle;
    triangle.positions = {{-1, 1, -1}, {1, 1.5f, -1}, {0, 2, 1}};
    triangle.triangles = {{0, 1, 2}};
    std::vector<Known> all;
    all.push_back(lit_spot("quad", quad({-1, 1, -0.5f}, {2, 0.2f, 0}, {0, 0, 1})));
    all.push_back(lit_spot("quad across the horizon", quad({1, -0.5f, -0.5f}, {0, 0, 1}, {0, 2, 0})));
    all.push_back(lit_spot("triangle", triangle));
    all.push_back(lit_spot("sphere", Sphere{{0.5f, 1, 0.3f}, 0.7f}));
    all.push_back(lit_spot("sphere across the horizon", Sphere{{1.2f, 0.3f, 0}, 0.7f}));
    return all;
}

// The unit squares are parallel at distance 1 or share an edge at a right angle. The factors are C-11 and C-14 of
// Howell, "A Catalog of Radiation Heat Transfer Configuration Factors". A light of radiance 1 gives the other square
// the mean irradiance π × factor.
std::vector<Known> form_factors() {
    const double root2 = std::sqrt(2.0), root3 = std::sqrt(3.0);
    const double parallel = 2 / kPiDouble * (std::log(2 / root3) + 2 * root2 * std::atan(1 / root2) - kPiDouble / 2);
    const double upright = (2 * std::atan(1.0) - root2 * std::atan(1 / root2) + 0.25 * std::log(0.75)) / kPiDouble;
    std::vector<Known> all;
    for (const bool above : {true, false}) {
        SceneBuilder builder = floor_seen(Diffuse{{Rgb(kAlbedo)}}, 1);
        const QuadList area_light =
            above ? quad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}) : quad({-0.5f, 0, -0.5f}, {1, 0, 0}, {0, 1, 0});
        builder.add(area_light, builder.material(Emissive{Rgb(1.0f)}));
        all.push_back({above ? "parallel squares" : "squares at right angles", builder.finish(),
                       static_cast<double>(kAlbedo) * (above ? parallel : upright)});
    }
    return all;
}

struct Layer {
    std::string name;
    Material material;
};
std::vector<Layer> layers() {
    Metal metal;
    metal.roughness.value = 0.5f;
    Coated plastic;
    plastic.roughness.value = 0.4f;
    return {{"clay", Diffuse{{Rgb(kAlbedo)}, {0.7f}}}, {"rough metal", metal}, {"satin plastic", plastic}};
}

Bsdf bsdf_of(const Material& material) { return bsdf_at(material, TextureSet(), SurfacePoint{}); }
Vec3 slanted(double cosine) {
    return {0, static_cast<float>(std::sqrt(1 - cosine * cosine)), static_cast<float>(cosine)};
}

// Integrates eval·cos over the hemisphere with the midpoint rule in sin² and the azimuth.
double albedo_by_quadrature(const Bsdf& bsdf, Vec3 wo) {
    constexpr int kRings = 1200, kSectors = 1200;
    double sum = 0;
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
            const double sine2 = (i + 0.5) / kRings, sine = std::sqrt(sine2),
                         phi = 2 * kPiDouble * (j + 0.5) / kSectors;
            const Vec3 wi(Vec3d(sine * std::cos(phi), sine * std::sin(phi), std::sqrt(1 - sine2)));
            sum += static_cast<double>(eval(bsdf, wo, wi).g);
        }
    return sum * kPiDouble / (kRings * kSectors); // cos dω = π d(sin²) dφ/2π
}

Estimate rendered(const Scene& scene, Integrator integrator) {
    PathTracerSettings settings;
    settings.integrator = integrator;
    settings.sampler = SamplerKind::kIndependent;
    settings.samples_per_pixel = kSamples / (kSeeds * kSide * kSide);
    settings.max_depth = 1;
    return estimate(scene, kSide, settings, kSeeds);
}

void check_rendered(const Known& known, std::initializer_list<Integrator> integrators) {
    CAPTURE(known.name);
    for (const Integrator integrator : integrators) {
        CAPTURE(static_cast<int>(integrator));
        check(rendered(known.scene, integrator), known.radiance);
    }
}

template <typename Value> Estimate sampled(const Value& value) {
    Sampler sampler(SamplerKind::kIndependent, 1, kSamples);
    Mean mean;
    for (int i = 0; i < kSamples; ++i) {
        sampler.start(0, 0, static_cast<std::uint32_t>(i));
        mean.add(value(sampler));
    }
    return mean.estimate();
}

} // namespace

TEST_SUITE("statistical") {

    TEST_CASE("irradiance under a polygon and a sphere: a million light samples, and as many of whole renders") {
        for (const Known& known : lit_spots()) {
            CAPTURE(known.name);
            REQUIRE(known.scene.lights.size() == 1);
            const Estimate parts = sampled([&](Sampler& sampler) {
                const auto s = sample_light(known.scene.lights[0], {0, 0, 0}, sampler.get_2d());
                return s ? static_cast<double>(s->radiance.g * std::max(0.0f, s->wi.y) / s->pdf) : 0.0;
            });
            check(parts, known.radiance * kPiDouble / static_cast<double>(kAlbedo));
            check_rendered(known,
                           {Integrator::kPath, Integrator::kDirect, Integrator::kNaive, Integrator::kUnshadowed});
        }
    }

    TEST_CASE("irradiance under the sun and a sky") {
        SceneBuilder sunny = floor_seen(Diffuse{{Rgb(kAlbedo)}}, kSpot);
        sunny.scene.lights.push_back(SunLight{normalize(Vec3(1, -2, 0.5f)), Rgb(3.0f)});
        const double sun = 3 * 2 / std::sqrt(5.25) * static_cast<double>(kAlbedo) / kPiDouble;
        check_rendered({"sun", sunny.finish(), sun}, {Integrator::kPath, Integrator::kDirect, Integrator::kUnshadowed});

        SceneBuilder clear = floor_seen(Diffuse{{Rgb(kAlbedo)}}, kSpot);
        clear.scene.environment = SkyEnvironment{};
        const double sky = static_cast<double>(irradiance_closed_form(clear.scene.environment, {0, 1, 0})->g) *
                           static_cast<double>(kAlbedo) / kPiDouble;
        check_rendered({"sky", clear.finish(), sky}, {Integrator::kPath, Integrator::kDirect, Integrator::kNaive});
    }

    TEST_CASE("form factors of squares that face each other, and of a floor and a wall") {
        for (const Known& known : form_factors())
            check_rendered(known, {Integrator::kPath, Integrator::kDirect, Integrator::kNaive});
    }

    TEST_CASE("albedos: the mean weight of a million samples of a material, and a floor of it in an even light") {
        for (const Layer& layer : layers())
            for (const double cosine : {0.9, 0.4}) {
                CAPTURE(layer.name);
                CAPTURE(cosine);
                const Bsdf bsdf = bsdf_of(layer.material);
                const Vec3 wo = slanted(cosine);
                const double albedo = albedo_by_quadrature(bsdf, wo);
                check(sampled([&](Sampler& sampler) {
                          const float lobe = sampler.get_2d().x;
                          const auto s = sample(bsdf, wo, lobe, sampler.get_2d());
                          return s ? static_cast<double>(s->weight.g) : 0.0;
                      }),
                      albedo);
                SceneBuilder builder = floor_seen(layer.material, kSpot, cosine);
                builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
                check_rendered({layer.name, builder.finish(), albedo}, {Integrator::kPath, Integrator::kNaive});
            }
    }
}
