// These tests check absorbing and nested dielectrics.
#include "raytrace/integrator/medium_stack.h"
#include "raytrace/integrator/vertex.h"

#include "raytrace/render.h"
#include "tests/raytrace/estimates.h"
#include "tests/raytrace/scene_builder.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::raytrace;

namespace {

Dielectric glass(float ior, int priority, Rgb absorption = Rgb(0.0f), float roughness = 0) {
    Dielectric material{ior, {Rgb(1.0f)}, {roughness}};
    material.priority = priority;
    material.absorption = absorption;
    return material;
}

/// Builds a scene of two concentric spheres with radii 1 and ½.
struct Spheres {
    Scene scene;
    std::uint32_t outer, inner; // material indices

    Spheres(const Dielectric& outside, const Dielectric& inside) {
        SceneBuilder builder;
        outer = builder.material(outside);
        inner = builder.material(inside);
        builder.add(Sphere{{0, 0, 0}, 1}, outer);
        builder.add(Sphere{{0, 0, 0}, 0.5f}, inner);
        builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
        builder.scene.camera.eye = {0, 0, 4};
        scene = builder.finish();
    }
};

/// Follows a ray straight through the center and its interfaces.
class PathWalk {
public:
    explicit PathWalk(const Scene& scene)
        : prepared_(prepare(scene, settings_)), plan_(prepared_.data(), {scene.camera, 8, 8}, settings_),
          stack_(plan_), ray_{{0, 0, 4}, {0, 0, -1}} {
        hit_ = trace(prepared_, ray_);
    }
    /// Returns whether the current interface is specular.
    bool smooth() const { return is_specular(Vertex(plan_, ray_, hit_, nullptr, {relative}).bsdf); }
    /// Returns the z coordinate of the next interface that is not skipped, and stores its relative index of
    /// refraction in `relative`.
    float arrive() {
        hit_ = stack_.skip_ignored_boundaries(ray_, hit_, throughput, passed);
        relative = stack_.relative_index();
        return hit_.valid() ? ray_.at(hit_.t).z : -1e9f;
    }
    void enter(std::uint32_t material, bool inwards) { stack_.cross(material, inwards); }
    void cross(std::uint32_t material, bool inwards) {
        stack_.cross(material, inwards);
        ray_ = Ray{ray_.at(hit_.t + 1e-4f), ray_.direction};
        hit_ = trace(prepared_, ray_);
    }

    Rgb throughput{1.0f};
    float relative = 0;
    int passed = 0;

private:
    PathTracerSettings settings_;
    PathTracerScene prepared_;
    RenderPlan plan_;
    MediumStack stack_;
    Ray ray_;
    Hit hit_;
};

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("nested dielectrics: the higher priority fills the place, boundaries in it are none, indices are "
              "relative") {
        {
            const Spheres spheres(glass(1.5f, 1), glass(1.33f, 2)); // a drop in glass
            PathWalk walk(spheres.scene);
            CHECK(walk.arrive() == doctest::Approx(1));
            CHECK(walk.relative == 0); // 0: no enclosing medium, so the material's own index applies
            walk.cross(spheres.outer, true);
            CHECK(walk.arrive() == doctest::Approx(0.5));
            CHECK(walk.relative == doctest::Approx(1.33 / 1.5));
            walk.cross(spheres.inner, true);
            CHECK(walk.arrive() == doctest::Approx(-0.5));
            CHECK(walk.relative == doctest::Approx(1.33 / 1.5));
            walk.cross(spheres.inner, false);
            CHECK(walk.arrive() == doctest::Approx(-1));
            CHECK(walk.relative == 0);
            CHECK(walk.passed == 0);
        }
        const Spheres spheres(glass(1.5f, 2), glass(1.33f, 1)); // the glass replaces the drop
        PathWalk walk(spheres.scene);
        CHECK(walk.arrive() == doctest::Approx(1));
        walk.cross(spheres.outer, true);
        CHECK(walk.arrive() == doctest::Approx(-1));
        CHECK(walk.passed == 2);
        CHECK(walk.relative == 0);
    }

    TEST_CASE("absorption: by the length of the way through what fills the place, exp(−σ d)") {
        const Spheres spheres(glass(1.5f, 1, Rgb(1, 2, 0)), glass(1.33f, 2, Rgb(0, 0.5f, 3)));
        PathWalk walk(spheres.scene);
        walk.arrive();
        walk.cross(spheres.outer, true);
        walk.arrive();
        CHECK(walk.throughput.g == doctest::Approx(std::exp(-2 * 0.5)).epsilon(1e-3));
        walk.cross(spheres.inner, true);
        walk.arrive();
        CHECK(walk.throughput.r == doctest::Approx(std::exp(-0.5)).epsilon(1e-3));
        CHECK(walk.throughput.g == doctest::Approx(std::exp(-2 * 0.5 - 0.5)).epsilon(1e-3));
        CHECK(walk.throughput.b == doctest::Approx(std::exp(-3.0)).epsilon(1e-3));
    }

    TEST_CASE("a ball of the index of air that absorbs: exp(−σ·chord) in every pixel, without variance") {
        SceneBuilder builder;
        builder.add(Sphere{{0, 0, 0}, 1}, builder.material(glass(1, 0, Rgb(0.3f, 0.8f, 1.7f))));
        builder.scene.environment = ConstantEnvironment{Rgb(1.0f)};
        builder.scene.camera.eye = {0, 0, 4};
        builder.scene.camera.fov_degrees = 40;
        const Scene scene = builder.finish();
        PathTracerSettings settings;
        settings.sampler = SamplerKind::kCenter;
        settings.samples_per_pixel = 1;
        const Rendering image = render_scene(scene, 32, settings);
        const CameraModel camera(View{scene.camera, 32, 32});
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x) {
                const Ray ray = camera.ray({x + 0.5, y + 0.5});
                const double b = dot(Vec3d(ray.origin), Vec3d(ray.direction)),
                             c = length_squared(Vec3d(ray.origin)) - 1;
                const double chord = b * b > c ? 2 * std::sqrt(b * b - c) : 0;
                CHECK(static_cast<double>(image.radiance(x, y).g) ==
                      doctest::Approx(std::exp(-0.8 * chord)).epsilon(1e-3));
            }
    }

    TEST_CASE("a bubble of air in glass stays frosted; where two dielectrics refract alike nothing is") {
        for (const float ior : {1.0f, 1.5f}) {
            CAPTURE(ior);
            const Spheres spheres(glass(1.5f, 1), glass(ior, 2, Rgb(0.0f), 0.5f));
            PathWalk walk(spheres.scene);
            walk.arrive();
            CHECK(walk.smooth());
            walk.cross(spheres.outer, true);
            CHECK(walk.arrive() == doctest::Approx(0.5));
            CHECK(walk.relative == doctest::Approx(ior / 1.5));
            CHECK(walk.smooth() == (ior == 1.5f));
        }
    }

    TEST_CASE("more dielectrics within each other than are remembered: those entered last fill nothing, the rest "
              "is kept") {
        const Spheres spheres(glass(1.5f, 1, Rgb(1.0f)), glass(1.33f, 2));
        PathWalk walk(spheres.scene);
        walk.arrive();
        walk.cross(spheres.outer, true);
        for (int i = 0; i < 20; ++i) walk.enter(spheres.inner, true);
        for (int i = 0; i < 20; ++i) walk.enter(spheres.inner, false);
        walk.arrive(); // half a meter through the outer sphere
        CHECK(walk.throughput.g == doctest::Approx(std::exp(-0.5)).epsilon(1e-3));
    }

    TEST_CASE("clear dielectrics that stand in each other in a constant environment: nothing is lost, frosted or not") {
        PathTracerSettings settings;
        settings.samples_per_pixel = 4;
        settings.max_depth = 100000;
        settings.russian_roulette = false;
        const auto mean = [&](float roughness) {
            const Spheres spheres(glass(1.5f, 1, Rgb(0.0f), roughness), glass(1.33f, 2, Rgb(0.0f), roughness));
            double sum = 0;
            for (const Rgb& pixel : render_scene(spheres.scene, 32, settings).radiance) {
                if (roughness == 0) CHECK(pixel.g == doctest::Approx(1).epsilon(1e-4));
                sum += static_cast<double>(pixel.g);
            }
            return sum / (32 * 32);
        };
        CHECK(mean(0) == doctest::Approx(1).epsilon(1e-4));
        CHECK(mean(0.3f) == doctest::Approx(1).epsilon(0.01)); // energy from tables, and several interfaces per path
    }
}
