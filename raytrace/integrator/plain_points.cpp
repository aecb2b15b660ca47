#include "raytrace/integrator/plain_points.h"

#include "common/geometry/smooth_lift.h"

#include <cstddef>

namespace duet::raytrace::lanes {

#if XSIMD_WITH_AVX

namespace {

// `fours` reads consecutive numbers across these members.
static_assert(offsetof(Ray, direction) == offsetof(Ray, origin) + 3 * sizeof(float) &&
              offsetof(Ray, t_min) == offsetof(Ray, direction) + 3 * sizeof(float));
static_assert(offsetof(Sphere, radius) == offsetof(Sphere, center) + 3 * sizeof(float));

// The error of p is bounded by the magnitude of the terms that it was computed from, as in surface_point.
FlatPoints points(const Vecd& p, const Vecd& magnitude, const Vecd& n) {
    constexpr double kRounding = 2 * static_cast<double>(kRoundoff<float>);
    return {rounded(p), rounded(magnitude * Doubles(kRounding)), rounded(n)};
}

// Performs the last steps of surface_point: the choice of the shading normal, and the shading-terminator fix
// (`lift`).
SmoothPoints bent(const FlatPoints& flat, Vec ns, Vec lift) {
    const Floats zero(0.0f), infinite(kInfinity);
    const Mask finite = (abs(ns.x) < infinite) & (abs(ns.y) < infinite) & (abs(ns.z) < infinite); // false for NaN
    ns = select(finite, ns, flat.ng);
    ns = select(dot(ns, flat.ng) < zero, -ns, ns);
    const Mask bulges = abs(dot(lift, flat.ng)) > dot(abs(flat.ng), flat.p_error);
    return {
        flat.p, flat.p_error, flat.ng, ns, select(bulges, ns, flat.ng), select(bulges, lift, Vec(zero, zero, zero))};
}

} // namespace

Vec SmoothPoints::origin(const Vec& w) const {
    const Floats zero(0.0f), seen = dot(lift, ng);
    const Mask lifted = dot(w, above) * seen > zero; // `seen` is 0 if there is no lift
    const Mask below = select(lifted, seen, dot(w, ng)) < zero;
    return offset_origin(select(lifted, p + lift, p), p_error, select(below, -ng, ng));
}

FlatPoints flat_points(std::span<const PlainPath> paths) {
    Columns corner, base, a, b; // edges are a − base and b − base
    Column u, v, quad;
    for_lanes(paths, [&](std::size_t i, const PlainPath& path) {
        const Hit& hit = *path.hit;
        u.of[i] = hit.u, v.of[i] = hit.v;
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
            quad.of[i] = 1;
        }
    });
    const Vecd p0 = corner.doubles(), da = a.doubles() - base.doubles(), db = b.doubles() - base.doubles();
    const Vecd p = p0 + da * u.doubles() + db * v.doubles();
    const Vecd magnitude = select(quad.doubles() > Doubles(0.0), abs(p0) + abs(da) + abs(db), abs(p));
    return points(p, magnitude, normalize(cross(da, db)));
}

FlatPoints round_points(std::span<const PlainPath> paths) {
    const auto sphere = [](const PlainPath& path) -> const Sphere& { return std::get<Sphere>(*path.shape); };
    const auto [ox, oy, oz, dx] =
        fours(paths, [](const PlainPath& path) -> const float& { return path.ray->origin.x; });
    const auto [wx, wy, wz, t_min] =
        fours(paths, [](const PlainPath& path) -> const float& { return path.ray->direction.x; });
    const auto [cx, cy, cz, radius] =
        fours(paths, [&](const PlainPath& path) -> const float& { return sphere(path).center.x; });
    Column t;
    for_lanes(paths, [&](std::size_t i, const PlainPath& path) { t.of[i] = path.hit->t; });
    const Vecd center = widened(Vec(cx, cy, cz));
    const Vecd at = widened(Vec(ox, oy, oz)) + widened(Vec(wx, wy, wz)) * t.doubles();
    const Vecd n = normalize(at - center), p = center + n * to_doubles(radius);
    return points(p, abs(p), n);
}

SmoothPoints smooth_points(std::span<const PlainPath> paths) {
    Columns direction;
    std::array<Columns, 3> corners, normals;
    Column u_lanes, v_lanes;
    for_lanes(paths, [&](std::size_t i, const PlainPath& path) {
        const Hit& hit = *path.hit;
        const Mesh& mesh = std::get<Mesh>(*path.shape);
        const auto& index = mesh.triangles[hit.primitive];
        direction.set(i, path.ray->direction);
        u_lanes.of[i] = hit.u, v_lanes.of[i] = hit.v;
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k].set(i, mesh.positions[index[k]]);
            normals[k].set(i, mesh.normals[index[k]]);
        }
    });
    const Doubles u = u_lanes.doubles(), v = v_lanes.doubles(), w = Doubles(1.0) - u - v;
    const Vecd a = corners[0].doubles(), b = corners[1].doubles(), c = corners[2].doubles();
    const Vecd na = normals[0].doubles(), nb = normals[1].doubles(), nc = normals[2].doubles();
    const Vecd ab = b - a, ac = c - a, p = a + ab * u + ac * v, across = cross(ab, ac);
    const Vecd lift = lift_to_smooth<Doubles>(p, {a, b, c}, {na, nb, nc}, {w, u, v}, across, direction.doubles());
    const FlatPoints flat = points(p, abs(p), normalize(across));
    return bent(flat, rounded(normalize(na * w + nb * u + nc * v)), rounded(lift));
}

#endif

} // namespace duet::raytrace::lanes
