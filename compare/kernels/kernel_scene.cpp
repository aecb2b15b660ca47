#include "compare/kernels/kernel_scene.h"

#include "common/sampling/hash.h"
#include "common/system/error.h"
#include "common/system/file.h"

#include <array>

namespace duet::compare {

namespace {

constexpr std::array<const char*, 3> kNames{"alone", "room", "clutter"};

Box3d bounds_of(const Mesh& mesh) {
    Box3d box;
    for (const Vec3& p : mesh.positions) box.extend(Vec3d(p));
    return box;
}

/// Positions and triangles only: nothing else matters to a kernel.
void append(Mesh& all, const std::vector<Vec3>& positions, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), positions.begin(), positions.end());
    for (const auto& [a, b, c] : triangles) all.triangles.push_back({first + a, first + b, first + c});
}

/// Everything in the scene but spheres, in the world, as the shutter opens; `left_out` counts those.
Mesh flattened(const Scene& scene, std::size_t& left_out) {
    Mesh all;
    for (const Object& object : scene.objects) {
        const Shape& shape = scene.shapes[object.shape];
        if (std::holds_alternative<Sphere>(shape)) {
            ++left_out;
            continue;
        }
        const Mat4 to_world = object_transform(object, static_cast<float>(scene.camera.shutter_open)).to_world;
        const bool still = object.identity && !object.moving;
        const auto placed = [&](Vec3 p) { return still ? p : transform_point(to_world, p); };
        std::vector<Vec3> positions;
        std::vector<std::array<std::uint32_t, 3>> triangles;
        if (const auto* mesh = std::get_if<Mesh>(&shape)) {
            for (const Vec3& p : mesh->positions) positions.push_back(placed(p));
            triangles = mesh->triangles;
        } else {
            for (const Quad& quad : std::get<QuadList>(shape).quads) {
                const auto first = static_cast<std::uint32_t>(positions.size());
                for (const Vec3& p : corners(quad)) positions.push_back(placed(p));
                triangles.push_back({first, first + 1, first + 2});
                triangles.push_back({first, first + 2, first + 3});
            }
        }
        append(all, positions, triangles);
    }
    return all;
}

/// A rotation, uniform over all (Shoemake 1992, «Uniform Random Rotations»): a random unit quaternion.
Mat4d random_rotation(std::uint64_t state) {
    const auto unit = [&](std::uint64_t i) { return static_cast<double>(stream_number(state, i) >> 11) * 0x1p-53; };
    const double r = unit(0), a = 2 * kPiDouble * unit(1), b = 2 * kPiDouble * unit(2);
    const double x = std::sqrt(1 - r) * std::sin(a), y = std::sqrt(1 - r) * std::cos(a);
    const double z = std::sqrt(r) * std::sin(b), w = std::sqrt(r) * std::cos(b);
    const double angle = 2 * std::acos(clamp(w, -1.0, 1.0));
    return rotation(normalize(Vec3d(x, y, z)), angle);
}

constexpr float kClutterHalf = 2.5f; ///< half the side of the box around the copies

/// In a corner of the box, looking to its middle.
Camera clutter_camera() {
    Camera camera;
    camera.eye = {2.2, 1.5, 2.3};
    camera.look_at = {0, 0, 0};
    camera.fov_degrees = 55;
    return camera;
}

/// A square lamp above everything, facing down: just below the ceiling where there is one.
Light lamp_above(const Box3d& box, bool enclosed) {
    const Vec3d size = box.diagonal();
    const double side = 0.3 * max(size.x, size.z);
    const double height = enclosed ? box.high.y - 0.02 * size.y : box.high.y + max_component(size);
    const Vec3d corner = Vec3d(box.center().x - side / 2, height, box.center().z - side / 2);
    // u × v points down: x × z = −y.
    const Quad quad{Vec3(corner), Vec3(Vec3d(side, 0, 0)), Vec3(Vec3d(0, 0, side))};
    return SurfaceLight{quad, false, Rgb(1.0f), kNoObject, 0};
}

KernelScene of_scene_file(const Scene& loaded) {
    std::size_t left_out = 0;
    Mesh mesh = flattened(loaded, left_out);
    if (mesh.triangles.empty()) throw Error(loaded.path.string() + ": found spheres at most, expected triangles");
    KernelScene result =
        make_kernel_scene(loaded.path.stem().string(), Arrangement::kAlone, std::move(mesh), loaded.camera);
    result.left_out = left_out;
    if (!loaded.lights.empty()) result.lights = loaded.lights;
    return result;
}

} // namespace

Arrangement parse_arrangement(const std::string& name) {
    for (std::size_t i = 0; i < kNames.size(); ++i)
        if (name == kNames[i]) return static_cast<Arrangement>(i);
    throw Error("--scene: found " + name + ", expected alone, room or clutter");
}

const char* name_of(Arrangement arrangement) { return kNames[static_cast<std::size_t>(arrangement)]; }

bool is_bare_mesh(const std::filesystem::path& file) { return lower_case_ending(file) == ".obj"; }

Mesh enclosed(Mesh mesh, Vec3 center, float half) {
    std::vector<Vec3> positions;
    for (std::uint32_t i = 0; i < 8; ++i)
        positions.push_back(center + Vec3(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half));
    // Each face's corners, counter-clockwise seen from within.
    constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
        {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}}};
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const auto& [a, b, c, d] : kFaces) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
    }
    append(mesh, positions, triangles);
    return mesh;
}

Mesh cluttered(const Mesh& mesh) {
    constexpr double kScale = 0.7, kGrid = 1.1;
    const Box3d box = bounds_of(mesh);
    const double scale = kScale * 2 / max_component(box.diagonal());
    Mesh all;
    for (int copy = 0; copy < 27; ++copy) {
        const Mat4d turned = random_rotation(mix_bits(static_cast<std::uint64_t>(copy) + 1));
        const Vec3d place = Vec3d(copy % 3 - 1, copy / 3 % 3 - 1, copy / 9 - 1) * kGrid;
        std::vector<Vec3> positions;
        for (const Vec3& p : mesh.positions)
            positions.push_back(Vec3(place + transform_vector(turned, Vec3d(p) - box.center()) * scale));
        append(all, positions, mesh.triangles);
    }
    return all;
}

KernelScene make_kernel_scene(std::string name, Arrangement arrangement, Mesh mesh, const Camera& camera) {
    KernelScene result;
    result.mesh = std::move(name);
    result.arrangement = arrangement;
    result.camera = camera;
    result.enclosed = arrangement != Arrangement::kAlone;
    result.lights = {lamp_above(bounds_of(mesh), result.enclosed)};
    auto scene = std::make_unique<Scene>();
    scene->path = result.mesh;
    scene->camera = camera;
    scene->materials.emplace_back(Diffuse{});
    scene->material_names.emplace_back("clay");
    Object object;
    object.name = result.mesh;
    object.materials = {0};
    scene->objects = {object};
    scene->shapes.emplace_back(std::move(mesh));
    finish_scene(*scene);
    result.scene = std::move(scene);
    return result;
}

KernelScene load_kernel_scene(const std::filesystem::path& file, Arrangement arrangement) {
    Scene loaded = load_scene(file);
    if (!is_bare_mesh(file)) {
        if (arrangement != Arrangement::kAlone)
            throw Error(file.string() + ": a scene file is measured as it is; only a mesh (.obj) can be put in a " +
                        name_of(arrangement));
        return of_scene_file(loaded);
    }
    Mesh& given = std::get<Mesh>(loaded.shapes.front()); // the ground follows it: scene_around_mesh
    Mesh mesh;
    append(mesh, given.positions, given.triangles);
    const std::string name = file.stem().string();
    if (arrangement == Arrangement::kClutter)
        return make_kernel_scene(name, arrangement, enclosed(cluttered(mesh), Vec3(), kClutterHalf), clutter_camera());
    if (arrangement == Arrangement::kRoom) { // as large as it must be to hold the camera, and a little more
        const Box3d box = bounds_of(mesh);
        const double reach = max(max_component(abs(loaded.camera.eye - box.center())), max_component(box.diagonal()));
        mesh = enclosed(std::move(mesh), Vec3(box.center()), static_cast<float>(1.1 * reach));
    }
    return make_kernel_scene(name, arrangement, std::move(mesh), loaded.camera);
}

} // namespace duet::compare
