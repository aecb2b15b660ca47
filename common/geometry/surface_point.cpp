#include "common/geometry/surface_point.h"

#include "common/geometry/smooth_lift.h"
#include "common/geometry/sphere.h"
#include "common/vec/robust.h"

#include <cmath>

namespace duet {

namespace {

// Holds a point of a shape in object space. Positions are computed in double from the float vertices, so their only
// error is the final rounding to float.
struct LocalPoint {
    Vec3d p;
    Vec3d magnitude;   // sum of the magnitudes of p's terms, per axis; the error of p is a multiple of it
    Vec3d ng, ns;      // any length; an ns of (0, 0, 0) stands for ng
    bool unit = false; // whether ng and ns have unit length
    Vec3d lift;        // vector to the smooth surface on the viewer's side (see lift_to_smooth)
    Vec2 uv;
    Vec3d dpdu, dpdv;
};

LocalPoint on_sphere(const Sphere& sphere, const Rayd& ray, double t, SurfaceDetail detail) {
    const Vec3d center(sphere.center);
    const Vec3d n = normalize(ray.at(t) - center); // projecting onto the sphere removes the error of t along n
    LocalPoint local;
    local.p = center + n * static_cast<double>(sphere.radius);
    local.magnitude = abs(local.p);
    local.ng = local.ns = n;
    local.unit = true;
    if (detail == SurfaceDetail::kWithoutUv) return local;
    local.uv = sphere_uv(Vec3(n));
    const double ring = std::hypot(n.x, n.z), r = static_cast<double>(sphere.radius);
    if (ring > 0) { // at the poles, the direction of u is undefined
        local.dpdu = Vec3d(n.z, 0, -n.x) * (2 * kPiDouble * r);
        local.dpdv = Vec3d(-n.y * n.x / ring, ring, -n.y * n.z / ring) * (kPiDouble * r);
    }
    return local;
}

LocalPoint on_quad(const Quad& quad, double u, double v) {
    const Vec3d corner(quad.corner), du(quad.u), dv(quad.v);
    LocalPoint local;
    local.p = corner + du * u + dv * v;
    local.magnitude = abs(corner) + abs(du) + abs(dv); // the other corners are rounded sums of these
    local.ng = local.ns = cross(du, dv);
    local.uv = {static_cast<float>(u), static_cast<float>(v)};
    local.dpdu = du;
    local.dpdv = dv;
    return local;
}

LocalPoint on_triangle(const Mesh& mesh, std::uint32_t primitive, double u, double v, Vec3d direction,
                       SurfaceDetail detail) {
    const auto& index = mesh.triangles[primitive];
    const double w = 1 - u - v;
    const Vec3d a(mesh.positions[index[0]]), b(mesh.positions[index[1]]), c(mesh.positions[index[2]]);
    const Vec3d ab = b - a, ac = c - a;
    LocalPoint local;
    local.p = a + ab * u + ac * v;
    local.magnitude = abs(local.p);
    local.ng = local.ns = cross(ab, ac);
    if (!mesh.normals.empty()) {
        const Vec3d na(mesh.normals[index[0]]), nb(mesh.normals[index[1]]), nc(mesh.normals[index[2]]);
        local.ns = na * w + nb * u + nc * v;
        local.lift = lift_to_smooth(local.p, {a, b, c}, {na, nb, nc}, {w, u, v}, local.ng, direction);
    }
    if (detail == SurfaceDetail::kWithoutUv) return local;
    if (mesh.uvs.empty()) {
        local.uv = {static_cast<float>(u), static_cast<float>(v)};
        local.dpdu = ab;
        local.dpdv = ac;
        return local;
    }
    const Vec2d ta(mesh.uvs[index[0]]), tb(mesh.uvs[index[1]]), tc(mesh.uvs[index[2]]);
    local.uv = Vec2(ta * w + tb * u + tc * v);
    const Vec2d tab = tb - ta, tac = tc - ta;
    const double det = difference_of_products(tab.x, tac.y, tab.y, tac.x);
    if (det != 0) {
        local.dpdu = (ab * tac.y - ac * tab.y) / det;
        local.dpdv = (ac * tab.x - ab * tac.x) / det;
    }
    return local;
}

Vec3 unit(Vec3d v) { return Vec3(normalize(v)); }

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

Vec3 offset_origin(const SurfacePoint& point, Vec3 w) {
    Vec3 start = point.p;
    bool below = dot(w, point.ng) < 0;
    if (point.lift != Vec3()) {
        const float seen = dot(point.lift, point.ng);
        if (dot(w, point.horizon) * seen > 0) {
            start += point.lift;
            below = seen < 0;
        }
    }
    return offset_origin(start, point.p_error, select(below, -point.ng, point.ng));
}

SurfacePoint surface_point(const Shape& shape, const Hit& hit, const Ray& ray, const Mat4& to_world,
                           const Mat4& to_object, bool identity, SurfaceDetail detail) {
    const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
    LocalPoint local;
    if (const auto* mesh = std::get_if<Mesh>(&shape)) {
        const Vec3d direction(ray.direction);
        local = on_triangle(*mesh, hit.primitive, u, v,
                            identity || mesh->normals.empty() ? direction
                                                              : transform_vector(Mat4d(to_object), direction),
                            detail);
    } else if (const auto* list = std::get_if<QuadList>(&shape)) {
        local = on_quad(list->quads[hit.primitive], u, v);
    } else {
        Rayd exact{Vec3d(ray.origin), Vec3d(ray.direction)};
        if (!identity) {
            const Mat4d m(to_world), inverse(to_object);
            exact = {transform_point_back(m, inverse, exact.origin), transform_vector(inverse, exact.direction)};
        }
        local = on_sphere(std::get<Sphere>(shape), exact, static_cast<double>(hit.t), detail);
    }

    SurfacePoint point;
    point.primitive = hit.primitive;
    point.time = ray.time;
    point.uv = local.uv;
    point.p_object = Vec3(local.p);
    constexpr double kRounding = 2 * static_cast<double>(kRoundoff<float>); // twice the bound of one rounding
    if (identity) {
        point.p = point.p_object;
        point.p_error = Vec3(local.magnitude * kRounding);
        point.ng = local.unit ? Vec3(local.ng) : unit(local.ng);
        point.ns = local.ns == local.ng ? point.ng : unit(local.ns);
        point.dpdu = Vec3(local.dpdu);
        point.dpdv = Vec3(local.dpdv);
        point.lift = Vec3(local.lift);
    } else {
        const Mat4d m(to_world), inverse(to_object);
        const Vec3d p = transform_point(m, local.p);
        point.p = Vec3(p);
        // A ray that starts here is transformed to object space in float. Its origin there has an error of γ₄
        // |M⁻¹| |p − M 0|, which is an error of |M| times that in world space. γ₅ instead of γ₄ covers the
        // rounding of the stored inverse.
        const Vec3d from_place = abs(p - transform_point(m, Vec3d()));
        const Vec3d in_object = local.magnitude * kRounding +
                                absolute_transform(to_object, from_place, 0) * static_cast<double>(gamma_bound(5));
        point.p_error = Vec3(abs(p) * kRounding + absolute_transform(to_world, in_object, 0) +
                             absolute_transform(to_world, abs(local.p), 1) * static_cast<double>(gamma_bound(2)));
        point.ng = unit(transform_normal(inverse, local.ng));
        point.ns = unit(transform_normal(inverse, local.ns));
        point.dpdu = Vec3(transform_vector(m, local.dpdu));
        point.dpdv = Vec3(transform_vector(m, local.dpdv));
        point.lift = Vec3(transform_vector(m, local.lift));
    }
    if (!is_finite(point.ns)) point.ns = point.ng;
    if (dot(point.ns, point.ng) < 0) point.ns = -point.ns;
    point.horizon = point.ng;
    if (point.lift != Vec3()) { // a lift within the error of p is ignored
        const bool bulges = abs(dot(point.lift, point.ng)) > dot(abs(point.ng), point.p_error);
        if (bulges)
            point.horizon = point.ns;
        else
            point.lift = Vec3();
    }
    return point;
}

} // namespace duet
