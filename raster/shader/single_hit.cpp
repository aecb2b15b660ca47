#include "raster/shader/single_hit.h"

#include "common/camera/pixel_footprint.h"

namespace duet::raster {
namespace {

Vec3 to_object_normal(const ObjectView& object, Vec3 n) {
    return object.identity ? n : transform_normal(object.to_world, n);
}

/// Stores screen-space derivatives of the point where camera rays meet a plane, per pixel.
struct PointSteps {
    Vec3d dx, dy;
};
/// Computes t' = −n·(o' + t·d') / n·d, which follows from o + t·d = p, where o and d are linear in the pixel and n·p is
/// constant.
PointSteps point_steps(const Pinhole& pinhole, Vec2d pixel, double t, Vec3d n) {
    const Vec3d d = pinhole.direction + pinhole.direction_dx * pixel.x + pinhole.direction_dy * pixel.y;
    const auto step = [&](Vec3d origin_step, Vec3d direction_step) {
        const Vec3d along = origin_step + direction_step * t;
        return along - d * (dot(n, along) / dot(n, d));
    };
    return {step(pinhole.origin_dx, pinhole.direction_dx), step(pinhole.origin_dy, pinhole.direction_dy)};
}

/// Sets the weights' derivatives. They are the barycentrics of the point's derivative, a vector in the triangle's
/// plane.
void set_steps(HitCorners& at, const PassView& view, Vec2d pixel, const ObjectView& object) {
    const std::array<Vec3d, 3> p{Vec3d(object.point(at.p[0])), Vec3d(object.point(at.p[1])),
                                 Vec3d(object.point(at.p[2]))};
    const Vec3d ab = p[1] - p[0], ac = p[2] - p[0], n = cross(ab, ac);
    const PointSteps steps = point_steps(view.pinhole, pixel, at.depth, n);
    const auto interpolate_weights = [&](Vec3d step, std::array<float, 3>& weights) {
        const double b1 = dot(cross(step, ac), n) / dot(n, n), b2 = dot(cross(ab, step), n) / dot(n, n);
        weights = {static_cast<float>(-b1 - b2), static_cast<float>(b1), static_cast<float>(b2)};
    };
    interpolate_weights(steps.dx, at.dx);
    interpolate_weights(steps.dy, at.dy);
}

void set_weights(HitCorners& at, double b1, double b2) {
    at.weights = {static_cast<float>(1 - b1 - b2), static_cast<float>(b1), static_cast<float>(b2)};
}

/// Sets the corners of the hit triangle, or of the hit half of a quad, split as the rasterizer does.
void set_corners(HitCorners& at, const PackedShape& shape, const Hit& hit) {
    const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
    const std::size_t triangle = shape.quads() ? 2 * std::size_t{hit.primitive} + (u < v) : hit.primitive;
    for (std::size_t k = 0; k < 3; ++k) {
        const PackedVertex& corner = shape.vertices[shape.triangles[triangle][k]];
        at.p[k] = corner.p, at.n[k] = corner.n, at.uv[k] = {corner.u, corner.v};
        at.edges[k][k] = 1;
    }
    if (!shape.quads()) {
        at.middle = (at.p[0] + at.p[1] + at.p[2]) * (1.0f / 3);
        return set_weights(at, u, v);
    }
    const std::size_t diagonal = u < v ? 2 : 1; // the corner opposite to the diagonal
    for (Vec3& edges : at.edges) edges[diagonal] = 1;
    at.middle = (at.p[0] + at.p[3 - diagonal]) * 0.5f; // centroid of the whole quad
    set_weights(at, u < v ? u : u - v, u < v ? v - u : v);
}

void set_sphere(HitCorners& at, const Scene& scene, const PassView& view, const Hit& hit, Vec2d pixel,
                const ObjectView& object) {
    const Vec3d p(at.surface.p), n(at.surface.ng);
    const auto point = [&](Vec2d position) {
        const Rayd ray = view.pinhole.ray(position);
        Hit beside = hit;
        beside.t = static_cast<float>(dot(p - ray.origin, n) / dot(ray.direction, n));
        return surface_point(scene, rounded(ray, view.time), beside);
    };
    // at.surface may lack texture coordinates.
    const SurfacePoint here = surface_point(scene, rounded(view.pinhole.ray(pixel), view.time), hit);
    const std::array<SurfacePoint, 3> points{here, point({pixel.x + 1, pixel.y}), point({pixel.x, pixel.y + 1})};
    for (std::size_t k = 0; k < 3; ++k) {
        at.p[k] = points[k].p_object;
        // This is the sphere's own normal, even if the object is scaled non-uniformly.
        at.n[k] = normalize(to_object_normal(object, points[k].ns));
        at.uv[k] = points[k].uv;
        at.edges[k] = Vec3(1, 1, 1);
    }
    at.middle = at.p[0];
    at.weights = {1, 0, 0};
    at.dx = {-1, 1, 0};
    at.dy = {-1, 0, 1};
}

} // namespace

SurfacePoint filtered_point(const Scene& scene, const PassView& view, const Ray& ray, const Hit& hit,
                            int samples_per_pixel) {
    const SurfaceDetail detail = surface_detail(scene, material_index(scene, hit.object, hit.primitive));
    if (!scene.needs.footprints || detail == SurfaceDetail::kWithoutUv)
        return surface_point(scene, ray, hit, nullptr, detail);
    const RayFootprint footprint = PixelFootprint(view.pinhole, samples_per_pixel).at(ray, hit.t);
    return surface_point(scene, ray, hit, &footprint, detail);
}

Rgb hit_color(const Scene& scene, const PassView& view, const Ray& ray, const Hit& hit, int samples_per_pixel) {
    const SurfacePoint surface = filtered_point(scene, view, ray, hit, samples_per_pixel);
    return base_color(scene.materials[surface.material], scene.textures, surface);
}

Vec3 hit_normal(const Scene& scene, const PassView& view, const Hit& hit, Vec2d pixel, int samples_per_pixel) {
    const Ray ray = rounded(view.pinhole.ray(pixel), view.time);
    const SurfacePoint surface = filtered_point(scene, view, ray, hit, samples_per_pixel);
    return dot(surface.ng, ray.direction) > 0 ? -surface.ns : surface.ns;
}

Rgb hit_emission(const Scene& scene, const PassView& view, const Hit& hit, Vec2d pixel, int samples_per_pixel) {
    const Ray ray = rounded(view.pinhole.ray(pixel), view.time);
    const SurfacePoint surface = filtered_point(scene, view, ray, hit, samples_per_pixel);
    return emitted(scene.materials[surface.material], scene.textures, surface, -ray.direction);
}

HitCorners hit_corners(const PassView& view, const Hit& hit, Vec2d pixel, const ObjectView& object,
                       int samples_per_pixel) {
    const Scene& scene = object.data.scene;
    HitCorners at;
    const Rayd exact = view.pinhole.ray(pixel);
    const Ray ray = rounded(exact, view.time);
    at.depth = static_cast<double>(hit.t) * view.pinhole.near / exact.t_min;
    at.surface = filtered_point(scene, view, ray, hit, samples_per_pixel);
    const bool back = dot(at.surface.ng, ray.direction) > 0;
    at.ng = to_object_normal(object, back ? -at.surface.ng : at.surface.ng);
    at.ns = back ? -at.surface.ns : at.surface.ns;
    const std::size_t shape = scene.objects[hit.object].shape;
    if (std::holds_alternative<Sphere>(scene.shapes[shape])) {
        set_sphere(at, scene, view, hit, pixel, object);
    } else {
        set_corners(at, object.data.shapes[shape], hit);
        set_steps(at, view, pixel, object);
    }
    return at;
}

} // namespace duet::raster
