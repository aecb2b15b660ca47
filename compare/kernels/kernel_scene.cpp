#include "compare/kernels/kernel_scene.h"

#include "common/sampling/hash.h"
#include "common/system/error.h"
#include "common/system/file.h"
#include "common/system/name_table.h"

#include <array>
#include <optional>

namespace duet::compare {

namespace {

constexpr NameTable<Arrangement, 4> kNames{"--scene",
                                           {{{"alone", Arrangement::kAlone},
                                             {"room", Arrangement::kRoom},
                                             {"clutter", Arrangement::kClutter},
                                             {"instances", Arrangement::kInstances}}}};

Box3d bounds_of(const Mesh& mesh) {
    Box3d box;
    for (const Vec3& p : mesh.positions) box.extend(Vec3d(p));
    return box;
}

/// Appends positions and triangles only, because kernels use nothing else.
void append(Mesh& all, const std::vector<Vec3>& positions, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), positions.begin(), positions.end());
    for (const auto& [a, b, c] : triangles) all.triangles.push_back({first + a, first + b, first + c});
}

/// Appends a quad as its corners and two triangles.
void append(Mesh& all, const std::array<Vec3, 4>& quad) {
    append(all, {quad.begin(), quad.end()}, {{0, 1, 2}, {0, 2, 3}});
}

/// Holds the triangles of a scene in one mesh.
struct Flattened {
    Mesh mesh;
    std::vector<std::optional<std::uint32_t>> first; ///< index of each object's first triangle; none for a sphere
    std::size_t omitted_spheres = 0;                 ///< number of spheres omitted
};

/// Merges everything except spheres into one mesh in world space, at shutter opening.
Flattened flattened(const Scene& scene) {
    Flattened all;
    for (const Object& object : scene.objects) {
        const Shape& shape = scene.shapes[object.shape];
        if (std::holds_alternative<Sphere>(shape)) {
            ++all.omitted_spheres;
            all.first.emplace_back();
            continue;
        }
        all.first.emplace_back(static_cast<std::uint32_t>(all.mesh.triangles.size()));
        const Mat4 to_world = object_transform(object, static_cast<float>(scene.camera.shutter_open)).to_world;
        const bool fixed = object.identity && !object.moving;
        const auto placed = [&](Vec3 p) { return fixed ? p : transform_point(to_world, p); };
        if (const auto* mesh = std::get_if<Mesh>(&shape)) {
            std::vector<Vec3> positions;
            for (const Vec3& p : mesh->positions) positions.push_back(placed(p));
            append(all.mesh, positions, mesh->triangles);
        } else {
            for (const Quad& quad : std::get<QuadList>(shape).quads) {
                std::array<Vec3, 4> p = corners(quad);
                for (Vec3& q : p) q = placed(q);
                append(all.mesh, p);
            }
        }
    }
    return all;
}

/// Returns the scene's lights. Area lights refer to their triangles in the flattened mesh.
std::vector<Light> lights_of_flattened(const Flattened& flat, std::vector<Light> lights) {
    for (Light& light : lights)
        if (auto* surface = std::get_if<SurfaceLight>(&light)) {
            const auto first = surface->object == kNoObject ? std::nullopt : flat.first[surface->object];
            const std::uint32_t triangles = std::holds_alternative<Quad>(surface->shape) ? 2 : 1;
            surface->object = first ? 0 : kNoObject;
            surface->primitive = first ? *first + triangles * surface->primitive : 0;
        }
    return lights;
}

/// Returns a uniformly distributed rotation from a random unit quaternion (Shoemake 1992, "Uniform Random Rotations").
Mat4d random_rotation(std::uint64_t state) {
    const auto unit = [&](std::uint64_t i) { return static_cast<double>(stream_number(state, i) >> 11) * 0x1p-53; };
    const double r = unit(0), a = 2 * kPiDouble * unit(1), b = 2 * kPiDouble * unit(2);
    const double x = std::sqrt(1 - r) * std::sin(a), y = std::sqrt(1 - r) * std::cos(a);
    const double z = std::sqrt(r) * std::sin(b), w = std::sqrt(r) * std::cos(b);
    const double angle = 2 * std::acos(clamp(w, -1.0, 1.0));
    return rotation(normalize(Vec3d(x, y, z)), angle);
}

constexpr float kClutterHalf = 2.5f; ///< half the side of the box around the copies

/// Returns a camera in a corner of the box that looks at its center.
Camera clutter_camera() {
    Camera camera;
    camera.eye = {2.2, 1.5, 2.3};
    camera.look_at = {0, 0, 0};
    camera.fov_degrees = 55;
    return camera;
}

/// Returns a square area light above everything, facing down. In a closed room it is just below the ceiling.
SurfaceLight light_above(const Box3d& box, bool enclosed) {
    const Vec3d size = box.diagonal();
    const double side = 0.3 * max(size.x, size.z);
    const double height = enclosed ? box.high.y - 0.02 * size.y : box.high.y + max_component(size);
    const Vec3d corner = Vec3d(box.center().x - side / 2, height, box.center().z - side / 2);
    // The light faces along u × v, which points down because x × z = −y.
    const Quad quad{Vec3(corner), Vec3(Vec3d(side, 0, 0)), Vec3(Vec3d(0, 0, side))};
    return {quad, false, Rgb(1.0f), kNoObject, 0};
}

/// Adds the area light to a room. Its triangles become part of the room's mesh, which belongs to object `object`.
SurfaceLight add_ceiling_light(Mesh& room, std::uint32_t object) {
    SurfaceLight area_light = light_above(bounds_of(room), true);
    area_light.object = object;
    area_light.primitive = static_cast<std::uint32_t>(room.triangles.size());
    append(room, corners(std::get<Quad>(area_light.shape)));
    return area_light;
}

/// Returns the 27 transforms of the clutter arrangement for a mesh.
std::vector<Mat4d> clutter_transforms(const Mesh& mesh) {
    constexpr double kScale = 0.7, kGrid = 1.1;
    const Box3d box = bounds_of(mesh);
    const double scale = kScale * 2 / max_component(box.diagonal());
    std::vector<Mat4d> transforms;
    for (int copy = 0; copy < 27; ++copy) {
        const Mat4d rotated = random_rotation(mix_bits(static_cast<std::uint64_t>(copy) + 1));
        const Vec3d cell = Vec3d(copy % 3 - 1, copy / 3 % 3 - 1, copy / 9 - 1) * kGrid;
        transforms.push_back(translation(cell) * rotated * scaling(Vec3d(scale, scale, scale)) *
                             translation(-box.center()));
    }
    return transforms;
}

Object make_object(std::uint32_t shape, const Mat4d& to_world) {
    Object object;
    object.name = message("object ", shape);
    object.shape = shape;
    object.materials = {0};
    object.place(Mat4(to_world));
    return object;
}

KernelScene kernel_scene(std::string name, Arrangement arrangement, std::vector<Mesh> meshes,
                         std::vector<Object> objects, const Camera& camera) {
    KernelScene result;
    result.mesh = std::move(name);
    result.arrangement = arrangement;
    result.camera = camera;
    result.enclosed = arrangement != Arrangement::kAlone;
    auto scene = std::make_unique<Scene>();
    scene->path = result.mesh;
    scene->camera = camera;
    scene->materials.emplace_back(Diffuse{});
    scene->material_names.emplace_back("clay");
    scene->objects = std::move(objects);
    for (Mesh& mesh : meshes) scene->shapes.push_back(std::move(mesh));
    finish_scene(*scene);
    result.scene = std::move(scene);
    return result;
}

/// Returns the clutter arrangement with the copies as instances. The room is the last object.
KernelScene instanced(std::string name, Mesh mesh) {
    std::vector<Object> objects;
    for (const Mat4d& transform : clutter_transforms(mesh)) objects.push_back(make_object(0, transform));
    objects.push_back(make_object(1, Mat4d()));
    Mesh room = enclosed({}, Vec3(), kClutterHalf);
    const SurfaceLight area_light = add_ceiling_light(room, 27);
    KernelScene result = kernel_scene(std::move(name), Arrangement::kInstances, {std::move(mesh), std::move(room)},
                                      std::move(objects), clutter_camera());
    result.lights = {area_light};
    return result;
}

KernelScene kernel_scene_of_file(const Scene& loaded) {
    Flattened flat = flattened(loaded);
    if (flat.mesh.triangles.empty()) throw Error(loaded.path.string() + ": found spheres at most, expected triangles");
    std::vector<Light> lights = lights_of_flattened(flat, loaded.lights);
    KernelScene result =
        make_kernel_scene(loaded.path.stem().string(), Arrangement::kAlone, std::move(flat.mesh), loaded.camera);
    result.omitted_spheres = flat.omitted_spheres;
    if (!lights.empty()) result.lights = std::move(lights);
    return result;
}

} // namespace

Arrangement parse_arrangement(std::string_view name) { return kNames.value(name); }

std::string_view name_of(Arrangement arrangement) { return kNames.name(arrangement); }

bool is_bare_mesh(const std::filesystem::path& file) { return lower_case_extension(file) == ".obj"; }

Mesh enclosed(Mesh mesh, Vec3 center, float half) {
    std::vector<Vec3> positions;
    for (std::uint32_t i = 0; i < 8; ++i)
        positions.push_back(center + Vec3(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half));
    // Each face's corners are counter-clockwise as seen from inside.
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
    Mesh all;
    for (const Mat4d& transform : clutter_transforms(mesh)) {
        std::vector<Vec3> positions;
        for (const Vec3& p : mesh.positions) positions.push_back(Vec3(transform_point(transform, Vec3d(p))));
        append(all, positions, mesh.triangles);
    }
    return all;
}

std::size_t KernelScene::triangle_count() const {
    std::size_t count = 0;
    for (std::size_t object = 0; object < scene->objects.size(); ++object) count += mesh_of(object).triangles.size();
    return count;
}

KernelScene make_kernel_scene(std::string name, Arrangement arrangement, Mesh mesh, const Camera& camera) {
    const bool room = arrangement != Arrangement::kAlone;
    const SurfaceLight area_light = room ? add_ceiling_light(mesh, 0) : light_above(bounds_of(mesh), false);
    KernelScene result =
        kernel_scene(std::move(name), arrangement, {std::move(mesh)}, {make_object(0, Mat4d())}, camera);
    result.lights = {area_light};
    return result;
}

KernelScene load_kernel_scene(const std::filesystem::path& file, Arrangement arrangement) {
    Scene loaded = load_scene(file);
    if (!is_bare_mesh(file)) {
        if (arrangement != Arrangement::kAlone)
            throw Error(message(
                file.string(), ": a scene file is measured as it is; only a mesh (.obj) can be put in a ",
                name_of(arrangement)));
        return kernel_scene_of_file(loaded);
    }
    const Mesh& given = std::get<Mesh>(loaded.shapes.front()); // the ground follows (default_scene_for_mesh)
    Mesh mesh;
    append(mesh, given.positions, given.triangles);
    const std::string name = file.stem().string();
    if (arrangement == Arrangement::kInstances) return instanced(name, std::move(mesh));
    if (arrangement == Arrangement::kClutter)
        return make_kernel_scene(name, arrangement, enclosed(cluttered(mesh), Vec3(), kClutterHalf), clutter_camera());
    if (arrangement == Arrangement::kRoom) { // large enough to contain the camera, plus a margin
        const Box3d box = bounds_of(mesh);
        const double reach = max(max_component(abs(loaded.camera.eye - box.center())), max_component(box.diagonal()));
        mesh = enclosed(std::move(mesh), Vec3(box.center()), static_cast<float>(1.1 * reach));
    }
    return make_kernel_scene(name, arrangement, std::move(mesh), loaded.camera);
}

} // namespace duet::compare
