#include "raster/probes/glass_shapes.h"

#include "raster/prepare_limits.h"
#include "raster/probes/probe_capture.h"
#include "raster/probes/solid_test.h"

#include "common/scene/bake.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

using Vec3s = Vec3T<Floats>;

constexpr int kSteps = 4; ///< iterations from sphere to sphere, as in ReflectionProbes::trace

OctahedralMap shape_of(const RasterSceneData& data, const RasterSettings& settings, std::uint32_t object,
                       Vec3d center) {
    const int side = PrepareLimits(data.scene).radiance_map_side(GlassShapes::kSide);
    const ProbeCapture capture(data, settings, center, object, side / 2);
    const float missing = length(data.objects[object].bounds.diagonal()) / 2;
    OctahedralMap map(side);
    for (int y = 0; y < map.side(); ++y)
        for (int x = 0; x < map.side(); ++x) {
            const Vec3 w = map.direction(x, y);
            const ProbeCapture::Pixel pixel = capture.pixel(w);
            const float distance = capture.distance(pixel);
            // The surface is seen from within, so its normals face the center.
            const Vec3 n = distance < kInfinity
                               ? -capture.faces()[pixel.face].gbuffer.normal.vector_at(pixel.x, pixel.y) : w;
            map.texel(x, y) = {n.x, n.y, n.z, min(distance, missing)};
        }
    map.finish();
    return map;
}

bool is_sphere(const Scene& scene, std::uint32_t index) {
    const Object& object = scene.objects[index];
    const auto* sphere = std::get_if<Sphere>(&scene.shapes[object.shape]);
    return sphere != nullptr && !object.moving && transformed(*sphere, object.to_world);
}

/// Returns the radius, in meters, of the sphere that replaces an object at each point where a ray enters. For an
/// ellipsoid or a moving sphere it is the sphere of equal volume. For a mesh it has the radius of a tube with the
/// mesh's volume and surface, 2·volume/area.
float local_radius(const RasterSceneData& data, std::uint32_t index) {
    const Object& object = data.scene.objects[index];
    const Shape& shape = data.scene.shapes[object.shape];
    const Mat4d to_world(object.to_world);
    if (const auto* sphere = std::get_if<Sphere>(&shape))
        return sphere->radius * static_cast<float>(std::cbrt(abs(determinant3(to_world))));
    const Vec3d center(data.objects[index].bounds.center());
    double volume = 0, area = 0; // six times the volume, twice the area
    for (std::uint32_t i = 0; i < primitive_count(shape); ++i) {
        const PrimitiveVertices vertices = primitive_vertices(shape, i);
        const auto at = [&](int k) {
            return transform_point(to_world, Vec3d(vertices.p[static_cast<std::size_t>(k)])) - center;
        };
        for (int k = 2; k < vertices.count; ++k) {
            const Vec3d a = at(0), b = at(k - 1), c = at(k);
            volume += dot(a, cross(b, c));
            area += length(cross(b - a, c - a));
        }
    }
    return area > 0 ? static_cast<float>(2 * abs(volume) / 6 / (area / 2)) : 0.0f;
}

} // namespace

GlassShapes::GlassShapes(const RasterSceneData& data, const RasterSettings& settings) {
    std::vector<std::uint32_t> objects = data.glass;
    std::erase_if(objects, [&](std::uint32_t i) { return !data.objects[i].closed; });
    const auto mapped = std::stable_partition(objects.begin(), objects.end(),
                                              [&](std::uint32_t i) { return is_sphere(data.scene, i); });
    const auto spheres = static_cast<std::size_t>(mapped - objects.begin());
    const auto size = [&](std::uint32_t i) { return length(data.objects[i].bounds.diagonal()); };
    std::stable_sort(mapped, objects.end(), [&](std::uint32_t a, std::uint32_t b) { return size(a) > size(b); });
    if (objects.size() > spheres + kMost) objects.resize(spheres + kMost);
    shapes_.resize(objects.size());
    of_object_.assign(data.scene.objects.size(), shapes_.size());
    parallel_for(objects.size(), settings.threads, [&](std::size_t i) {
        const Box3& bounds = data.objects[objects[i]].bounds;
        Shape& shape = shapes_[i];
        shape.center = Vec3d(bounds.center());
        if (i < spheres) return;
        if (is_inside(data, objects[i], shape.center))
            shape.map = shape_of(data, settings, objects[i], shape.center);
        else
            shape.local_radius = local_radius(data, objects[i]);
    });
    for (std::size_t i = 0; i < objects.size(); ++i) of_object_[objects[i]] = i;
}

std::optional<GlassShapes::Exit> GlassShapes::exit(std::int32_t object, const Vec3d& eye, const Vec3s& p,
                                                   const Vec3s& n, const Vec3s& w) const {
    const std::size_t index = of_object_[static_cast<std::size_t>(object)];
    if (index == shapes_.size()) return std::nullopt;
    const Shape& shape = shapes_[index];
    const Vec3 offset(eye - shape.center);
    const Vec3s start = shape.local_radius ? n * Floats(*shape.local_radius) : p + broadcast<Floats>(offset);
    const Floats none(0.0f), across = dot(start, w);
    Floats t = max(-across, none) * Floats(2.0f); // exit from a sphere about the center
    for (int i = 0; shape.map && i < kSteps; ++i) {
        const Floats radius = shape.map->at<4>(start + w * t)[3];
        t = max(xsimd::sqrt(max(radius * radius - dot(start, start) + across * across, none)) - across, none);
    }
    Vec3s outward = start + w * t; // normal of a sphere
    if (shape.map) {
        const auto [x, y, z, distance] = shape.map->at<4>(outward);
        outward = {x, y, z};
    }
    return Exit{p + w * t, outward * inverse_sqrt(max(dot(outward, outward), Floats(1e-20f))), t};
}

std::size_t GlassShapes::memory_bytes() const {
    std::size_t sum = 0;
    for (const Shape& shape : shapes_)
        if (shape.map) sum += shape.map->memory_bytes();
    return sum;
}

} // namespace duet::raster
