#include "compare/stress/random_scene.h"

#include "compare/stress/accelerated_scene.h"

#include <cmath>

namespace duet::compare {

namespace {

/// Adds a shape with its object-to-world transform.
void add(Scene& scene, Shape shape, const Mat4& to_world) {
    scene.objects.push_back(object_of(static_cast<std::uint32_t>(scene.shapes.size()), to_world));
    scene.shapes.push_back(std::move(shape));
}

Mesh soup(TrialRandom& random) {
    Mesh mesh;
    for (int i = 0; i < 40; ++i) {
        const Vec3 center = random.vector() * 2.0f;
        const float size = random.log_uniform(0.01f, 5);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(center + random.vector() * size);
        if (i % 4 == 0)
            mesh.positions.back() =
                lerp(mesh.positions[first], mesh.positions[first + 1], random.log_uniform(1e-7f, 1)); // a sliver
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

/// Returns a closed torus about y, counter-clockwise seen from outside.
Mesh torus(std::uint32_t around, std::uint32_t across, double tube_radius) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t k = 0; k < across; ++k) {
            const double u = 2 * kPiDouble * i / around, v = 2 * kPiDouble * k / across;
            const double ring = 1 + tube_radius * std::cos(v);
            mesh.positions.emplace_back(Vec3d(ring * std::cos(u), tube_radius * std::sin(v), -ring * std::sin(u)));
        }
    const auto vertex = [&](std::uint32_t i, std::uint32_t k) { return i % around * across + k % across; };
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t k = 0; k < across; ++k) {
            mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1)});
            mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1)});
        }
    return mesh;
}

QuadList walls(TrialRandom& random) {
    QuadList list;
    for (int i = 0; i < 6; ++i) {
        const float size = random.log_uniform(0.1f, 10);
        const Vec3 corner = random.vector() * 2.0f, u = random.vector() * size;
        list.quads.push_back({corner, u, random.vector() * size});
    }
    return list;
}

Mat4 random_turn(TrialRandom& random) { return rotation(random.direction(), random.uniform(0, 6)); }

/// Returns a scaling by factors of ±0.2 to ±2, which mirrors in half of the cases.
Mat4 random_stretch(TrialRandom& random) {
    const auto factor = [&] { return random.sign() * random.log_uniform(0.2f, 2); };
    const float x = factor(), y = factor();
    return random_turn(random) * scaling(Vec3(x, y, factor()));
}

Mat4 place(const Placement& placement) {
    const float s = placement.scale;
    return translation(placement.offset) * scaling(Vec3(s, s, s));
}

void add_contents(Scene& scene, TrialRandom& random, const SceneContents& contents, const Mat4& placed) {
    if (contents.soup) add(scene, soup(random), placed);
    for (int i = 0; contents.meshes && i < 2; ++i) {
        const auto around = 3 + random.below(30), across = 3 + random.below(20);
        const Mat4 moved = placed * translation(random.vector()) * random_turn(random);
        add(scene, torus(around, across, static_cast<double>(random.uniform(0.1f, 0.9f))), moved);
    }
    for (int i = 0; contents.spheres && i < 5; ++i) {
        const Vec3 center = random.vector() * 2.0f;
        add(scene, Sphere{center, random.log_uniform(0.01f, 1)}, placed);
    }
    if (contents.quads) {
        add(scene, walls(random), placed);
        const Vec3 low = random.vector();
        add(scene, box_quads(low, low + abs(random.vector()) + Vec3(0.1f, 0.1f, 0.1f)), placed * random_turn(random));
    }
    const std::size_t count = contents.instances ? scene.objects.size() : 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Mat4 moved = placed * translation(random.vector() * 2.0f) * random_stretch(random);
        scene.objects.push_back(object_of(scene.objects[i].shape, moved));
    }
}

Camera random_camera(TrialRandom& random, const Placement& placement) {
    const auto there = [&](Vec3 p) {
        return Vec3d(placement.offset) + Vec3d(p) * static_cast<double>(placement.scale);
    };
    Camera camera;
    camera.eye = there(random.vector() * random.log_uniform(0.5f, 10));
    camera.look_at = there(random.vector());
    camera.up = Vec3d(random.direction());
    camera.fov_degrees = static_cast<double>(random.uniform(10, 110));
    // Far from the world's origin the origins of parallel rays would be rounded.
    if (random.below(8) == 0 && placement.offset == Vec3()) {
        camera.projection = Camera::Projection::kOrthographic;
        camera.height = static_cast<double>(placement.scale * random.uniform(1, 6));
    }
    return camera;
}

TrialScene empty(TrialRandom& random, const Placement& placement, int width, int height) {
    TrialScene result;
    result.scene.path = "random scene";
    result.scene.width = width;
    result.scene.height = height;
    result.scene.camera = random_camera(random, placement);
    result.scene.materials = {Diffuse{}};
    result.scene.material_names = {"grey"};
    result.view = {result.scene.camera, width, height};
    return result;
}

} // namespace

TrialScene random_scene(TrialRandom& random, const SceneContents& contents, const Placement& placement, int width,
                        int height) {
    TrialScene result = empty(random, placement, width, height);
    add_contents(result.scene, random, contents, place(placement));
    finish_scene(result.scene);
    return result;
}

TrialScene random_lit_scene(TrialRandom& random, int width, int height) {
    TrialScene result = empty(random, {}, width, height);
    Scene& scene = result.scene;
    scene.materials = {Diffuse{}, Metal{{Rgb(0.9f, 0.8f, 0.7f)}, 0.3f}, Metal{}, Dielectric{}, Emissive{Rgb(3.0f)}};
    scene.material_names = {"grey", "brushed metal", "mirror", "glass", "lamp"};
    add_contents(scene, random, {true, true, true, true, true}, Mat4());
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        scene.objects[i].materials = {static_cast<std::uint32_t>(i % scene.materials.size())};
    Object& last = scene.objects.back();
    last.place(last.to_world, translation(Vec3(0.2f, 0.1f, 0)) * last.to_world);
    scene.environment = SkyEnvironment{};
    scene.lights = {PointLight{random.vector() * 3.0f, Rgb(5.0f)}, SunLight{random.direction(), Rgb(1.0f)}};
    result.view.camera.aperture_radius = random.coin() ? 0.05 : 0;
    finish_scene(scene);
    return result;
}

} // namespace duet::compare
