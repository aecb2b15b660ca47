// Computes the surface points of the paths of a batch.
#pragma once

#include "common/geometry/point_on_shape.h"
#include "raytrace/wavefront/lanes.h"

#include <cstddef>

namespace duet::raytrace::lanes {

// `load_four` reads consecutive floats across these members.
static_assert(offsetof(Ray, direction) == offsetof(Ray, origin) + 3 * sizeof(float) &&
              offsetof(Ray, t_min) == offsetof(Ray, direction) + 3 * sizeof(float));
static_assert(offsetof(Sphere, radius) == offsetof(Sphere, center) + 3 * sizeof(float));

/// Returns the surface points of hits on flat shapes. A batch may mix triangles and quads.
inline SurfaceGeometryT<Floats> flat_points(std::span<const BatchPath> paths) {
    LaneVectors corner, base, a, b; // edges are a − base and b − base
    LaneValues u, v, quad;
    for_lanes(paths, [&](std::size_t i, const BatchPath& path) {
        const Hit& hit = *path.hit;
        u.values[i] = hit.u, v.values[i] = hit.v;
        if (const auto* mesh = std::get_if<Mesh>(path.shape)) {
            const auto& [ia, ib, ic] = mesh->triangles[hit.primitive];
            corner.set(i, mesh->positions[ia]);
            base.set(i, mesh->positions[ia]);
            a.set(i, mesh->positions[ib]);
            b.set(i, mesh->positions[ic]);
        } else {
            const Quad& q = std::get<QuadList>(*path.shape).quads[hit.primitive];
            corner.set(i, q.corner);
            a.set(i, q.u);
            b.set(i, q.v);
            quad.values[i] = 1;
        }
    });
    const Vecd from = base.doubles();
    return surface_geometry(point_on_flat(corner.doubles(), a.doubles() - from, b.doubles() - from, u.doubles(),
                                          v.doubles(), quad.doubles() > Doubles(0.0)));
}

/// Returns the surface points of hits on spheres.
inline SurfaceGeometryT<Floats> round_points(std::span<const BatchPath> paths) {
    const auto sphere = [](const BatchPath& path) -> const Sphere& { return std::get<Sphere>(*path.shape); };
    const auto [ox, oy, oz, dx] =
        load_four(paths, [](const BatchPath& path) -> const float& { return path.ray->origin.x; });
    const auto [wx, wy, wz, t_min] =
        load_four(paths, [](const BatchPath& path) -> const float& { return path.ray->direction.x; });
    const auto [cx, cy, cz, radius] =
        load_four(paths, [&](const BatchPath& path) -> const float& { return sphere(path).center.x; });
    LaneValues t;
    for_lanes(paths, [&](std::size_t i, const BatchPath& path) { t.values[i] = path.hit->t; });
    return surface_geometry(point_on_sphere(to_doubles(Vec(cx, cy, cz)), to_doubles(radius),
                                            to_doubles(Vec(ox, oy, oz)), to_doubles(Vec(wx, wy, wz)), t.doubles()));
}

/// Returns the surface points of hits on meshes with vertex normals.
inline SurfaceGeometryT<Floats> smooth_points(std::span<const BatchPath> paths) {
    LaneVectors direction;
    std::array<LaneVectors, 3> corners, normals;
    LaneValues u, v;
    for_lanes(paths, [&](std::size_t i, const BatchPath& path) {
        const Hit& hit = *path.hit;
        const Mesh& mesh = std::get<Mesh>(*path.shape);
        const auto& index = mesh.triangles[hit.primitive];
        direction.set(i, path.ray->direction);
        u.values[i] = hit.u, v.values[i] = hit.v;
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k].set(i, mesh.positions[index[k]]);
            normals[k].set(i, mesh.normals[index[k]]);
        }
    });
    const auto doubles = [](const std::array<LaneVectors, 3>& of) {
        return std::array{of[0].doubles(), of[1].doubles(), of[2].doubles()};
    };
    return surface_geometry(point_on_smooth_triangle(doubles(corners), doubles(normals), u.doubles(), v.doubles(),
                                                     direction.doubles()));
}

/// Returns the surface points of the paths at surfaces of this form, one path per lane.
inline SurfaceGeometryT<Floats> surface_points(std::span<const BatchPath> paths, BatchedSurfaces::Geometry form) {
    switch (form) {
    case BatchedSurfaces::Geometry::kFlat:
        return flat_points(paths);
    case BatchedSurfaces::Geometry::kSmooth:
        return smooth_points(paths);
    default: return round_points(paths);
    }
}

} // namespace duet::raytrace::lanes
