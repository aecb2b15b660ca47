#include "common/scene/scene.h"

#include "common/system/error.h"

#include <algorithm>

namespace duet {

void Object::place(const Mat4& start, const Mat4& end) {
    to_world = start;
    to_world_end = end;
    // This is the inverse of the rounded matrix, because the pipelines apply the rounded one.
    to_object = Mat4(inverse_affine(Mat4d(start)));
    moving = !(start == end);
    identity = !moving && start == Mat4();
}

ObjectTransform object_transform(const Object& object, float time) {
    if (!object.moving) return {object.to_world, object.to_object};
    const Mat4 to_world = lerp(object.to_world, object.to_world_end, time);
    return {to_world, Mat4(inverse_affine(Mat4d(to_world)))};
}

namespace {

SurfacePoint base_surface_point(const Scene& scene, const Ray& ray, const Hit& hit, SurfaceDetail detail) {
    const Object& object = scene.objects[hit.object];
    const Shape& shape = scene.shapes[object.shape];
    // The point is constructed in place, because a copy right after its members are written would wait for these
    // stores.
    SurfacePoint point = [&] {
        if (!object.moving)
            return surface_point(shape, hit, ray, object.to_world, object.to_object, object.identity, detail);
        const ObjectTransform moved = object_transform(object, ray.time);
        return surface_point(shape, hit, ray, moved.to_world, moved.to_object, false, detail);
    }();
    point.object = hit.object;
    point.material = material_index(scene, hit.object, hit.primitive);
    return point;
}

} // namespace

SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit, const RayFootprint* footprint,
                           SurfaceDetail detail) {
    SurfacePoint point = base_surface_point(scene, ray, hit, detail);
    if (scene.needs.footprints && footprint != nullptr) set_footprint(*footprint, ray.direction, point);
    if (scene.needs.normal_maps) apply_normal_maps(scene.textures, scene.maps[point.material], ray.direction, point);
    return point;
}

float opacity(const Scene& scene, const Ray& ray, const Hit& hit) {
    const SurfaceMaps& maps = scene.maps[material_index(scene, hit.object, hit.primitive)];
    if (!maps.has_transparency()) return 1;
    if (maps.opacity.constant()) return opacity(scene.textures, maps, SurfacePoint{});
    return opacity(scene.textures, maps, base_surface_point(scene, ray, hit, SurfaceDetail::kAll));
}

SurfaceDetail surface_detail(const Scene& scene, std::uint32_t material) {
    bool textured = scene.maps[material].perturbs_normal();
    for_each_texture(scene.materials[material], [&](std::int32_t texture) { textured = textured || texture >= 0; });
    return textured ? SurfaceDetail::kAll : SurfaceDetail::kWithoutUv;
}

std::uint32_t material_index(const Scene& scene, std::uint32_t object, std::uint32_t primitive) {
    const Object& o = scene.objects[object];
    const auto* mesh = std::get_if<Mesh>(&scene.shapes[o.shape]);
    const std::size_t slot = mesh != nullptr && !mesh->material_slots.empty() ? mesh->material_slots[primitive] : 0;
    return o.materials[slot];
}

std::int64_t surface_light_index(const Scene& scene, std::uint32_t object, std::uint32_t primitive) {
    const auto first = scene.lights.begin() + static_cast<std::ptrdiff_t>(scene.first_surface_light);
    const auto found = std::lower_bound(first, scene.lights.end(), std::pair(object, primitive),
                                        [](const Light& light, const auto& key) {
                                            const auto& surface = std::get<SurfaceLight>(light);
                                            return std::pair(surface.object, surface.primitive) < key;
                                        });
    if (found == scene.lights.end()) return -1;
    const auto& surface = std::get<SurfaceLight>(*found);
    return surface.object == object && surface.primitive == primitive ? found - scene.lights.begin() : -1;
}

PrimitiveVertices primitive_vertices(const Shape& shape, std::uint32_t primitive) {
    if (const auto* mesh = std::get_if<Mesh>(&shape)) {
        const auto& [a, b, c] = mesh->triangles[primitive];
        return {{mesh->positions[a], mesh->positions[b], mesh->positions[c]}, 3};
    }
    const auto* list = std::get_if<QuadList>(&shape);
    DUET_CHECK(list != nullptr); // spheres have no corners
    return {corners(list->quads[primitive]), 4};
}

} // namespace duet
