// These tests compare the shading of simple scenes with closed forms.
#include "raster/shading/built_in_shaders.h"
#include "tests/raster/scenes.h"

#include <doctest/doctest.h>

using namespace duet;
using namespace duet::test;

namespace {

const View kFromAbove{look({0, 3, 0.5}, {0, 0, 0}, 40), 32, 24};

Scene floor_scene(Material material) {
    Scene scene;
    add(scene, QuadList{{{Vec3(-5, 0, 5), Vec3(10, 0, 0), Vec3(0, 0, -10)}}}, Mat4(), material);
    return scene;
}

/// Returns the floor's point at the center of a pixel.
Vec3 floor_point(const View& view, int x, int y) {
    const Rayd ray = CameraModel(view).pinhole().ray({x + 0.5, y + 0.5});
    return Vec3(ray.at(-ray.origin.y / ray.direction.y));
}

void check_rgb(Rgb found, Rgb expected, double epsilon = 2e-5) {
    for (std::size_t c = 0; c < 3; ++c) CHECK(found[c] == doctest::Approx(expected[c]).epsilon(epsilon));
}

/// Returns the irradiance on the floor from a parallel rectangle at height h that faces down: the signed sum of four
/// corner configurations (factor B-3 of Howell, "A Catalog of Radiation Heat Transfer Configuration Factors").
double rectangle_above(double x0, double x1, double z0, double z1, double h) {
    const auto corner = [&](double a, double b) {
        const double x = a / h, y = b / h, sx = std::sqrt(1 + x * x), sy = std::sqrt(1 + y * y);
        return (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy)) / 2; // includes the factor π
    };
    return corner(x1, z1) - corner(x0, z1) - corner(x1, z0) + corner(x0, z0);
}

bool names(const Rendering& rendering, const std::string& part) {
    for (const std::string& sentence : rendering.statistics.approximations)
        if (sentence.find(part) != std::string::npos) return true;
    return false;
}

} // namespace

TEST_SUITE("unit") {

    TEST_CASE("a diffuse floor under a square light: the configuration factor of the rectangle") {
        const Rgb albedo(0.8f, 0.5f, 0.2f), light(3, 5, 7);
        Scene scene = floor_scene(Diffuse{{albedo}});
        // The light is above the eye and emits downward (its normal u × v is −y).
        add(scene, QuadList{{{Vec3(-0.5f, 4, -1), Vec3(1.5f, 0, 0), Vec3(0, 0, 2)}}}, Mat4(), Emissive{light});
        finish_scene(scene);
        const Rendering rendering = render(scene, kFromAbove, plain());
        for (int y = 0; y < 24; y += 3)
            for (int x = 0; x < 32; x += 3) {
                const Vec3d p(floor_point(kFromAbove, x, y));
                const double e = rectangle_above(-0.5 - p.x, 1 - p.x, -1 - p.z, 1 - p.z, 4);
                check_rgb(rendering.radiance(x, y), albedo * light * static_cast<float>(e / kPiDouble));
            }
        CHECK(names(rendering, "Soft shadows"));
        CHECK_FALSE(names(rendering, "environment"));
        CHECK_FALSE(names(rendering, "etal"));
    }

    TEST_CASE("a light shines on one side, shows its radiance there, and does not light itself") {
        Scene scene = floor_scene(Diffuse{{Rgb(0.5f)}});
        // The light's front faces up, so it does not illuminate the floor below.
        add(scene, QuadList{{{Vec3(-0.3f, 1, 0.3f), Vec3(0.6f, 0, 0), Vec3(0, 0, -0.6f)}}}, Mat4(),
            Emissive{.radiance = Rgb(2, 3, 4), .albedo = {Rgb(0.9f)}});
        finish_scene(scene);
        const Rendering rendering = render(scene, kFromAbove, plain());
        int area_light = 0, dark = 0;
        for (const Rgb c : rendering.radiance) {
            area_light += c == Rgb(2, 3, 4);
            dark += c == Rgb();
        }
        CHECK(area_light > 50);
        CHECK(area_light + dark == 32 * 24);
    }

    TEST_CASE("point, spot and sun light a diffuse floor by the inverse square and the cosine") {
        const float albedo = 0.6f;
        Scene scene = floor_scene(Diffuse{{Rgb(albedo)}});
        const Vec3 at(0.5f, 2, -0.3f);
        const Vec3 sun_way = normalize(Vec3(1, -2, 0.5f));
        scene.lights.push_back(PointLight{at, Rgb(10, 0, 0)});
        scene.lights.push_back(SunLight{sun_way, Rgb(0, 3, 0)});
        scene.lights.push_back(SpotLight{at, Vec3(0, -1, 0), Rgb(0, 0, 10), 0.9f, 0.8f});
        finish_scene(scene);
        const Rendering rendering = render(scene, kFromAbove, plain());
        for (int y = 0; y < 24; y += 4)
            for (int x = 0; x < 32; x += 4) {
                const Vec3 p = floor_point(kFromAbove, x, y), way = at - p;
                const float d2 = length_squared(way), cosine = way.y / std::sqrt(d2);
                const float s = clamp((cosine - 0.8f) / 0.1f, 0.0f, 1.0f), cone = s * s * (3 - 2 * s);
                const float factor = albedo * kInvPi;
                check_rgb(rendering.radiance(x, y),
                          Rgb(10 * cosine / d2, -3 * sun_way.y, 10 * cosine / d2 * cone) * factor, 1e-4);
            }
    }

    TEST_CASE("diffuse surfaces are lit on both sides: from below a floor is lit from below") {
        for (const double side : {1.0, -1.0}) {
            Scene scene = floor_scene(Diffuse{{Rgb(1.0f)}});
            scene.lights.push_back(SunLight{Vec3(0, -1, 0), Rgb(kPi)}); // from above
            finish_scene(scene);
            const Rendering rendering = render(scene, {look({0, 3 * side, 0.5}, {0, 0, 0}), 8, 8}, plain());
            for (const Rgb c : rendering.radiance) check_rgb(c, Rgb(side > 0 ? 1.0f : 0.0f));
        }
    }

    TEST_CASE("white diffuse, in a constant environment, vanishes; so does smooth metal that reflects all") {
        for (const bool metal : {false, true}) {
            Scene scene;
            CAPTURE(metal);
            const Material white = metal ? Material(Metal{{Rgb(1.0f)}, 0}) : Material(Diffuse{{Rgb(1.0f)}});
            add(scene, torus(40, 20), Mat4(), white);
            add(scene, Sphere{Vec3(0, 1, 0), 0.5f}, Mat4(), white);
            scene.environment = ConstantEnvironment{Rgb(0.7f)};
            finish_scene(scene);
            // Occlusion would darken the ring's inside.
            const Rendering rendering = render(scene, {look({1, 2, 3}, {0, 0, 0}), 48, 32}, plain());
            for (const Rgb c : rendering.radiance) check_rgb(c, Rgb(0.7f), 1e-5);
            CHECK(names(rendering, "unoccluded"));
        }
    }

    TEST_CASE("clear glass in a constant environment vanishes: reflected and transmitted light add up to all") {
        Scene scene;
        add(scene, Sphere{Vec3(0, 0, 0), 1}, Mat4(), Dielectric{});
        scene.environment = ConstantEnvironment{Rgb(0.7f)};
        finish_scene(scene);
        // The eye is outside, or inside with total internal reflection.
        for (const Vec3d eye : {Vec3d(0, 0, 4), Vec3d(0, 0, 0.9)}) {
            const Rendering rendering = render(scene, {look(eye, {0, 0.3, 0}, 70), 32, 32}, {});
            // Light that leaves after the second reflection within is shown where the first leaves.
            for (const Rgb c : rendering.radiance) check_rgb(c, Rgb(0.7f), 0.04);
            CHECK(names(rendering, "Glass"));
        }
    }

    TEST_CASE("white clay, rough metal, plastic and panes in a constant environment vanish, but for what their tables "
              "leave") {
        Diffuse clay{{Rgb(1.0f)}};
        clay.roughness = 0.8f;
        Dielectric pane, frosted;
        pane.thin = true;
        frosted.roughness = 0.5f;
        Principled lacquer{{Rgb(1.0f)}, 1, 0.3f};
        lacquer.clearcoat = 1;
        for (const Material& white :
             {Material(clay), Material(Metal{{Rgb(1.0f)}, 0.8f}), Material(Coated{{Rgb(1.0f)}, 0.4f}), Material(pane),
              Material(frosted), Material(lacquer)}) {
            CAPTURE(white.index());
            Scene scene;
            add(scene, Sphere{Vec3(0, 0, 0), 1}, Mat4(), white);
            scene.environment = ConstantEnvironment{Rgb(0.7f)};
            finish_scene(scene);
            const Rendering rendering = render(scene, {look({1, 2, 3}, {0, 0, 0}), 48, 32}, plain());
            for (const Rgb c : rendering.radiance) check_rgb(c, Rgb(0.7f), 0.04);
        }
    }

    TEST_CASE("a mirror shows the sky in the mirror direction, the background shows it along the ray") {
        Scene scene = floor_scene(Metal{{Rgb(1.0f)}, 0});
        scene.environment = SkyEnvironment{{1, 0, 0}, {0, 0, 1}};
        finish_scene(scene);
        const View view{look({0, 1, 4}, {0, 1, 0}, 60), 16, 16};
        const Rendering rendering = render(scene, view, {});
        const Pinhole pinhole = CameraModel(view).pinhole();
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                Vec3 w(pinhole.ray({x + 0.5, y + 0.5}).direction);
                // The floor reflects downward directions. It ends before the horizon, but at most pixels it is
                // present.
                w.y = std::abs(w.y);
                const Rgb behind = radiance(scene.environment, Vec3(pinhole.ray({x + 0.5, y + 0.5}).direction));
                if (std::abs(rendering.radiance(x, y).b - behind.b) < 1e-6f) continue;
                // From a map of 32 × 32 texels
                check_rgb(rendering.radiance(x, y), radiance(scene.environment, w), 0.02);
            }
        raster::RasterSettings off;
        off.environment = false;
        const Rendering dark = render(scene, view, off);
        CHECK(std::all_of(dark.radiance.begin(), dark.radiance.end(), [](Rgb c) { return c == Rgb(); }));
    }

    TEST_CASE("rough metal under a sun is its BSDF; under a small far light nearly that of the same sun") {
        const Metal metal{{Rgb(0.9f, 0.7f, 0.4f)}, 0.5f};
        Scene with_area_light = floor_scene(metal), with_sun = floor_scene(metal);
        add(with_area_light, Sphere{Vec3(0, 100, 0), 1}, Mat4(), Emissive{Rgb(1000.0f)});
        finish_scene(with_area_light);
        with_sun.lights.push_back(SunLight{Vec3(0, -1, 0), Rgb(1000.0f) * (kPi * 1e-4f)});
        finish_scene(with_sun);
        const Rendering area_light = render(with_area_light, kFromAbove, plain()),
                        sun = render(with_sun, kFromAbove, plain());
        const MetalBsdf bsdf{Rgb(0.9f, 0.7f, 0.4f), 0.25f};
        const Ray ray = CameraModel(kFromAbove).ray({16.5, 12.5});
        const Vec3 wo(-ray.direction.x, ray.direction.z,
                      -ray.direction.y); // y is up; any rotation about the normal is valid
        const Rgb expected = bsdf.eval(wo, Vec3(0, 0, 1), TransportMode::kRadiance) * (1000 * kPi * 1e-4f);
        check_rgb(sun.radiance(16, 12), expected, 1e-4);
        check_rgb(area_light.radiance(16, 12), expected,
                  0.15); // the transformed cosine is close to the lobe, but not exact
        CHECK_FALSE(names(sun, "linearly transformed cosines"));
        CHECK(names(area_light, "linearly transformed cosines"));
    }

    TEST_CASE("light from behind the geometric surface does not arrive, whatever the shading normal: it is in shadow") {
        Scene scene;
        Mesh tilted; // a floor whose shading normals are strongly tilted
        tilted.positions = {Vec3(-5, 0, 5), Vec3(5, 0, 5), Vec3(5, 0, -5), Vec3(-5, 0, -5)};
        tilted.triangles = {{0, 1, 2}, {0, 2, 3}};
        tilted.normals.assign(4, normalize(Vec3(1, 0.6f, 0)));
        add(scene, tilted, Mat4(), Diffuse{{Rgb(1.0f)}});
        // The light is below the floor, on the side of the shading normal.
        add(scene, QuadList{{{Vec3(8, -2, -1), Vec3(0, 0, 2), Vec3(0, 1.5f, 0)}}}, Mat4(),
            Emissive{.radiance = Rgb(0, 9, 0), .two_sided = true});
        finish_scene(scene);
        const Rgb found = render(scene, kFromAbove, plain()).radiance(16, 12);
        CHECK(found.g < 0.05f); // measured: 0.038, of 0.45 without shadows
    }

    TEST_CASE("normal, albedo and depth shadings and auxiliary images") {
        Scene scene = floor_scene(Diffuse{{Rgb(0.1f, 0.2f, 0.3f)}});
        finish_scene(scene);
        View view{look({0, 3, 0}, {0, 0, 0}), 8, 8};
        raster::RasterSettings settings;
        settings.aovs = kAllAovs;
        settings.shading = raster::Shading::kNormal;
        const Rendering normal = render(scene, view, settings);
        settings.shading = raster::Shading::kAlbedo;
        const Rendering albedo = render(scene, view, settings);
        settings.shading = raster::Shading::kDepth;
        const Rendering depth = render(scene, view, settings);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
                check_rgb(normal.radiance(x, y), Rgb(0.5f, 1, 0.5f));
                check_rgb(albedo.radiance(x, y), Rgb(0.1f, 0.2f, 0.3f));
                check_rgb(depth.radiance(x, y), Rgb(0.5f)); // the camera's target depth
                CHECK(normal.normal(x, y) == Vec3(0, 1, 0));
                check_rgb(normal.albedo(x, y), Rgb(0.1f, 0.2f, 0.3f));
                CHECK(normal.depth(x, y) == doctest::Approx(3));
                CHECK(normal.samples(x, y) == 1);
            }
        CHECK(normal.variance.empty());
        CHECK_THROWS_AS(raster::kShadings.value("fancy"), Error);
        CHECK(raster::kShadings.value("depth") == raster::Shading::kDepth);
    }
}
