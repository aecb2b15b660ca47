// These are white furnace tests: if nothing absorbs light and light comes from all directions, the object is
// invisible.
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

struct Case {
    std::string name;
    Shape shape;
    Material material;
    bool diffuse;
};

std::vector<Case> lossless_cases() {
    const Diffuse white{{Rgb(1.0f)}};
    const Metal mirror{{Rgb(1.0f)}, 0};
    const Dielectric glass{1.5f, {Rgb(1.0f)}};
    const Shape sphere = Sphere{{0, 0, 0}, 1}, box = box_quads({-0.7f, -0.7f, -0.7f}, {0.7f, 0.7f, 0.7f}),
                mesh = icosphere(2);
    return {{"white sphere", sphere, white, true},  {"mirror sphere", sphere, mirror, false},
            {"glass sphere", sphere, glass, false}, {"white box", box, white, true},
            {"mirror box", box, mirror, false},     {"glass box", box, glass, false},
            {"white mesh", mesh, white, true},      {"mirror mesh", mesh, mirror, false},
            {"glass mesh", mesh, glass, false}};
}

/// Returns layered materials, which are lossless up to the error of the microfacet energy tables.
std::vector<Case> layered_cases() {
    const Shape sphere = Sphere{{0, 0, 0}, 1};
    Diffuse clay{{Rgb(1.0f)}};
    clay.roughness = 1;
    Principled wax;
    wax.metallic = 0;
    wax.clearcoat = 0.5f;
    wax.subsurface = 0.5f;
    wax.mean_free_path = Rgb(0.1f);
    Principled coated_wax = wax;
    coated_wax.subsurface = coated_wax.clearcoat = 1;
    coated_wax.roughness = 0.1f;
    Dielectric thin;
    thin.thin = true;
    return {{"rough white metal", sphere, Metal{{Rgb(1.0f)}, 1}, true},
            {"satin white metal", sphere, Metal{{Rgb(1.0f)}, 0.5f}, true},
            {"white clay", sphere, clay, true},
            {"white plastic", sphere, Coated{{Rgb(1.0f)}, 0.3f}, true},
            {"rough white plastic", sphere, Coated{{Rgb(1.0f)}, 0.9f}, true},
            {"white marble", sphere, Coated{{Rgb(1.0f)}, 0.3f, 1.5f, Rgb(0.03f, 0.3f, 3)}, true},
            {"half white wax", sphere, wax, true},
            {"white wax under a clear coat", sphere, coated_wax, true},
            {"thin glass", sphere, thin, true}};
}

Scene furnace(const Case& c) {
    SceneBuilder builder;
    builder.add(c.shape, builder.material(c.material));
    builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
    builder.scene.camera.eye = {1.5, 1, 4};
    return builder.finish();
}

double largest_deviation(const ImageRgb& image, Rgb expected) {
    double largest = 0;
    for (const Rgb& pixel : image)
        for (std::size_t channel = 0; channel < 3; ++channel)
            largest = std::max(largest, std::abs(static_cast<double>(pixel[channel] - expected[channel])));
    return largest;
}

// Returns the inside of a sphere that emits E and reflects the fraction a of light. Every point has the same radiance
// L. After d scattering events L = E (1 + a + … + a^d), whatever the directions.
Scene glowing_cavity(float albedo) {
    SceneBuilder builder;
    builder.add(Sphere{{0, 0, 0}, 2}, builder.material(Emissive{Rgb(1.0f), true, {Rgb(albedo)}}));
    builder.scene.camera.eye = {0.5, 0.3, 1};
    return builder.finish();
}

} // namespace

TEST_SUITE("unit") {

    // Every sample that leaves the object is exact up to rounding. Total internal reflection keeps some paths between
    // the facets of a glass mesh for hundreds of events.
    TEST_CASE("naive path tracing of lossless surfaces in a constant environment: 1 without variance") {
        for (const Case& c : lossless_cases()) {
            CAPTURE(c.name);
            PathTracerSettings settings;
            settings.integrator = Integrator::kNaive;
            settings.russian_roulette = false;
            settings.max_depth = 100000;
            settings.samples_per_pixel = 4;
            const Rendering rendering = render_scene(furnace(c), 32, settings);
            CHECK(largest_deviation(rendering.radiance, Rgb(1.0f)) < 1e-5);
            CHECK(rendering.statistics.invalid_samples == 0);
        }
    }

    TEST_CASE("path tracing of mirrors and glass in a constant environment: 1 without variance, too") {
        for (const Case& c : lossless_cases()) {
            if (c.diffuse) continue;
            CAPTURE(c.name);
            PathTracerSettings settings;
            settings.samples_per_pixel = 4;
            settings.max_depth = 100000;
            settings.russian_roulette = false;
            CHECK(largest_deviation(render_scene(furnace(c), 32, settings).radiance, Rgb(1.0f)) < 1e-5);
        }
    }

    TEST_CASE("in a glowing cavity each scattering event adds its power of the albedo: the depth limit counts them") {
        const Scene scene = glowing_cavity(0.5f);
        PathTracerSettings settings;
        settings.integrator = Integrator::kNaive;
        settings.russian_roulette = false;
        settings.samples_per_pixel = 2;
        double expected = 0;
        for (int depth = 0; depth <= 6; ++depth) {
            CAPTURE(depth);
            expected += std::pow(0.5, depth);
            settings.max_depth = depth;
            const Rendering rendering = render_scene(scene, 16, settings);
            CHECK(largest_deviation(rendering.radiance, Rgb(static_cast<float>(expected))) < 1e-5);
            CHECK(rendering.statistics.indirect_rays == depth * rendering.statistics.camera_rays);
            CHECK(rendering.statistics.shadow_rays == 0);
        }
    }
}

TEST_SUITE("statistical") {

    // The render has 32 x 32 pixels of 64 samples. The standard error of the mean, measured over seeds, is below
    // 1.5e-4 in all cases, so the bound is more than ten standard errors.
    TEST_CASE("path tracing of white surfaces in a constant environment: 1 ± 0.002, layers and rough metal ± 0.006") {
        std::vector<Case> cases = lossless_cases();
        const std::size_t plain = cases.size();
        for (Case& layered : layered_cases()) cases.push_back(std::move(layered));
        for (const Case& c : cases) {
            if (!c.diffuse) continue;
            CAPTURE(c.name);
            PathTracerSettings settings;
            settings.samples_per_pixel = 64;
            settings.aovs.hit = true;
            const Rendering r = render_scene(furnace(c), 32, settings);
            double sum = 0; // over the object only, as the background is 1 anyway
            int pixels = 0;
            for (std::size_t i = 0; i < r.hit.size(); ++i)
                if (r.hit[i].valid()) {
                    sum += static_cast<double>(r.radiance[i].g);
                    ++pixels;
                }
            REQUIRE(pixels > 100);
            CHECK(sum / pixels ==
                  doctest::Approx(1).epsilon(&c - cases.data() < static_cast<std::ptrdiff_t>(plain) ? 0.002 : 0.006));
        }
    }

    // The bound is six standard errors over ten seeds, which is exceeded by chance once in 5,000 times.
    TEST_CASE("in a glowing cavity light sampling adds up to the same sums") {
        const Scene scene = glowing_cavity(0.5f);
        struct Sum {
            Integrator integrator;
            int depth;
            double expected;
        };
        for (const Sum& sum :
             {Sum{Integrator::kPath, 0, 1.0}, Sum{Integrator::kPath, 1, 1.5}, Sum{Integrator::kPath, 2, 1.75},
              Sum{Integrator::kPath, 3, 1.875}, Sum{Integrator::kPath, 64, 2.0}, Sum{Integrator::kDirect, 64, 1.5}}) {
            CAPTURE(sum.depth);
            PathTracerSettings settings;
            settings.integrator = sum.integrator;
            settings.max_depth = sum.depth;
            settings.samples_per_pixel = 16;
            const Estimate e = estimate(scene, 16, settings);
            CHECK(std::abs(e.mean - sum.expected) <= 6 * e.error + 1e-6);
            CHECK(e.error < 0.01);
        }
    }
}
