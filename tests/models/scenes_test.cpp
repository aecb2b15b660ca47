// These tests check that the scenes of models/ load and have their documented contents.
#include "common/scene/scene.h"
#include "common/system/error.h"
#include "models/test_ball.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

using namespace duet;

namespace {

Scene load(const std::string& name) { return load_scene(std::filesystem::path(DUET_SOURCE_DIR) / "models" / name); }

const Object& object_named(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.objects, name, &Object::name);
    REQUIRE_MESSAGE(found != scene.objects.end(), "no object \"" << name << "\"");
    return *found;
}

const Material& material_of(const Scene& scene, const Object& object) {
    return scene.materials[object.materials.at(0)];
}

template <typename Set, typename Kind> bool holds(const Set& set) {
    return std::ranges::any_of(set, [](const auto& x) { return std::holds_alternative<Kind>(x); });
}

bool same(Vec3 a, Vec3d b) { return a == Vec3(b); }

/// Holds the corners of one of the published boxes as (x, z), counterclockwise from above.
using Footprint = std::array<Vec2d, 4>;

/// Checks that each vertex of the mesh is one of the box's eight corners to float precision, that each corner occurs,
/// and that the mesh is closed.
void check_box(const Scene& scene, const std::string& name, const Footprint& footprint, double height) {
    CAPTURE(name);
    const Object& object = object_named(scene, name);
    REQUIRE(object.identity);
    const Mesh& mesh = std::get<Mesh>(scene.shapes[object.shape]);
    std::array<bool, 8> seen{};
    for (const Vec3& p : mesh.positions) {
        bool known = false;
        for (std::size_t i = 0; i < 8; ++i) {
            if (!same(p, {footprint[i % 4].x, i < 4 ? 0.0 : height, footprint[i % 4].y})) continue;
            known = seen[i] = true;
        }
        CHECK_MESSAGE(known, "(" << p.x << ", " << p.y << ", " << p.z << ") is no corner");
    }
    CHECK(std::ranges::count(seen, true) == 8);
    CHECK(mesh.triangles.size() == 12);
    CHECK(mesh.closed.value());
    CHECK(mesh.normals.empty());
}

/// Checks the quad's corner and edges exactly, and that its normal points into the box.
void check_wall(const Scene& scene, const std::string& name, const std::array<Vec3d, 4>& corners, Vec3d normal) {
    CAPTURE(name);
    const Object& object = object_named(scene, name);
    REQUIRE(object.identity);
    const QuadList& list = std::get<QuadList>(scene.shapes[object.shape]);
    REQUIRE(list.quads.size() == 1);
    const Quad& q = list.quads[0];
    for (const Vec3& p : {q.corner, q.corner + q.u, q.corner + q.u + q.v, q.corner + q.v}) {
        const bool known = std::ranges::any_of(corners, [&](Vec3d c) { return length(Vec3d(p) - c) < 1e-7; });
        CHECK_MESSAGE(known, "(" << p.x << ", " << p.y << ", " << p.z << ") is no corner");
    }
    CHECK(length(normalize(cross(Vec3d(q.u), Vec3d(q.v))) - normal) < 1e-6);
}

void check_albedo(const Scene& scene, const std::string& name, Rgb albedo) {
    CAPTURE(name);
    const auto& diffuse = std::get<Diffuse>(material_of(scene, object_named(scene, name)));
    CHECK(diffuse.albedo.value == albedo);
    CHECK(diffuse.albedo.texture < 0);
}

} // namespace

TEST_SUITE("unit") {
    // The reference is Bitterli's version of the box, as Mitsuba, Tungsten and pbrt use it (Rendering Resources,
    // 2016).
    TEST_CASE("cornell.json is the published box") {
        const Scene scene = load("cornell.json");
        CHECK(scene.camera.eye == Vec3d(0, 1, 6.8));
        CHECK(scene.camera.look_at == Vec3d(0, 1, 0));
        CHECK(scene.camera.up == Vec3d(0, 1, 0));
        CHECK(scene.camera.fov_degrees == 19.5);
        CHECK(scene.camera.aperture_radius == 0);
        CHECK(scene.width == 512);
        CHECK(scene.height == 512);
        CHECK(scene.objects.size() == 8);
        CHECK_FALSE(scene.needs.environment);

        check_wall(scene, "floor", {{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}}, {0, 1, 0});
        check_wall(scene, "ceiling", {{{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}}, {0, -1, 0});
        check_wall(scene, "back wall", {{{-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1}}}, {0, 0, 1});
        check_wall(scene, "left wall", {{{-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1}, {-1, 0, 1}}}, {1, 0, 0});
        check_wall(scene, "right wall", {{{1, 0, -1}, {1, 2, -1}, {1, 2, 1}, {1, 0, 1}}}, {-1, 0, 0});
        check_wall(scene, "lamp",
                   {{{-0.24, 1.98, -0.22}, {0.23, 1.98, -0.22}, {0.23, 1.98, 0.16}, {-0.24, 1.98, 0.16}}}, {0, -1, 0});
        check_box(
            scene, "short box",
            {{{-0.04607511, 0.5730067}, {0.5330086, 0.7460793}, {0.7033371, 0.1761773}, {0.1242534, 0.003104655}}},
            0.6);
        check_box(
            scene, "tall box",
            {{{-0.7204437, -0.4738824}, {-0.5239855, 0.09064936}, {0.04956569, -0.1089476}, {-0.1468925, -0.6734794}}},
            1.2);

        for (const char* name : {"floor", "ceiling", "back wall", "short box", "tall box"})
            check_albedo(scene, name, {0.725f, 0.71f, 0.68f});
        check_albedo(scene, "left wall", {0.63f, 0.065f, 0.05f});
        check_albedo(scene, "right wall", {0.14f, 0.45f, 0.091f});
        const auto& area_light = std::get<Emissive>(material_of(scene, object_named(scene, "lamp")));
        CHECK(area_light.radiance == Rgb(17, 12, 4));
        CHECK_FALSE(area_light.two_sided);
        CHECK(area_light.albedo.value == Rgb(0));
        REQUIRE(scene.lights.size() == 1);
    }

    TEST_CASE("spheres.json is the cover scene of Ray Tracing in One Weekend") {
        const Scene scene = load("spheres.json");
        CHECK(scene.camera.eye == Vec3d(13, 2, 3));
        CHECK(scene.camera.fov_degrees == 20);
        CHECK(scene.camera.focus_distance == 10);
        CHECK(scene.camera.aperture_radius == doctest::Approx(10 * std::tan(radians(0.3))).epsilon(1e-4));
        CHECK(scene.width * 9 == scene.height * 16);
        CHECK(scene.objects.size() > 470);
        CHECK(scene.objects.size() <= 4 + 22 * 22);
        std::size_t diffuse = 0, metal = 0, glass = 0;
        for (const Object& object : scene.objects) {
            REQUIRE(std::holds_alternative<Sphere>(scene.shapes[object.shape]));
            diffuse += std::holds_alternative<Diffuse>(material_of(scene, object));
            metal += std::holds_alternative<Metal>(material_of(scene, object));
            glass += std::holds_alternative<Dielectric>(material_of(scene, object));
        }
        // The fractions are 80, 15 and 5 % of the small spheres, within four standard deviations of 480 draws (8.8,
        // 7.8, 4.8).
        CHECK(std::abs(static_cast<double>(diffuse) - 0.80 * 480) < 36);
        CHECK(std::abs(static_cast<double>(metal) - 0.15 * 480) < 32);
        CHECK(std::abs(static_cast<double>(glass) - 0.05 * 480) < 20);
    }

    TEST_CASE("lanterns.json has a thousand lights of very different strength") {
        const Scene scene = load("lanterns.json");
        REQUIRE(scene.lights.size() == 1000);
        float weakest = kInfinity, strongest = 0;
        for (const Light& light : scene.lights) {
            const float power = light_power(light, 1);
            weakest = min(weakest, power);
            strongest = max(strongest, power);
        }
        CHECK(weakest > 0);
        CHECK(strongest > 20 * weakest);
    }

    TEST_CASE("veach.json: lights of one power and different size, and each plate mirrors all of them to the camera") {
        const Scene scene = load("veach.json");
        std::vector<Vec3d> area_lights;
        std::vector<float> powers;
        for (const Object& object : scene.objects) {
            if (!object.name.starts_with("lamp")) continue;
            const Sphere& sphere = std::get<Sphere>(scene.shapes[object.shape]);
            area_lights.push_back(Vec3d(sphere.center));
            powers.push_back(max_component(std::get<Emissive>(material_of(scene, object)).radiance) *
                             sqr(sphere.radius));
        }
        REQUIRE(area_lights.size() == 4);
        for (const float power : powers) CHECK(power == doctest::Approx(powers[0]).epsilon(0.01));
        float roughness = 0;
        for (int i = 1; i <= 4; ++i) {
            const Object& plate = object_named(scene, message("plate ", i));
            const auto& metal = std::get<Metal>(material_of(scene, plate));
            CHECK(metal.roughness.value > roughness); // each is rougher than the one before
            roughness = metal.roughness.value;
            const Quad& quad = std::get<QuadList>(scene.shapes[plate.shape]).quads.at(0);
            const Vec3d normal = normalize(cross(Vec3d(quad.u), Vec3d(quad.v)));
            for (const Vec3d& area_light : area_lights) {
                // The light's mirror image behind the plate must be visible from the camera through the plate's
                // rectangle.
                const Vec3d image = area_light - normal * (2 * dot(area_light - Vec3d(quad.corner), normal));
                const Vec3d way = image - scene.camera.eye;
                const double t = dot(Vec3d(quad.corner) - scene.camera.eye, normal) / dot(way, normal);
                const Vec3d at = scene.camera.eye + way * t - Vec3d(quad.corner);
                const double u = dot(at, Vec3d(quad.u)) / length_squared(Vec3d(quad.u));
                const double v = dot(at, Vec3d(quad.v)) / length_squared(Vec3d(quad.v));
                CAPTURE(i);
                CHECK(t > 0);
                CHECK(t < 1);
                CHECK(std::min(u, v) > 0);
                CHECK(std::max(u, v) < 1);
            }
        }
    }

    TEST_CASE("cornell-35.json is cornell.json but for its field of view") {
        const Scene box = load("cornell.json"), wide = load("cornell-35.json");
        CHECK(wide.camera.fov_degrees == 35);
        CHECK(wide.camera.eye == box.camera.eye);
        CHECK(wide.objects.size() == box.objects.size());
        CHECK(wide.bounds.low == box.bounds.low);
        CHECK(wide.bounds.high == box.bounds.high);
    }

    TEST_CASE("hall.json is seen from within a large mesh, open to the outside") {
        const Scene scene = load("hall.json");
        const Mesh& mesh = std::get<Mesh>(scene.shapes.front());
        CHECK(mesh.triangles.size() > 100'000);
        CHECK(mesh.triangles.size() < 300'000);
        CHECK_FALSE(mesh.closed.value());
        int flat = 0;
        for (const auto& [a, b, c] : mesh.triangles) {
            const Vec3d p(mesh.positions[a]), q(mesh.positions[b]), r(mesh.positions[c]);
            flat += !(length(cross(q - p, r - p)) > 1e-7);
        }
        CHECK(flat == 0);
        CHECK(Box3d{Vec3d(scene.bounds.low), Vec3d(scene.bounds.high)}.contains(scene.camera.eye));
        // The far wall must share its vertices with the vault. Different vertices would leave gaps with sky.
        std::set<float> on_vaults_edge;
        for (const Vec3 p : mesh.positions)
            if (p.z == -18 && p.y >= 8 && std::abs(std::hypot(p.x, p.y - 8) - 5) < 1e-4f) on_vaults_edge.insert(p.x);
        CHECK(on_vaults_edge.size() == 2 * 40 + 1);
        // The vertices at the arches' open lower ends must match those of the capitals, too.
        std::set<std::pair<float, float>> rim;
        const double corner = std::hypot(0.25, 0.6);
        for (const Vec3 p : mesh.positions) {
            const double beside = std::hypot(p.x - 5, static_cast<double>(p.z));
            if (std::abs(p.y - 4.2f) < 1e-5f && beside < 1 && beside * std::cos(kPiDouble / 64) > corner)
                rim.insert({p.x, p.z});
        }
        CHECK(rim.size() == 64);
    }

    TEST_CASE("furnace.json is white, closed and lit evenly") {
        const Scene scene = load("furnace.json");
        for (const char* name : {"sphere", "box"}) check_albedo(scene, name, Rgb(1));
        const auto* environment = std::get_if<ConstantEnvironment>(&scene.environment);
        REQUIRE(environment);
        CHECK(environment->radiance == Rgb(1));
        CHECK(scene.lights.empty());
    }

    TEST_CASE("everything.json uses every feature") {
        const Scene scene = load("everything.json");
        const SceneNeeds& needs = scene.needs;
        CHECK(needs.textures);
        CHECK(needs.image_textures);
        CHECK(needs.motion);
        CHECK(needs.lens);
        CHECK(needs.environment);
        CHECK(needs.delta_lights);
        CHECK(needs.surface_lights);
        CHECK(needs.glossy);
        CHECK(needs.specular);
        CHECK(needs.transmission);
        CHECK(needs.meshes);
        CHECK(needs.quads);
        CHECK(needs.spheres);
        CHECK(needs.smooth_normals);
        CHECK(needs.instances);
        CHECK(holds<std::vector<Material>, Diffuse>(scene.materials));
        CHECK(holds<std::vector<Material>, Metal>(scene.materials));
        CHECK(holds<std::vector<Material>, Dielectric>(scene.materials));
        CHECK(holds<std::vector<Material>, Emissive>(scene.materials));
        CHECK(holds<std::vector<Texture>, ImageTexture>(scene.textures.textures));
        CHECK(holds<std::vector<Texture>, CheckerTexture>(scene.textures.textures));
        CHECK(holds<std::vector<Light>, PointLight>(scene.lights));
        CHECK(holds<std::vector<Light>, SpotLight>(scene.lights));
        CHECK(holds<std::vector<Light>, SunLight>(scene.lights));
        CHECK(holds<std::vector<Light>, SurfaceLight>(scene.lights));
        CHECK(std::holds_alternative<ImageEnvironment>(scene.environment));
        bool checker_uv = false, checker_solid = false, noise = false, marble = false;
        for (const Texture& texture : scene.textures.textures) {
            if (const auto* c = std::get_if<CheckerTexture>(&texture)) (c->solid ? checker_solid : checker_uv) = true;
            if (const auto* n = std::get_if<NoiseTexture>(&texture)) (n->marble ? marble : noise) = true;
        }
        CHECK(checker_uv);
        CHECK(checker_solid);
        CHECK(noise);
        CHECK(marble);
        // A mesh must have several MTL materials.
        CHECK(std::ranges::any_of(scene.objects, [](const Object& o) { return o.materials.size() >= 3; }));
    }

    TEST_CASE("every test ball's scene loads, and shows a material of its own") {
        std::size_t count = 0;
        for (const auto& entry :
             std::filesystem::directory_iterator(std::filesystem::path(DUET_SOURCE_DIR) / "models/balls")) {
            CAPTURE(entry.path());
            const Scene scene = load("balls/" + entry.path().filename().string());
            CHECK(scene.objects.size() >= 4);
            CHECK(scene.material_names[scene.objects.front().materials.front()] == "ball");
            ++count;
        }
        CHECK(count == models::ball_scenes().size());
    }

    TEST_CASE("every scene loads, and something is seen in it") {
        std::size_t count = 0;
        for (const auto& entry :
             std::filesystem::directory_iterator(std::filesystem::path(DUET_SOURCE_DIR) / "models")) {
            const std::string name = entry.path().filename().string();
            if (entry.path().extension() != ".json" || name == "scene.schema.json") continue;
            CAPTURE(name);
            const Scene scene = load(name);
            CHECK(scene.objects.size() >= 2);
            ++count;
        }
        CHECK(count >= 13);
    }
}
