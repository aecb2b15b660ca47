#include "raster/prepare.h"

#include "raster/geometry.h"

#include <algorithm>

namespace duet::raster {
namespace {

bool all_opaque(const Scene& scene, const Object& object) {
    return std::none_of(object.materials.begin(), object.materials.end(), [&](std::uint32_t material) {
        return std::holds_alternative<Dielectric>(scene.materials[material]);
    });
}

bool any_emissive(const Scene& scene, const Object& object) {
    return std::any_of(object.materials.begin(), object.materials.end(),
                       [&](std::uint32_t material) { return emitter(scene.materials[material]) != nullptr; });
}

PreparedObject prepare_object(const Scene& scene, const Object& object) {
    const Shape& shape = scene.shapes[object.shape];
    PreparedObject result;
    result.bounds = bounds(shape, object.to_world);
    // Matrix entries are interpolated, so a point moves on a straight line: between the bounds of both ends.
    if (object.moving) result.bounds.extend(bounds(shape, object.to_world_end));
    const Mesh* mesh = std::get_if<Mesh>(&shape);
    result.solid = mesh != nullptr && mesh->closed && all_opaque(scene, object);
    return result;
}

} // namespace

Prepared prepare(const Scene& scene, const Settings& settings) {
    PreparedData data{.scene = scene,
                      .objects = {},
                      .polygonal = {},
                      .spheres = {},
                      .irradiance = Irradiance(scene.environment, settings.threads),
                      .ambient = mean_radiance(scene.environment)};
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const Shape& shape = scene.shapes[object.shape];
        data.objects.push_back(prepare_object(scene, object));
        (std::holds_alternative<Sphere>(shape) ? data.spheres : data.polygonal).push_back(i);
        data.primitives += primitive_count(shape);
        const bool stretched = std::holds_alternative<Sphere>(shape) && surface_light_index(scene, i, 0) < 0;
        data.unsampled_emitters =
            data.unsampled_emitters || ((object.moving || stretched) && any_emissive(scene, object));
    }
    data.memory_bytes = static_cast<std::int64_t>(sizeof(PreparedData) + data.objects.size() * sizeof(PreparedObject) +
                                                  scene.objects.size() * sizeof(std::uint32_t));
    data.geometries = std::make_shared<GeometryPool>();
    return Prepared(std::make_shared<const PreparedData>(std::move(data)));
}

} // namespace duet::raster
