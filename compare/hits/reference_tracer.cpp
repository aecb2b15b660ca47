#include "compare/hits/reference_tracer.h"

#include "common/scene/alpha_mask.h"

#include <cmath>
#include <optional>

namespace duet::compare {

namespace {

/// Maps points to a space in which the ray is the line x = y = 0. The map shears along the ray's largest axis
/// and keeps the plane across it.
struct RayShear {
    Vec3d origin;
    std::size_t kx, ky, kz;
    double sx, sy;

    explicit RayShear(const Rayd& ray) : origin(ray.origin), kz(longest_axis(abs(ray.direction))) {
        kx = (kz + 1) % 3;
        ky = (kz + 2) % 3;
        sx = ray.direction[kx] / ray.direction[kz];
        sy = ray.direction[ky] / ray.direction[kz];
    }
    Vec2d operator()(Vec3d p) const {
        const Vec3d o = p - origin;
        return {o[kx] - sx * o[kz], o[ky] - sy * o[kz]};
    }
};

/// Returns a value whose sign says on which side of edge ab the ray passes. The sign is exact or the result is
/// 0, because rounding preserves the order of the two products.
double side(Vec2d a, Vec2d b) { return a.x * b.y - a.y * b.x; }

/// Returns the ray's t on triangle abc, edges and vertices included. The test is watertight: no ray slips
/// between two triangles that share vertices (Woop, Benthin and Wald 2013, §3, in double precision).
std::optional<double> intersect(const Rayd& ray, Vec3d a, Vec3d b, Vec3d c) {
    const RayShear shear(ray);
    const Vec2d pa = shear(a), pb = shear(b), pc = shear(c);
    const double sa = side(pb, pc), sb = side(pc, pa), sc = side(pa, pb);
    if (!((sa >= 0 && sb >= 0 && sc >= 0) || (sa <= 0 && sb <= 0 && sc <= 0))) return {};
    const Vec3d n = cross(b - a, c - a);
    const double slope = dot(n, ray.direction);
    if (slope == 0) return {}; // edge-on, or no area
    const double t = dot(n, a - ray.origin) / slope;
    if (!(t > ray.t_min && t <= ray.t_max)) return {};
    return t;
}

/// Intersects a ray and a sphere as common/geometry/sphere.h does, in double precision. The discriminant is computed
/// from the distance of the center to the line, and the roots without subtracting nearly equal numbers.
std::optional<double> intersect(const Rayd& ray, const Sphere& sphere) {
    const Vec3d f = ray.origin - Vec3d(sphere.center);
    const double radius = sphere.radius, a = length_squared(ray.direction), b = -dot(f, ray.direction);
    const double discriminant = sqr(radius) - length_squared(f + ray.direction * (b / a));
    if (discriminant < 0) return {};
    const double distance = length(f), c = (distance - radius) * (distance + radius);
    const double q = b + std::copysign(std::sqrt(a * discriminant), b);
    const double t0 = c / q,
                 t1 = q / a; // q = 0 only if the ray starts on the sphere and is tangent to it: t0 is NaN, t1 is 0
    const double low = min(t0, t1), high = max(t0, t1);
    if (low > ray.t_min && low <= ray.t_max) return low;
    if (high > ray.t_min && high <= ray.t_max) return high;
    return {};
}

std::optional<double> intersect(const Rayd& ray, const Shape& shape, std::uint32_t primitive) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return intersect(ray, *sphere);
    const PrimitiveVertices corners = primitive_vertices(shape, primitive);
    const Vec3d a(corners.p[0]), b(corners.p[1]), c(corners.p[2]);
    const std::optional<double> t = intersect(ray, a, b, c);
    return t || corners.count == 3 ? t : intersect(ray, a, c, Vec3d(corners.p[3]));
}

Box3d primitive_box(const Shape& shape, std::uint32_t primitive) {
    Box3d box;
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        // The box is slightly larger than the sphere, so that rounding does not cut off its poles.
        const double r = sphere->radius * (1 + 1e-12);
        box.extend(Vec3d(sphere->center) - Vec3d(r, r, r));
        box.extend(Vec3d(sphere->center) + Vec3d(r, r, r));
        return box;
    }
    const PrimitiveVertices corners = primitive_vertices(shape, primitive);
    for (int i = 0; i < corners.count; ++i) box.extend(Vec3d(corners.p[static_cast<std::size_t>(i)]));
    return box;
}

std::vector<Box3d> primitive_boxes(const Shape& shape) {
    std::vector<Box3d> boxes(primitive_count(shape));
    for (std::uint32_t i = 0; i < boxes.size(); ++i) boxes[i] = primitive_box(shape, i);
    return boxes;
}

/// Returns the bounding box of a transformed box, enlarged by far more than the transform's rounding error.
Box3d transformed(const Box3d& box, const Mat4d& map) {
    Box3d result;
    for (unsigned corner = 0; corner < 8; ++corner) result.extend(transform_point(map, box.corner(corner)));
    const double size = max_component(max(abs(result.low), abs(result.high))) * 1e-12;
    result.low = result.low - Vec3d(size, size, size);
    result.high = result.high + Vec3d(size, size, size);
    return result;
}

std::vector<ReferenceBvh> build_trees(const Scene& scene, std::vector<Box3d>& shape_boxes) {
    std::vector<ReferenceBvh> trees;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const Shape& shape = scene.shapes[i];
        const std::vector<Box3d> boxes = primitive_boxes(shape);
        Box3d all;
        for (const Box3d& box : boxes) all.extend(box);
        shape_boxes.push_back(all);
        trees.emplace_back(boxes);
    }
    return trees;
}

bool is_closer(const ReferenceHit& a, const ReferenceHit& b) {
    if (a.t != b.t) return a.t < b.t;
    return a.object != b.object ? a.object < b.object : a.primitive < b.primitive;
}

} // namespace

ReferenceTracer::ReferenceTracer(const Scene& scene, double time)
    : scene_(scene), time_(static_cast<float>(time)), object_tree_({}) {
    std::vector<Box3d> shape_boxes, object_boxes;
    shape_trees_ = build_trees(scene, shape_boxes);
    for (const Object& object : scene.objects) {
        const Mat4d to_world(object_transform(object, static_cast<float>(time)).to_world);
        objects_.push_back({&scene.shapes[object.shape], to_world, inverse_affine(to_world)});
        trees_.push_back(&shape_trees_[object.shape]);
        const Box3d& box = shape_boxes[object.shape];
        object_boxes.push_back(box.empty() ? box : transformed(box, to_world));
    }
    object_tree_ = ReferenceBvh(object_boxes);
}

Rayd ReferenceTracer::to_object_space(const Rayd& ray, const PlacedShape& placed) const {
    Rayd local = ray; // the direction is not normalized, so that t is preserved
    local.origin = transform_point(placed.to_object, ray.origin);
    local.direction = transform_vector(placed.to_object, ray.direction);
    return local;
}

// Here `local` is the ray in the object's space.
bool ReferenceTracer::passes_alpha_test(const Rayd& ray, const Rayd& local, const ReferenceHit& hit) const {
    Hit rounded{hit.object, hit.primitive, 0, 0, static_cast<float>(hit.t)};
    const Shape& shape = *objects_[hit.object].shape;
    if (!std::holds_alternative<Sphere>(shape)) {
        const PrimitiveVertices c = primitive_vertices(shape, hit.primitive);
        const Vec3d a(c.p[0]), u = Vec3d(c.p[1]) - a, v = Vec3d(c.p[c.count == 4 ? 3 : 2]) - a, n = cross(u, v);
        const Vec3d p = local.at(hit.t) - a;
        rounded.u = static_cast<float>(dot(cross(p, v), n) / dot(n, n));
        rounded.v = static_cast<float>(dot(cross(u, p), n) / dot(n, n));
    }
    Ray float_ray{Vec3(ray.origin), Vec3(ray.direction)};
    float_ray.time = time_;
    return passes_alpha_mask(scene_, float_ray, rounded);
}

ReferenceHit ReferenceTracer::nearest(const Rayd& ray) const {
    ReferenceHit best;
    object_tree_.visit(ray, [&](std::uint32_t object, double t_max) {
        const PlacedShape& placed = objects_[object];
        Rayd local = to_object_space(ray, placed);
        local.t_max = t_max;
        trees_[object]->visit(local, [&](std::uint32_t primitive, double local_t_max) {
            local.t_max = local_t_max;
            std::optional<double> t = compare::intersect(local, *placed.shape, primitive);
            if (scene_.needs.alpha && t && passes_alpha_test(ray, local, {object, primitive, *t})) {
                Rayd beyond = local; // a sphere may have a second hit
                beyond.t_min = *t * (1 + 1e-12);
                t = compare::intersect(beyond, *placed.shape, primitive);
                if (t && passes_alpha_test(ray, local, {object, primitive, *t})) t.reset();
            }
            if (!t) return local_t_max;
            const ReferenceHit hit{object, primitive, *t};
            if (is_closer(hit, best)) best = hit;
            return min(local_t_max, best.t);
        });
        return min(t_max, best.t);
    });
    return best;
}

ReferenceHit ReferenceTracer::intersect(const Rayd& ray, std::uint32_t object, std::uint32_t primitive) const {
    const PlacedShape& placed = objects_[object];
    const std::optional<double> t = compare::intersect(to_object_space(ray, placed), *placed.shape, primitive);
    return t ? ReferenceHit{object, primitive, *t} : ReferenceHit{};
}

double ReferenceTracer::cosine(const Rayd& ray, std::uint32_t object, std::uint32_t primitive, double t) const {
    const PlacedShape& placed = objects_[object];
    Vec3d n;
    if (const auto* sphere = std::get_if<Sphere>(placed.shape)) {
        n = to_object_space(ray, placed).at(t) - Vec3d(sphere->center);
    } else {
        const PrimitiveVertices corners = primitive_vertices(*placed.shape, primitive);
        n = cross(Vec3d(corners.p[1]) - Vec3d(corners.p[0]), Vec3d(corners.p[2]) - Vec3d(corners.p[0]));
    }
    n = transform_normal(placed.to_object, n);
    const double size = length(n) * length(ray.direction);
    return size > 0 ? std::abs(dot(n, ray.direction)) / size : 0;
}

double ReferenceTracer::ray_rounding(const Rayd& ray, std::uint32_t object, double t) const {
    const double of_ray =
        length(Vec3d(Vec3(ray.origin)) - ray.origin) + gamma_bound<float>(3) * t * length(ray.direction);
    if (scene_.objects[object].identity && !scene_.objects[object].moving) return of_ray;
    // The bound covers a difference, a product with a matrix of rounded entries, and two sums.
    const double bound = gamma_bound<float>(5);
    const auto absolute = [](const Mat4d& m, Vec3d v) {
        const auto row = [&](std::size_t r) {
            return std::abs(m[r][0]) * v.x + std::abs(m[r][1]) * v.y + std::abs(m[r][2]) * v.z;
        };
        return Vec3d(row(0), row(1), row(2));
    };
    const Mat4d &to_world = objects_[object].to_world, &to_object = objects_[object].to_object;
    const Vec3d from_object = ray.origin - Vec3d(to_world[0][3], to_world[1][3], to_world[2][3]);
    const Vec3d terms = absolute(to_object, abs(from_object) + abs(ray.direction) * t);
    return of_ray + bound * length(absolute(to_world, terms));
}

std::vector<Vec3d> ReferenceTracer::corners(std::uint32_t object, std::uint32_t primitive) const {
    const PlacedShape& placed = objects_[object];
    std::vector<Vec3d> points;
    if (std::holds_alternative<Sphere>(*placed.shape)) return points;
    const PrimitiveVertices corners = primitive_vertices(*placed.shape, primitive);
    for (int i = 0; i < corners.count; ++i)
        points.push_back(transform_point(placed.to_world, Vec3d(corners.p[static_cast<std::size_t>(i)])));
    return points;
}

double plane_distance(const std::vector<Vec3d>& corners, Vec3d point) {
    if (corners.empty()) return std::numeric_limits<double>::infinity();
    const Vec3d n = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double size = length(n);
    return size > 0 ? std::abs(dot(n, corners[0] - point)) / size : std::numeric_limits<double>::infinity();
}

double relative_distance(const ReferenceTracer& tracer, const Rayd& ray, const ReferenceHit& a, const ReferenceHit& b) {
    const double cosine =
        max(tracer.cosine(ray, a.object, a.primitive, a.t), tracer.cosine(ray, b.object, b.primitive, b.t));
    return std::abs(a.t - b.t) * cosine / min(a.t, b.t);
}

} // namespace duet::compare
