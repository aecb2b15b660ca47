#include "common/geometry/surface_point.h"

#include "common/geometry/point_on_shape.h"
#include "common/geometry/sphere.h"
#include "common/vec/robust.h"

#include <cmath>

namespace duet {

namespace {

// Holds the fields that only textures need (SurfaceDetail::kAll).
struct Parameterization {
    Vec2 uv;
    Vec3d dpdu, dpdv; // in object space
};

Parameterization on_sphere(const Sphere& sphere, Vec3d n) {
    Parameterization at{sphere_uv(Vec3(n)), {}, {}};
    const double ring_radius = std::hypot(n.x, n.z), r = static_cast<double>(sphere.radius);
    if (ring_radius > 0) { // at the poles, the direction of u is undefined
        at.dpdu = Vec3d(n.z, 0, -n.x) * (2 * kPiDouble * r);
        at.dpdv = Vec3d(-n.y * n.x / ring_radius, ring_radius, -n.y * n.z / ring_radius) * (kPiDouble * r);
    }
    return at;
}

Parameterization on_triangle(const Mesh& mesh, const std::array<std::uint32_t, 3>& index, Vec3d ab, Vec3d ac, double u,
                             double v) {
    if (mesh.uvs.empty()) return {{static_cast<float>(u), static_cast<float>(v)}, ab, ac};
    const Vec2d ta(mesh.uvs[index[0]]), tb(mesh.uvs[index[1]]), tc(mesh.uvs[index[2]]);
    Parameterization at{Vec2(ta * (1 - u - v) + tb * u + tc * v), {}, {}};
    const Vec2d tab = tb - ta, tac = tc - ta;
    const double det = difference_of_products(tab.x, tac.y, tab.y, tac.x);
    if (det != 0) {
        at.dpdu = (ab * tac.y - ac * tab.y) / det;
        at.dpdv = (ac * tab.x - ab * tac.x) / det;
    }
    return at;
}

// Returns |M| |v|, a bound on the magnitude of the terms of M v. w is 1 for a point, which includes the translation,
// and 0 for a vector.
Vec3d absolute_transform(const Mat4& m, Vec3d v, double w) {
    const auto row = [&](std::size_t r) {
        const auto entry = [&](std::size_t c) { return std::abs(static_cast<double>(m[r][c])); };
        return entry(0) * v.x + entry(1) * v.y + entry(2) * v.z + entry(3) * w;
    };
    return {row(0), row(1), row(2)};
}

} // namespace

SurfacePoint surface_point(const Shape& shape, const Hit& hit, const Ray& ray, const Mat4& to_world,
                           const Mat4& to_object, bool identity, SurfaceDetail detail) {
    const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
    PointOnShapeT<double> local;
    Parameterization at;
    if (const auto* mesh = std::get_if<Mesh>(&shape)) {
        const auto& index = mesh->triangles[hit.primitive];
        const auto of_vertices = [&](const std::vector<Vec3>& values) {
            return std::array{Vec3d(values[index[0]]), Vec3d(values[index[1]]), Vec3d(values[index[2]])};
        };
        const std::array<Vec3d, 3> vertices = of_vertices(mesh->positions);
        const Vec3d ab = vertices[1] - vertices[0], ac = vertices[2] - vertices[0];
        if (mesh->normals.empty()) {
            local = point_on_flat(vertices[0], ab, ac, u, v, false);
        } else {
            const Vec3d direction(ray.direction);
            local = point_on_smooth_triangle(vertices, of_vertices(mesh->normals), u, v,
                                             identity ? direction : transform_vector(Mat4d(to_object), direction));
        }
        if (detail == SurfaceDetail::kAll) at = on_triangle(*mesh, index, ab, ac, u, v);
    } else if (const auto* list = std::get_if<QuadList>(&shape)) {
        const Quad& quad = list->quads[hit.primitive];
        at = {{hit.u, hit.v}, Vec3d(quad.u), Vec3d(quad.v)};
        local = point_on_flat(Vec3d(quad.corner), at.dpdu, at.dpdv, u, v, true);
    } else {
        const auto& sphere = std::get<Sphere>(shape);
        Rayd exact{Vec3d(ray.origin), Vec3d(ray.direction)};
        if (!identity) {
            const Mat4d m(to_world), inverse(to_object);
            exact = {transform_point_inverse(m, inverse, exact.origin), transform_vector(inverse, exact.direction)};
        }
        local = point_on_sphere(Vec3d(sphere.center), static_cast<double>(sphere.radius), exact.origin, exact.direction,
                                static_cast<double>(hit.t));
        if (detail == SurfaceDetail::kAll) at = on_sphere(sphere, local.ng);
    }

    SurfacePoint point;
    point.primitive = hit.primitive;
    point.time = ray.time;
    point.uv = at.uv;
    point.p_object = Vec3(local.p);
    SurfaceGeometryT<float>& geometry = point;
    if (identity) {
        geometry = surface_geometry(local);
        point.dpdu = Vec3(at.dpdu);
        point.dpdv = Vec3(at.dpdv);
        return point;
    }
    const Mat4d m(to_world), inverse(to_object);
    const Vec3d p = transform_point(m, local.p);
    point.p = Vec3(p);
    // A ray from p is transformed to object space in float. Its origin there has an error of γ₄ |M⁻¹| |p − M 0|, which
    // is an error of |M| times that in world space. γ₅ instead of γ₄ covers the rounding of the stored inverse.
    const Vec3d from_origin = abs(p - transform_point(m, Vec3d()));
    const Vec3d in_object = local.magnitude * kPointRounding +
                            absolute_transform(to_object, from_origin, 0) * static_cast<double>(gamma_bound(5));
    point.p_error = Vec3(abs(p) * kPointRounding + absolute_transform(to_world, in_object, 0) +
                         absolute_transform(to_world, abs(local.p), 1) * static_cast<double>(gamma_bound(2)));
    point.ng = Vec3(normalize(transform_normal(inverse, local.ng)));
    point.ns = point.terminator_normal = point.ng;
    if (local.smooth)
        set_shading_normal(geometry, Vec3(normalize(transform_normal(inverse, local.ns))),
                           Vec3(transform_vector(m, local.terminator_offset)));
    point.dpdu = Vec3(transform_vector(m, at.dpdu));
    point.dpdv = Vec3(transform_vector(m, at.dpdv));
    return point;
}

} // namespace duet
