// These tests intersect spheres, slivers, triangles without area, duplicates, axis-parallel rays and invalid rays.
#include "common/geometry/sphere.h"
#include "common/geometry/triangle.h"
#include "compare/stress/accelerated_scene.h"
#include "compare/stress/errors.h"
#include "compare/stress/naive.h"
#include "compare/stress/trials.h"

#include <algorithm>
#include <utility>

namespace duet::compare {

namespace {

constexpr double kWrong = std::numeric_limits<double>::infinity(); ///< error of a false or a missing hit

// Spheres ------------------------------------------------------------------------------------------------------------

struct SphereTruth {
    bool hit = false, doubtful = false; ///< doubtful: grazing, or starting on the surface
    long double t = 0;
};

/// Returns the nearest positive root for the given floats of ray and sphere, computed with the 64-bit significand of
/// long double.
SphereTruth sphere_truth(const Ray& ray, const Sphere& sphere) {
    using Wide = long double;
    const auto wide = [](Vec3 v) { return std::array<Wide, 3>{Wide(v.x), Wide(v.y), Wide(v.z)}; };
    const auto product = [](const auto& p, const auto& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; };
    const auto o = wide(ray.origin), d = wide(ray.direction), center = wide(sphere.center);
    const std::array<Wide, 3> f{o[0] - center[0], o[1] - center[1], o[2] - center[2]};
    const Wide r = static_cast<Wide>(sphere.radius), a = product(d, d), b = -product(f, d), s = b / a;
    const std::array<Wide, 3> closest{f[0] + s * d[0], f[1] + s * d[1], f[2] + s * d[2]};
    const Wide gap = r * r - product(closest, closest), height = std::sqrt(product(f, f)) - r;
    SphereTruth truth;
    truth.doubtful = std::abs(gap) < 1e-6L * r * r || std::abs(height) < 3e-8L * r;
    if (!(gap >= 0)) return truth;
    const Wide root = std::sqrt(gap / a), c = height * (height + 2 * r);
    const Wide far = b < 0 ? c / (a * (s - root)) : s + root, near = b < 0 ? s - root : c / (a * (s + root));
    truth.hit = far > 0;
    truth.t = near > 0 ? near : far;
    return truth;
}

void judge_sphere(Trial& trial, const Ray& ray, const Sphere& sphere) {
    const SphereTruth truth = sphere_truth(ray, sphere);
    if (truth.doubtful) return;
    const auto error = [&](std::optional<float> t) {
        if (t.has_value() != truth.hit) return kWrong;
        return t ? ulps(*t, truth.t) : 0.0;
    };
    trial.note("sphere at ", exact(sphere.center), " of radius ", exact(sphere.radius), ", ray from ",
               exact(ray.origin), " along ", exact(ray.direction), truth.hit ? ": a hit" : ": none");
    trial.record(error(intersect_sphere(ray, sphere)));
    trial.record_naive(error(naive::intersect_sphere(ray, sphere)));
}

void far_spheres(Trial& trial) {
    TrialRandom& random = trial.random;
    const float radius = random.log_uniform(1e-3f, 1e3f);
    const Vec3 away = random.direction() * (radius * random.log_uniform(10, 1e6f));
    const Vec3 eye = random.vector() * radius;
    const Sphere sphere{eye + away, radius};
    const Vec3 aim = sphere.center + random.vector() * (0.8f * radius);
    judge_sphere(trial, {eye, normalize(aim - eye)}, sphere);
}

void near_spheres(Trial& trial) {
    TrialRandom& random = trial.random;
    const Sphere sphere{random.vector(), random.log_uniform(1, 1e4f)};
    const float height = random.sign() * random.log_uniform(1e-7f, 0.5f); // above or below the surface, in radii
    const Vec3 eye = sphere.center + random.direction() * (sphere.radius * (1 + height));
    judge_sphere(trial, {eye, random.direction()}, sphere);
}

// Triangles ----------------------------------------------------------------------------------------------------------

/// Returns the error of a float triangle test relative to the plane and the edges in double. The unit is 2^-24 of the
/// largest distance of a corner from the origin. For a hit it is the error of the point along the plane's normal; for
/// a wrong decision it is the ray's distance from the edge.
double triangle_error(const Ray& ray, const std::array<Vec3, 3>& p, std::optional<float> t) {
    const Vec3d o(ray.origin), d(ray.direction), a(p[0]), b(p[1]), c(p[2]), n = cross(b - a, c - a);
    const double slope = dot(n, d), plane = dot(n, a - o) / slope;
    const double reach = std::max({length(a - o), length(b - o), length(c - o)});
    // This is the distance by which the ray passes inside all edges, perpendicular to its direction. It is negative
    // outside.
    double inside = std::numeric_limits<double>::infinity();
    const double side = slope > 0 ? 1 : -1;
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        const Vec3d across = cross(to - from, d);
        inside = std::min(inside, side * dot(across, from - o) / length(across));
    }
    const bool hit = inside >= 0 && plane > 0;
    if (t.has_value() != hit) return in_roundoffs(std::min(std::abs(inside), std::abs(plane)) / reach);
    return t ? in_roundoffs((static_cast<double>(*t) - plane) * slope / (length(n) * length(d)) / reach) : 0.0;
}

void slivers(Trial& trial) {
    TrialRandom& random = trial.random;
    const float scale = random.log_uniform(1e-6f, 1e6f), thickness = random.log_uniform(1e-6f, 1);
    const Vec3 along = random.direction(), place = random.vector() * scale;
    const Vec3 across = normalize(cross(along, random.direction())) * (thickness * scale);
    const std::array<Vec3, 3> p{place, place + along * (scale * random.uniform(0.5f, 1)),
                                place + along * (scale * random.uniform()) + across};
    const float u = random.uniform(), v = random.uniform(0, 1 - u);
    const Vec3 target = p[0] * (1 - u - v) + p[1] * u + p[2] * v;
    const Vec3 origin = target + random.direction() * (scale * random.log_uniform(1e-2f, 1e2f));
    const Ray ray{origin, normalize_scaled(target - origin)};
    const auto found = intersect_triangle(ShearedRay(ray), p[0], p[1], p[2]);
    trial.note("a, b, c = ", exact(p[0]), ", ", exact(p[1]), ", ", exact(p[2]), ", ray from ", exact(origin), " along ",
               exact(ray.direction), ": t = ", found ? exact(found->t) : "none");
    trial.record(triangle_error(ray, p, found ? std::optional(found->t) : std::nullopt));
    trial.record_naive(triangle_error(ray, p, naive::intersect_triangle(ray, p[0], p[1], p[2])));
}

void zero_area(Trial& trial) {
    TrialRandom& random = trial.random;
    // The corners are exactly collinear: they are on a grid on which sums and small multiples are exact.
    const auto grid = [&] { return static_cast<float>(static_cast<int>(random.below(2001)) - 1000); };
    const float scale = std::exp2(static_cast<float>(static_cast<int>(random.below(41)) - 20));
    const Vec3 a = Vec3(grid(), grid(), grid()) * scale, step = Vec3(grid(), grid(), grid()) * scale;
    const auto multiple = [&] { return a + step * static_cast<float>(static_cast<int>(random.below(7)) - 3); };
    const Vec3 b = multiple(), c = multiple();
    const Vec3 origin = random.vector() * (3000 * scale);
    const Ray ray{origin, normalize_scaled(lerp(a, random.coin() ? b : c, random.uniform()) - origin)};
    trial.note("a, b, c = ", exact(a), ", ", exact(b), ", ", exact(c), ", ray from ", exact(origin), " along ",
               exact(ray.direction));
    const auto hit = intersect_triangle(ShearedRay(ray), a, b, c);
    const double thickness = 64 * 6e-8 * 3000 * static_cast<double>(scale);
    // A sheared sliver may have a width of one rounding error. A hit must then at least be on the line itself.
    trial.record_failure_if(hit && !(std::isfinite(hit->t) && length(cross(Vec3d(ray.at(hit->t)) - Vec3d(a),
                                                                           normalize(Vec3d(step)))) < thickness));
}

// Many primitives ----------------------------------------------------------------------------------------------------

/// Returns triangles of which many coincide, in one mesh and in a second object.
std::vector<Shape> duplicated(TrialRandom& random) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < 12; ++i) {
        for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back(random.vector());
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    for (int i = 0; i < 24; ++i) mesh.triangles.push_back(mesh.triangles[random.below(12)]);
    for (std::uint32_t i = static_cast<std::uint32_t>(mesh.triangles.size()); i > 1; --i)
        std::swap(mesh.triangles[i - 1], mesh.triangles[random.below(i)]);
    return {mesh, mesh};
}

/// Sends a random ray, and records a failure if its hit differs from that of testing every primitive. Returns the ray
/// and the latter.
std::pair<Ray, Hit> check_random_ray(Trial& trial, const AcceleratedScene& accelerated) {
    const Ray ray{trial.random.direction() * 3.0f, trial.random.vector()};
    const Hit found = accelerated.accelerator.closest(ray), expected = brute_force_hit(*accelerated.scene, ray);
    trial.record_failure_if(!(found == expected));
    if (!(found == expected))
        trial.note("ray from ", exact(ray.origin), " along ", exact(ray.direction), ": object ", found.object,
                   " primitive ", found.primitive, " at ", exact(found.t), ", expected ", expected.object, " and ",
                   expected.primitive, " at ", exact(expected.t));
    return {ray, expected};
}

void duplicates(Trial& trial) {
    const AcceleratedScene accelerated(make_scene(duplicated(trial.random)));
    const Mesh& mesh = std::get<Mesh>(accelerated.scene->shapes[0]);
    for (int shot = 0; shot < 32; ++shot) {
        const auto [ray, expected] = check_random_ray(trial, accelerated);
        float nearest = kInfinity; // of several hits, the last one tested wins
        std::uint32_t last = 0;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const auto& [a, b, c] = mesh.triangles[i];
            const auto t = naive::intersect_triangle(ray, mesh.positions[a], mesh.positions[b], mesh.positions[c]);
            if (t && *t <= nearest) nearest = *t, last = i;
        }
        if (expected.valid()) trial.record_naive_failure_if(last != expected.primitive);
    }
}

/// Returns axis-aligned quads of many sizes in a few common planes.
std::vector<Shape> coplanar(TrialRandom& random) {
    QuadList list;
    for (int i = 0; i < 40; ++i) {
        const std::uint32_t axis = random.below(3);
        Vec3 corner = random.vector(), u, v;
        corner[axis] = static_cast<float>(random.below(3)) - 1;
        u[(axis + 1) % 3] = random.uniform(0.1f, 2);
        v[(axis + 2) % 3] = random.uniform(0.1f, 2);
        list.quads.push_back({corner, u, v});
    }
    return {list, list.quads.empty() ? list : QuadList{{list.quads[0], list.quads[7]}}};
}

void coplanar_faces(Trial& trial) {
    const AcceleratedScene accelerated(make_scene(coplanar(trial.random)));
    for (int shot = 0; shot < 32; ++shot) check_random_ray(trial, accelerated);
}

// Rays along the axes ------------------------------------------------------------------------------------------------

/// Returns boxes with integer corners.
QuadList whole_boxes(TrialRandom& random) {
    QuadList all;
    for (int i = 0; i < 10; ++i) {
        Vec3 low, high;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = static_cast<float>(random.below(16));
            high[axis] = low[axis] + 1 + static_cast<float>(random.below(4));
        }
        const QuadList box = box_quads(low, high);
        all.quads.insert(all.quads.end(), box.quads.begin(), box.quads.end());
    }
    return all;
}

/// Returns the distance at which the ray from a half-integer point along ± axis hits the first face. The distance is
/// exact, and infinite if the ray hits no face.
float whole_distance(const QuadList& boxes, Vec3 origin, std::size_t axis, float sign) {
    float nearest = kInfinity;
    for (const Quad& quad : boxes.quads) {
        Box3 box;
        for (const Vec3& p : corners(quad)) box.extend(p);
        const std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
        const bool faces = box.low[axis] == box.high[axis] && box.low[x] < origin[x] && origin[x] < box.high[x] &&
                           box.low[y] < origin[y] && origin[y] < box.high[y];
        const float t = (box.low[axis] - origin[axis]) * sign;
        if (faces && t > 0) nearest = min(nearest, t);
    }
    return nearest;
}

void axis_parallel(Trial& trial) {
    TrialRandom& random = trial.random;
    const AcceleratedScene accelerated(make_scene({whole_boxes(random)}));
    const QuadList& boxes = std::get<QuadList>(accelerated.scene->shapes[0]);
    for (int shot = 0; shot < 32; ++shot) {
        const std::size_t axis = random.below(3);
        const float sign = random.sign(), half = random.coin() ? 0.5f : 0.0f;
        Ray ray;
        for (std::size_t i = 0; i < 3; ++i) {
            ray.origin[i] = static_cast<float>(random.below(20)) + half;
            ray.direction[i] = random.coin() ? 0.0f : -0.0f;
        }
        ray.direction[axis] = sign;
        Ray other = ray; // the same ray with zeros of the opposite sign
        other.direction = -ray.direction;
        other.direction[axis] = sign;
        const Hit hit = accelerated.accelerator.closest(ray), same = accelerated.accelerator.closest(other);
        double error = hit == same && hit == brute_force_hit(*accelerated.scene, ray) ? 0 : kWrong;
        if (half > 0) { // the ray passes through no edge, so the exact result is known
            const float expected = whole_distance(boxes, ray.origin, axis, sign);
            if (hit.valid() != std::isfinite(expected)) error = kWrong;
            if (hit.valid()) error = std::max(error, ulps(hit.t, static_cast<long double>(expected)));
            float nearest = kInfinity;
            for (const Quad& quad : boxes.quads) {
                Box3 box;
                for (const Vec3& p : corners(quad)) box.extend(p);
                if (!naive::intersect_box(ray, box)) continue;
                const auto p = corners(quad);
                for (const std::size_t k : {std::size_t{1}, std::size_t{2}})
                    if (const auto t = naive::intersect_triangle(ray, p[0], p[k], p[k + 1])) nearest = min(nearest, *t);
            }
            const bool both = std::isfinite(nearest) && std::isfinite(expected);
            trial.record_naive(both                  ? ulps(nearest, static_cast<long double>(expected))
                               : nearest == expected ? 0
                                                     : kWrong);
        }
        if (error > 8)
            trial.note("ray from ", exact(ray.origin), " along ", exact(ray.direction), ": t = ", exact(hit.t));
        trial.record(error);
    }
}

// Rays that are none -------------------------------------------------------------------------------------------------

AcceleratedScene mixed_scene() {
    std::vector<Shape> shapes{icosphere(2, 0.1f), Sphere{{0.5f, 0, 0}, 0.8f}, box_quads({-2, -2, -2}, {-0.5f, 2, 2})};
    Scene scene = make_scene(std::move(shapes));
    Scene instanced = make_scene(icosphere(1), {Mat4(scaling(Vec3(2, 1, 1))), Mat4(translation(Vec3(0, 3, 0)))});
    for (Object& object : instanced.objects) object.shape = static_cast<std::uint32_t>(scene.shapes.size());
    scene.shapes.push_back(instanced.shapes[0]);
    scene.objects.insert(scene.objects.end(), instanced.objects.begin(), instanced.objects.end());
    finish_scene(scene);
    return AcceleratedScene(std::move(scene));
}

StressResult bad_rays(const StressTest& test, const StressSetting& setting) {
    const AcceleratedScene accelerated = mixed_scene();
    return run_trials(test, setting, [&](Trial& trial) {
        TrialRandom& random = trial.random;
        constexpr std::array<float, 3> kBad{std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity};
        Ray ray{random.direction() * 4.0f, -random.direction()};
        const std::uint32_t kind = random.below(4);
        if (kind == 0) ray.origin[random.below(3)] = kBad[random.below(3)];
        if (kind == 1) ray.direction[random.below(3)] = kBad[random.below(3)];
        if (kind == 2) ray.direction = {0.0f, -0.0f, random.coin() ? 0.0f : -0.0f};
        if (kind == 3) ray.t_max = kBad[0];
        Hit end;
        end.t = 10;
        const Hit hit = accelerated.accelerator.closest(ray);
        trial.note("ray from ", exact(ray.origin), " along ", exact(ray.direction), " to ", exact(ray.t_max),
                   ": object ", hit.object, " at ", exact(hit.t));
        trial.record_failure_if(hit.valid() || (kind < 3 && accelerated.accelerator.occluded(ray, end)));
        const Mesh& mesh = std::get<Mesh>(accelerated.scene->shapes[0]);
        bool naive_hit = naive::intersect_sphere(ray, std::get<Sphere>(accelerated.scene->shapes[1])).has_value();
        for (const auto& [a, b, c] : mesh.triangles)
            naive_hit =
                naive_hit || naive::intersect_triangle(ray, mesh.positions[a], mesh.positions[b], mesh.positions[c]);
        trial.record_naive_failure_if(naive_hit);
    });
}

constexpr StressTest kTests[] = {
    {"intersection/far-spheres", "hits of spheres 10 to 1e6 radii away, grazing ones left out", 0.51, "ulp of t",
     "t is rounded once from double (Haines et al. 2019); judged by long double", "b² - a·c in float", 500'000,
     trials_of<far_spheres>},
    {"intersection/near-spheres", "hits from 1e-7 to 0.5 radii above or below the surface, in all directions", 0.6,
     "ulp of t", "t is rounded once from double (Haines et al. 2019); judged by long double", "b² - a·c in float",
     500'000, trials_of<near_spheres>},
    {"intersection/slivers", "triangles of size 1e-6 to 1e6, as thin as 1e-6 of it", 16, "2^-24 of the reach",
     "judged by double", "Möller and Trumbore 1997, epsilon 1e-6", 500'000, trials_of<slivers>},
    {"intersection/zero-area", "collinear and coinciding corners: missed, or hit on their line", 0, "wrong",
     "corners on a grid: exact", "", 500'000, trials_of<zero_area>},
    {"intersection/duplicates", "of triangles at the very same place the lowest object and primitive is hit", 0,
     "wrong", "judged by testing every triangle", "the last one wins", 3'000, trials_of<duplicates>},
    {"intersection/coplanar", "of overlapping faces in common planes the accelerator finds what testing all does", 0,
     "wrong", "judged by testing every quad", "", 3'000, trials_of<coplanar_faces>},
    {"intersection/axis-parallel", "rays along axes, zeros of both signs, also in the planes and edges of boxes", 8,
     "ulp of t", "judged by whole and half numbers; 5 roundings of weights and products",
     "Shirley's slabs on flat boxes, Möller and Trumbore 1997", 3'000, trials_of<axis_parallel>},
    {"intersection/bad-rays", "rays with NaN, infinities or no direction hit nothing", 0, "wrong", "exact",
     "`if (t < t_min || t > t_max) miss`, which a NaN passes", 200'000, bad_rays},
};

} // namespace

std::span<const StressTest> intersection_tests() { return kTests; }

} // namespace duet::compare
