#include "raster/geometry/sphere.h"

#include "common/geometry/sphere.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace duet::raster {
namespace {

/// Represents a linear function over the solid unit sphere, g·n + offset with |n| <= 1. A matrix row restricted to a
/// sphere has this form.
struct SphereFunction {
    Vec3d g;
    double offset;
};
SphereFunction row_over_sphere(const std::array<double, 4>& row, const Sphere& sphere) {
    const Vec3d g(row[0], row[1], row[2]);
    return {g * static_cast<double>(sphere.radius), dot(g, Vec3d(sphere.center)) + row[3]};
}

struct Interval {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    void add(double x) {
        if (std::isnan(x)) return;
        low = std::min(low, x);
        high = std::max(high, x);
    }
};

/// Returns the extremes of x/w over the part of the sphere with w >= near > 0. They lie where a plane x = s·w is
/// tangent to the sphere, if that point is beyond the near plane, or on the circle in which the near plane
/// intersects the sphere.
Interval perspective_extremes(SphereFunction x, const SphereFunction& w, double near) {
    Interval result;
    const double gw = length(w.g);
    // Measure relative to the projected center, if there is one: then no two terms of the discriminant cancel.
    const double shift = w.offset > gw ? x.offset / w.offset : 0;
    x.g = x.g - w.g * shift;
    x.offset -= w.offset * shift;

    // The tangency condition |x.g − s·w.g| = |x.offset − s·w.offset| is a·s² − 2b·s + c = 0.
    const double a = (w.offset - gw) * (w.offset + gw), b = x.offset * w.offset - dot(x.g, w.g);
    const double c = x.offset * x.offset - length_squared(x.g);
    const double discriminant = b * b - a * c;
    if (discriminant >= 0) {
        const double q = b + std::copysign(std::sqrt(discriminant), b);
        for (const double s : {q / a, c / q}) {
            const Vec3d normal = x.g - w.g * s;
            const double size = length_squared(normal);
            const Vec3d overlap = normal * (-(x.offset - s * w.offset) / size);
            if (dot(overlap, w.g) + w.offset >= near * (1 - 1e-9)) result.add(s + shift);
        }
    }
    const double height = (near - w.offset) / gw; // height of the near plane above the center, in radii
    if (std::abs(height) <= 1) {
        const Vec3d up = w.g / gw;
        const double along = dot(x.g, up);
        const double reach = length(x.g - up * along) * safe_sqrt((1 - height) * (1 + height));
        const double middle = along * height + x.offset;
        result.add((middle - reach) / near + shift);
        result.add((middle + reach) / near + shift);
    }
    return result;
}

/// Returns the first pixel and one past the last pixel that may hold a sample within the interval, with one pixel
/// of margin for the rounding of float rays.
std::pair<int, int> pixel_range(const Interval& extremes, int size) {
    const double low = std::clamp(extremes.low, -2.0, size + 2.0), high = std::clamp(extremes.high, -2.0, size + 2.0);
    return {std::clamp(static_cast<int>(std::floor(low)) - 1, 0, size),
            std::clamp(static_cast<int>(std::ceil(high)) + 1, 0, size)};
}

/// narrowed() rounds each lane to float, and widened() is its inverse.
Vec3T<NarrowBatch> narrowed(const Vec3T<Doubles>& v) { return {to_floats(v.x), to_floats(v.y), to_floats(v.z)}; }
Vec3T<Doubles> widened(const Vec3T<NarrowBatch>& v) { return {to_doubles(v.x), to_doubles(v.y), to_doubles(v.z)}; }

} // namespace

float DrawSphere::nearest(const Ray& ray) const {
    const Ray local = identity ? ray : to_object_space(ray, to_world, to_object);
    return dot(sphere.center - local.origin, local.direction) / length_squared(local.direction);
}

std::optional<float> DrawSphere::intersect(const Ray& ray) const {
    return intersect_sphere(identity ? ray : to_object_space(ray, to_world, to_object), sphere);
}

Doubles DrawSphere::intersect(const CameraRays& rays) const {
    const Doubles none(std::numeric_limits<double>::infinity());
    Vec3T<Doubles> origin = rays.origin, direction = rays.direction;
    if (!identity) { // as to_object_space() does
        const Mat4T<NarrowBatch> m(to_world), inverse(to_object);
        origin = widened(transform_point_inverse(m, inverse, narrowed(origin)));
        direction = widened(transform_vector(inverse, narrowed(direction)));
    }
    const SphereTest<Doubles> test(broadcast<Doubles>(Vec3d(sphere.center)) - origin,
                                   SphereTestLine<Doubles>(direction), Doubles(static_cast<double>(sphere.radius)));
    const auto met = test.discriminant >= Doubles(0.0);
    if (!xsimd::any(met)) return none;
    const auto roots = test.roots();
    const Doubles near = round_to_float(roots.near), far = round_to_float(roots.far),
                  t_min = round_to_float(rays.t_min);
    const Doubles beyond = xsimd::select((far > t_min) & (far < none), far, none);
    const Doubles first = xsimd::select((near > t_min) & (near < none), near, beyond);
    return xsimd::select(met, first, none);
}

PixelRect sphere_bounds(const Sphere& sphere, const Mat4d& to_pixel, const Viewport& viewport) {
    const SphereFunction x = row_over_sphere(to_pixel[0], sphere), y = row_over_sphere(to_pixel[1], sphere);
    const SphereFunction depth = row_over_sphere(to_pixel[2], sphere), w = row_over_sphere(to_pixel[3], sphere);
    if (depth.offset + length(depth.g) < viewport.near) return {};
    const auto extremes = [&](const SphereFunction& f) {
        if (length_squared(w.g) > 0) return perspective_extremes(f, w, viewport.near);
        return Interval{f.offset - length(f.g), f.offset + length(f.g)}; // orthographic: w is 1
    };
    const auto [x0, x1] = pixel_range(extremes(x), viewport.width);
    const auto [y0, y1] = pixel_range(extremes(y), viewport.height);
    return {x0, y0, x1, y1};
}

std::vector<DrawSphere> set_up_spheres(const Scene& scene, const std::vector<std::uint32_t>& objects,
                                       const Pinhole& pinhole, float time, const Viewport& viewport) {
    std::vector<DrawSphere> result;
    for (const std::uint32_t index : objects) {
        const Object& object = scene.objects[index];
        DrawSphere draw;
        draw.object = index, draw.identity = object.identity;
        draw.sphere = std::get<Sphere>(scene.shapes[object.shape]);
        if (!object.identity) {
            const ObjectTransform transform = object_transform(object, time);
            draw.to_world = transform.to_world;
            draw.to_object = transform.to_object;
        }
        draw.bounds = sphere_bounds(draw.sphere, object_to_pixel(object, pinhole, time), viewport);
        if (!draw.bounds.empty()) result.push_back(draw);
    }
    return result;
}

} // namespace duet::raster
