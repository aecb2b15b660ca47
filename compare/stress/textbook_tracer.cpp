#include "compare/stress/textbook_tracer.h"

#include <cmath>
#include <optional>

namespace duet::compare {

namespace {

constexpr float kNearest = 0.001f; // "shadow acne", Ray Tracing in One Weekend §9.2
constexpr float kParallel = 1e-8f; // the value of scratchapixel; the paper has 1e-6

std::optional<float> textbook_intersect(const Ray& ray, Vec3 a, Vec3 edge1, Vec3 edge2) {
    const Vec3 p = cross(ray.direction, edge2);
    const float det = dot(edge1, p);
    if (std::abs(det) < kParallel) return std::nullopt;
    const float inverse = 1 / det;
    const Vec3 s = ray.origin - a;
    const float u = dot(s, p) * inverse;
    if (u < 0 || u > 1) return std::nullopt;
    const Vec3 q = cross(s, edge1);
    const float v = dot(ray.direction, q) * inverse;
    if (v < 0 || u + v > 1) return std::nullopt;
    return dot(edge2, q) * inverse;
}

std::optional<float> textbook_intersect(const Ray& ray, const Sphere& sphere) {
    const Vec3 oc = sphere.center - ray.origin;
    const float a = length_squared(ray.direction), h = dot(ray.direction, oc);
    const float c = length_squared(oc) - sphere.radius * sphere.radius;
    const float discriminant = h * h - a * c;
    if (discriminant < 0) return std::nullopt;
    const float root = std::sqrt(discriminant), near = (h - root) / a;
    return near > kNearest ? near : (h + root) / a;
}

} // namespace

TextbookTracer::TextbookTracer(const Scene& scene) {
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
        const ObjectTransform transform = object_transform(scene.objects[o], 0);
        const Shape& shape = scene.shapes[scene.objects[o].shape];
        if (const auto* sphere = std::get_if<Sphere>(&shape)) {
            spheres_.push_back({o, *sphere, transform.to_object});
            continue;
        }
        for (std::uint32_t k = 0; k < primitive_count(shape); ++k) {
            const PrimitiveVertices corners = primitive_vertices(shape, k);
            const auto at = [&](std::size_t i) { return transform_point(transform.to_world, corners.p[i]); };
            for (std::size_t i = 2; i < static_cast<std::size_t>(corners.count); ++i)
                triangles_.push_back({o, k, at(0), at(i - 1) - at(0), at(i) - at(0)});
        }
    }
}

Hit TextbookTracer::nearest(const Ray& ray) const {
    Hit best;
    const auto offer = [&](std::uint32_t object, std::uint32_t primitive, std::optional<float> t) {
        if (t && *t > kNearest && *t < best.t) best = {.object = object, .primitive = primitive, .t = *t};
    };
    for (const Triangle& t : triangles_) offer(t.object, t.primitive, textbook_intersect(ray, t.a, t.edge1, t.edge2));
    for (const PlacedSphere& placed_sphere : spheres_) {
        Ray local = ray;
        local.origin = transform_point(placed_sphere.to_object, ray.origin);
        local.direction = transform_vector(placed_sphere.to_object, ray.direction);
        offer(placed_sphere.object, 0, textbook_intersect(local, placed_sphere.sphere));
    }
    return best;
}

} // namespace duet::compare
