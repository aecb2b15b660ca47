#include "raster/shadows/emitter.h"

#include "common/vec/box.h"

#include <cmath>
#include <vector>

namespace duet::raster {
namespace {

constexpr double kFlat = 1e-4; ///< largest distance from a common plane, relative to a group's size

Emitter bounding_sphere(std::span<const Vec3d> points) {
    Box3d box;
    for (const Vec3d p : points) box.extend(p);
    Emitter result;
    result.center = box.center();
    result.radius = length(box.diagonal()) / 2;
    return result;
}

} // namespace

Emitter Emitter::of(const SurfaceLight& light) {
    Emitter result;
    if (const auto* quad = std::get_if<Quad>(&light.shape)) {
        result.kind = Kind::kParallelogram;
        result.u = Vec3d(quad->u), result.v = Vec3d(quad->v);
        result.center = Vec3d(quad->corner) + (result.u + result.v) * 0.5;
    } else if (const auto* triangle = std::get_if<SurfaceLight::Triangle>(&light.shape)) {
        result.kind = Kind::kTriangle;
        result.u = Vec3d(triangle->b) - Vec3d(triangle->a), result.v = Vec3d(triangle->c) - Vec3d(triangle->a);
        result.center = Vec3d(triangle->a) + (result.u + result.v) / 3.0;
    } else {
        const auto& sphere = std::get<Sphere>(light.shape);
        result.center = Vec3d(sphere.center);
        result.radius = static_cast<double>(sphere.radius);
        return result;
    }
    result.normal = normalize(cross(result.u, result.v));
    return result;
}

Emitter Emitter::of(std::span<const SurfaceLight> lights) {
    if (lights.size() == 1) return of(lights.front());
    std::vector<Vec3d> points;
    bool flat = true;
    const Emitter first = of(lights.front());
    for (const SurfaceLight& light : lights) {
        const Emitter one = of(light);
        flat = flat && dot(one.normal, first.normal) > 1 - kFlat;
        if (const auto* quad = std::get_if<Quad>(&light.shape))
            for (const Vec3 p : corners(*quad)) points.emplace_back(p);
        else if (const auto* t = std::get_if<SurfaceLight::Triangle>(&light.shape))
            points.insert(points.end(), {Vec3d(t->a), Vec3d(t->b), Vec3d(t->c)});
    }
    const Emitter sphere = bounding_sphere(points);
    for (const Vec3d p : points)
        flat = flat && std::abs(dot(first.normal, p - points.front())) <= kFlat * sphere.radius;
    if (!flat) return sphere;
    Emitter best;
    double least = kPiDouble * 1e300;
    for (const Vec3d edge : {first.u, first.v, first.v - first.u}) {
        const Vec3d s = normalize(edge), t = cross(first.normal, s);
        Vec2d low(1e300, 1e300), high(-1e300, -1e300);
        for (const Vec3d p : points) {
            low = {min(low.x, dot(p, s)), min(low.y, dot(p, t))};
            high = {max(high.x, dot(p, s)), max(high.y, dot(p, t))};
        }
        const double area = (high.x - low.x) * (high.y - low.y);
        if (area >= least) continue;
        least = area;
        best = {Kind::kParallelogram,
                s * ((low.x + high.x) / 2) + t * ((low.y + high.y) / 2) + first.normal *
                    dot(first.normal, points.front()),
                s * (high.x - low.x), t * (high.y - low.y), first.normal, 0};
    }
    return best;
}

} // namespace duet::raster
