// This header builds rooms with lights and surfaces of every kind.
#pragma once

#include "raytrace/sampling/sampler.h"
#include "tests/raytrace/scene_builder.h"

namespace duet::raytrace {

enum class RoomLight { kRectangle, kParallelogram, kTriangle, kSphere, kTwoSided, kMany, kPoint, kSpot, kSun, kSky };
inline constexpr RoomLight kRoomLights[] = {
    RoomLight::kRectangle, RoomLight::kParallelogram, RoomLight::kTriangle, RoomLight::kSphere, RoomLight::kTwoSided,
    RoomLight::kMany,      RoomLight::kPoint,         RoomLight::kSpot,     RoomLight::kSun,    RoomLight::kSky};

struct Placement {
    float scale = 1;
    Vec3 at{0, 0, 0};
    Vec3 operator()(float x, float y, float z) const { return Vec3(x, y, z) * scale + at; }
};

inline void add_light(SceneBuilder& builder, RoomLight light, const Placement& place) {
    const float s = place.scale;
    const auto emissive = [&](bool two_sided) {
        return builder.material(Emissive{Rgb(9.0f, 8, 6), two_sided, {Rgb(0.0f)}});
    };
    const auto add_rectangle = [&](float x, Vec3 u, Vec3 v, bool two_sided) {
        builder.add(quad(place(x, 1.9f, -0.4f), u * s, v * s), emissive(two_sided));
    };
    const Vec3 down = normalize(Vec3(0.2f, -1, -0.3f));
    switch (light) {
    case RoomLight::kRectangle:
        return add_rectangle(-0.3f, {0.6f, 0, 0}, {0, 0, 0.5f}, false);
    case RoomLight::kParallelogram:
        return add_rectangle(-0.3f, {0.6f, 0, 0}, {0.2f, 0.05f, 0.5f}, false);
    case RoomLight::kTwoSided:
        return add_rectangle(-0.3f, {0.4f, 0.3f, 0}, {0, 0, 0.5f}, true);
    case RoomLight::kMany:
        for (const float x : {-0.9f, -0.4f, 0.1f, 0.6f}) add_rectangle(x, {0.2f, 0, 0}, {0, 0, 0.2f}, x > 0);
        return;
    case RoomLight::kTriangle: {
        Mesh mesh;
        mesh.positions = {place(-0.4f, 1.9f, -0.4f), place(0.4f, 1.9f, -0.4f), place(0, 1.9f, 0.4f)};
        mesh.triangles = {{0, 1, 2}};
        builder.add(mesh, emissive(true));
        return;
    }
    case RoomLight::kSphere:
        builder.add(Sphere{place(0.2f, 1.6f, 0), 0.2f * s}, emissive(false));
        return;
    // The point light is in the ceiling.
    case RoomLight::kPoint:
        builder.scene.lights.push_back(PointLight{place(0, 2, 0), Rgb(4 * s * s)});
        return;
    case RoomLight::kSpot:
        builder.scene.lights.push_back(SpotLight{place(0, 1.8f, 0), down, Rgb(4 * s * s), 0.95f, 0.5f});
        return;
    case RoomLight::kSun:
        builder.scene.lights.push_back(SunLight{down, Rgb(3.0f)});
        return;
    case RoomLight::kSky:
        builder.scene.environment = SkyEnvironment{Rgb(0.3f), Rgb(0.4f, 0.6f, 1.0f)};
        return;
    }
}

// Selects the number of objects in the room: so few that rays test them all, or so many that rays traverse a BVH.
enum class ObjectCount { kFew, kSome, kMany };

// Adds narrow and wide metal lobes, given by color and by name, mirrors and glass, on quads, spheres and meshes with
// vertex normals.
inline void add_shiny_objects(SceneBuilder& builder, int levels, const Placement& place) {
    const float s = place.scale;
    const Material materials[] = {Metal{{Rgb(0.9f, 0.6f, 0.3f)}, 0.8f},
                                  Metal{{Rgb(0.8f)}, 0.1f},
                                  Metal{{}, 0.5f, *find_conductor("gold")},
                                  Metal{{}, 0, *find_conductor("copper")},
                                  Metal{{Rgb(0.7f, 0.8f, 0.9f)}, 0},
                                  Dielectric{1.5f, {Rgb(0.95f, 0.9f, 1)}},
                                  Dielectric{1.33f, {Rgb(1.0f)}}};
    float x = -0.85f;
    for (const Material& material : materials) {
        const std::uint32_t it = builder.material(material);
        builder.add(Sphere{place(x, 0.12f, 0.85f), 0.11f * s}, it);
        builder.add(icosphere(levels, 0.11f * s, place(x, 0.4f, 0.6f), true), it);
        builder.add(quad(place(x - 0.1f, 0.6f, -0.2f), {0.2f * s, 0, 0.05f * s}, {0, 0.25f * s, 0.02f * s}), it);
        x += 0.28f;
    }
}

// Selects the materials of walls and objects: mostly matte, or including all kinds of metal and glass.
enum class Finish { kMatte, kShiny };

// Returns a room without a front wall that contains surfaces of every batched kind and of the other kinds.
inline Scene room(RoomLight light, ObjectCount count, const Placement& place, Finish finish = Finish::kMatte) {
    SceneBuilder builder;
    const float s = place.scale;
    const std::uint32_t white = builder.material(Diffuse{{Rgb(0.7f)}}),
                        red = builder.material(Diffuse{{Rgb(0.6f, 0.1f, 0.1f)}});
    const std::uint32_t black = builder.material(Diffuse{{Rgb(0.0f)}}),
                        brushed = builder.material(Metal{{Rgb(0.9f)}, 0.4f});
    builder.add(quad(place(-1, 0, 1), {2 * s, 0, 0}, {0, 0, -2 * s}), white);
    if (light != RoomLight::kSun && light != RoomLight::kSky)
        builder.add(quad(place(-1, 2, -1), {2 * s, 0, 0}, {0, 0, 2 * s}), white);
    builder.add(quad(place(-1, 0, -1), {2 * s, 0, 0}, {0, 2 * s, 0}), white);
    builder.add(quad(place(-1, 0, 1), {0, 0, -2 * s}, {0, 2 * s, 0}), red);
    builder.add(quad(place(1, 0, -1), {0, 0, 2 * s}, {0, 2 * s, 0}), black);
    builder.add(Sphere{place(-0.4f, 0.35f, 0.3f), 0.35f * s}, red);
    builder.add(Sphere{place(0.5f, 0.2f, 0.6f), 0.2f * s}, builder.material(Dielectric{1.5f, {Rgb(0.95f)}}));
    const int levels = count == ObjectCount::kMany ? 3 : 0;
    if (finish == Finish::kShiny) add_shiny_objects(builder, levels, place);
    if (count != ObjectCount::kFew) builder.add(icosphere(levels, 0.3f * s, place(0.3f, 0.6f, -0.3f), false), white);
    if (count != ObjectCount::kFew) builder.add(icosphere(levels, 0.2f * s, place(-0.5f, 1, -0.5f), true), brushed);
    if (count != ObjectCount::kFew) builder.add(icosphere(levels, 0.35f * s, place(-0.1f, 1.2f, 0.2f), true), red);
    add_light(builder, light, place);
    builder.scene.camera.eye = Vec3d(place(0, 1, 3.2f));
    builder.scene.camera.look_at = Vec3d(place(0, 1, 0));
    builder.scene.camera.fov_degrees = 45;
    return builder.finish();
}

// Returns intersecting objects of all materials and shapes at random positions: normals in any direction and meshes
// of several materials. It also has surfaces that are not batched: moving ones, instances, and mirrors that absorb
// all light.
inline Scene wild_room(int seed, const Placement& place) {
    SceneBuilder builder;
    Sampler sampler(SamplerKind::kIndependent, static_cast<std::uint64_t>(seed), 1);
    const auto random = [&] { return sampler.get_2d().x; };
    const auto direction = [&] { return uniform_sphere(sampler.get_2d()); };
    const float s = place.scale;
    const Material kinds[] = {Metal{{Rgb(0.9f, 0.6f, 0.3f)}, 0.8f},
                              Metal{{Rgb(0.0f)}, 0.5f},
                              Metal{{Rgb(1.0f)}, 1.0f},
                              Metal{{Rgb(0.8f)}, 0.0101f},
                              Metal{{}, 0.5f, *find_conductor("gold")},
                              Metal{{}, 0, *find_conductor("copper")},
                              Metal{{Rgb(0.0f)}, 0},
                              Dielectric{1.0f, {Rgb(1.0f)}},
                              Dielectric{4.0f, {Rgb(0.5f, 1, 0)}},
                              Dielectric{1.5f, {Rgb(0.0f)}},
                              Dielectric{1.0005f, {Rgb(1.0f)}},
                              Diffuse{{Rgb(0.7f)}},
                              Diffuse{{Rgb(1.0f)}},
                              Diffuse{{Rgb(0.0f)}},
                              Diffuse{{Rgb(0.4f)}, {0.6f}}};
    std::vector<std::uint32_t> materials;
    for (const Material& kind : kinds) materials.push_back(builder.material(kind));
    const std::uint32_t white = materials[11];
    const auto any = [&](int i) { return materials[static_cast<std::size_t>(7 * i + seed) % materials.size()]; };
    builder.add(quad(place(-2, -1, 2), {4 * s, 0, 0}, {0, 0, -4 * s}), white);
    builder.add(quad(place(-2, -1, -2), {4 * s, 0, 0}, {0, 4 * s, 0}), any(0));
    for (int i = 0; i < 40; ++i) {
        const Vec3 center = place(3 * random() - 1.5f, 2 * random() - 1, 3 * random() - 1.5f);
        const float radius = (0.02f + 0.3f * random()) * s;
        if (i % 4 == 0) builder.add(Sphere{center, i % 16 == 0 ? 1e-5f * s : radius}, any(i));
        if (i % 4 == 1) builder.add(quad(center, direction() * (0.5f * s), direction() * (0.5f * s)), any(i));
        if (i % 4 < 2) continue;
        Mesh mesh = icosphere(i % 3, radius, center, i % 4 == 3);
        for (Vec3& normal : mesh.normals) normal = random() < 0.3f ? normalize(normal + 0.7f * direction()) : normal;
        const std::uint32_t object = builder.add(mesh, any(i));
        if (i % 5 != 0) continue;
        auto& slots = std::get<Mesh>(builder.scene.shapes.edit(builder.scene.objects[object].shape)).material_slots;
        for (std::size_t k = 0; k < mesh.triangles.size(); ++k) slots.push_back(static_cast<std::uint16_t>(k % 3));
        builder.scene.objects[object].materials = {any(i), any(i + 1), white};
    }
    if (seed % 3 == 0) {
        const std::uint32_t mesh = builder.shape(icosphere(1, 0.3f, {}, true)),
                            sphere = builder.shape(Sphere{{}, 0.3f});
        const Mat4 scaled = scaling(Vec3(s, s, s));
        builder.place_moving(mesh, any(3), translation(place.at) * scaled, translation(place(0.5f, 0.2f, 0)) * scaled);
        builder.place(sphere, any(4), translation(place(-0.5f, 0.3f, 0.6f)) * scaled);
    }
    add_light(builder, kRoomLights[static_cast<std::size_t>(seed) % std::size(kRoomLights)], place);
    builder.scene.camera.eye = Vec3d(place(0, 0.5f, 4));
    builder.scene.camera.look_at = Vec3d(place(0, 0, 0));
    builder.scene.camera.fov_degrees = 50;
    return builder.finish();
}

} // namespace duet::raytrace
