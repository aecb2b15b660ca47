#include "common/scene/emitter_texture.h"

#include "common/geometry/quad.h"
#include "common/geometry/sphere.h"

#include <cmath>

namespace duet {

namespace {

constexpr int kGrid = 8; ///< sample points per axis

/// Returns the surface point at (a, b) in [0, 1]² of a primitive. Equal areas of the square map to equal areas of
/// the primitive. The footprint is one cell of the grid.
SurfacePoint sample_primitive(const Shape& shape, std::uint32_t primitive, float a, float b) {
    SurfacePoint point;
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        const float y = 1 - 2 * b, ring_radius = std::sqrt(max(0.0f, 1 - y * y)), phi = 2 * kPi * a;
        const Vec3 n{ring_radius * std::sin(phi), y, -ring_radius * std::cos(phi)};
        point.uv = sphere_uv(n);
        point.p_object = sphere->center + n * sphere->radius;
        point.duv_dx = {1.0f / kGrid, 0};
        point.duv_dy = {0, 1.0f / kGrid};
        return point;
    }
    const bool quad = std::holds_alternative<QuadList>(shape);
    if (!quad && a + b > 1) a = 1 - a, b = 1 - b;
    const Hit hit{0, primitive, a, b, 1};
    point = surface_point(shape, hit, Ray{}, Mat4(), Mat4(), true);
    const auto cell = [&](float da, float db) {
        const Hit neighbor{0, primitive, a + da / kGrid, b + db / kGrid, 1};
        return surface_point(shape, neighbor, Ray{}, Mat4(), Mat4(), true).uv - point.uv;
    };
    const Vec2 da = cell(1, 0), db = cell(0, 1);
    point.duv_dx = da;
    point.duv_dy = db;
    return point;
}

} // namespace

Rgb mean_radiance(const Scene& scene, std::uint32_t object, std::uint32_t primitive, const Emissive& emissive) {
    if (emissive.radiance_texture < 0) return emissive.radiance;
    const Shape& shape = scene.shapes[scene.objects[object].shape];
    const RgbSlot slot{emissive.radiance, emissive.radiance_texture};
    Rgb sum;
    for (int i = 0; i < kGrid; ++i)
        for (int j = 0; j < kGrid; ++j)
            sum += evaluate(scene.textures, slot,
                            sample_primitive(shape, primitive, (static_cast<float>(i) + 0.5f) / kGrid,
                                             (static_cast<float>(j) + 0.5f) / kGrid));
    return sum * (1.0f / (kGrid * kGrid));
}

Rgb radiance_toward(const Scene& scene, const SurfaceLight& light, Vec3 p, Vec3 w, float distance) {
    const Material& material = scene.materials[material_index(scene, light.object, light.primitive)];
    const Emissive* emissive = emitter(material);
    if (emissive == nullptr || emissive->radiance_texture < 0) return light.radiance;
    const Object& object = scene.objects[light.object]; // static: moving objects have no surface lights
    const Shape& shape = scene.shapes[object.shape];
    const Ray ray{p, w};
    Hit hit{light.object, light.primitive, 0, 0, distance};
    if (!std::holds_alternative<Sphere>(shape)) {
        const Ray object_ray = object.identity ? ray : to_object_space(ray, object.to_world, object.to_object);
        const PrimitiveVertices c = primitive_vertices(shape, light.primitive);
        const auto triangle_hit = c.count == 4 ? intersect_quad(ShearedRay(object_ray), c.p)
                                               : intersect_triangle(ShearedRay(object_ray), c.p[0], c.p[1], c.p[2]);
        if (!triangle_hit) return light.radiance;
        hit.u = triangle_hit->u;
        hit.v = triangle_hit->v;
    }
    return evaluate(scene.textures, RgbSlot{emissive->radiance, emissive->radiance_texture},
                    surface_point(scene, ray, hit));
}

} // namespace duet
