// These tests spawn rays from surfaces, at any scale and also from instances. The rays must neither hit their own
// surface nor miss nearby ones.
#include "common/vec/frame.h"
#include "compare/stress/accelerated_scene.h"
#include "compare/stress/errors.h"
#include "compare/stress/naive.h"
#include "compare/stress/trials.h"

#include <algorithm>

namespace duet::compare {

namespace {

constexpr float kTextbookTMin = 0.001f; ///< Ray Tracing in One Weekend, §9.3

Mat4 random_placement(TrialRandom& random, float scale) {
    const auto stretch = [&] { return static_cast<double>(random.sign() * random.uniform(0.3f, 1) * scale); };
    const double x = stretch(), y = stretch(), z = stretch();
    return Mat4(translation(Vec3d(random.vector()) * (10.0 * static_cast<double>(scale))) *
                rotation(normalize(Vec3d(random.direction())), static_cast<double>(random.uniform(0, 6))) *
                scaling(Vec3d(x, y, z)));
}

/// Returns a triangle, a quad or a sphere of about the given size, near the origin.
Shape random_shape(TrialRandom& random, float scale) {
    const auto point = [&] { return random.vector() * scale; };
    switch (random.below(3)) {
    case 0: {
        Mesh mesh;
        const Vec3 away = point() * 3.0f;
        mesh.positions = {away + point(), away + point(), away + point()};
        mesh.triangles = {{0, 1, 2}};
        return mesh;
    }
    case 1:
        return QuadList{{{point() * 3.0f, point(), point()}}};
    default:
        return Sphere{point() * 3.0f, scale * random.uniform(0.1f, 1)};
    }
}

/// Returns a random point of the shape, in object space.
Vec3 point_of(const Shape& shape, TrialRandom& random) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->center + random.direction() * sphere->radius;
    const PrimitiveVertices c = primitive_vertices(shape, 0);
    const float u = random.uniform(), v = c.count == 4 ? random.uniform() : random.uniform(0, 1 - u);
    return c.p[0] + (c.p[1] - c.p[0]) * u + ((c.count == 4 ? c.p[3] : c.p[2]) - c.p[0]) * v;
}

/// Returns the t beyond t_min at which the textbook routines hit the scene's only object.
std::optional<float> naive_hit(const Scene& scene, Ray ray) {
    const Object& object = scene.objects[0];
    ray.origin = transform_point(object.to_object, ray.origin);
    ray.direction = transform_vector(object.to_object, ray.direction);
    const Shape& shape = scene.shapes[object.shape];
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return naive::intersect_sphere(ray, *sphere);
    const PrimitiveVertices c = primitive_vertices(shape, 0);
    if (const auto t = naive::intersect_triangle(ray, c.p[0], c.p[1], c.p[2], 0)) return t;
    return c.count == 4 ? naive::intersect_triangle(ray, c.p[0], c.p[2], c.p[3], 0) : std::nullopt;
}

/// Returns a random direction away from the surface; every third one is grazing.
Vec3 direction_away(Trial& trial, Vec3 n) {
    Vec3 w = trial.random.direction();
    if (trial.number() % 3 == 0) w = w - n * (dot(w, n) * (1 - trial.random.log_uniform(1e-6f, 1e-1f)));
    return normalize(w);
}

/// Tests that rays leaving the scene's object, a shape or an instance, on either side do not hit it again.
void check_spawned_ray(Trial& trial, const Scene& built, Vec3 target, float scale) {
    const AcceleratedScene accelerated(built);
    const Vec3 origin = target + trial.random.direction() * (scale * trial.random.uniform(0.5f, 20));
    const Ray ray{origin, normalize_scaled(target - origin)};
    const Hit hit = accelerated.accelerator.closest(ray);
    if (!hit.valid()) return; // rounding moved the target off the silhouette
    const SurfacePoint point = surface_point(*accelerated.scene, ray, hit);
    Vec3 w = direction_away(trial, point.ng);
    const bool sphere = std::holds_alternative<Sphere>(accelerated.scene->shapes[0]);
    if (sphere && dot(w, point.ng) < 0) w = -w; // an inward ray correctly hits the other side
    const Ray spawned{offset_origin(point, w), w};
    const Hit again = accelerated.accelerator.closest(spawned);
    Hit end;
    end.t = std::numeric_limits<float>::max();
    trial.note("scale ", exact(scale), ", hit of primitive kind ", accelerated.scene->shapes[0].index(), " at ",
               exact(point.p), ", leaving along ", exact(w), ", again at ", exact(again.t));
    trial.record_failure_if(again.valid() || accelerated.accelerator.occluded(spawned, end));
    const auto t = naive_hit(*accelerated.scene, ray);
    if (t) trial.record_naive_failure_if(naive_hit(*accelerated.scene, {ray.at(*t), w, kTextbookTMin}).has_value());
}

void self_hits(Trial& trial) {
    const float scale = trial.random.log_uniform(1e-8f, 1e8f);
    const Shape shape = random_shape(trial.random, scale);
    const Vec3 target = point_of(shape, trial.random);
    check_spawned_ray(trial, make_scene({shape}), target, scale);
}

void instance_self_hits(Trial& trial) {
    const float scale = trial.random.log_uniform(1e-8f, 1e8f), own = trial.random.log_uniform(1e-3f, 1e3f);
    const Shape shape = random_shape(trial.random, own);
    const Mat4 to_world = random_placement(trial.random, scale / own);
    const Vec3 target = transform_point(to_world, point_of(shape, trial.random));
    check_spawned_ray(trial, make_scene(shape, {to_world, to_world}), target, scale);
}

void into_spheres(Trial& trial) {
    TrialRandom& random = trial.random;
    const float scale = random.log_uniform(1e-8f, 1e8f);
    const Sphere sphere{random.vector() * (3 * scale), scale * random.uniform(0.1f, 1)};
    const AcceleratedScene accelerated(make_scene({sphere}));
    const Vec3 target = point_of(sphere, random), origin = target + random.direction() * (5 * scale);
    const Ray ray{origin, normalize_scaled(target - origin)};
    const Hit hit = accelerated.accelerator.closest(ray);
    if (!hit.valid()) return;
    const SurfacePoint point = surface_point(*accelerated.scene, ray, hit);
    Vec3 w = direction_away(trial, point.ng);
    if (dot(w, point.ng) > 0) w = -w;
    const float cosine = -dot(w, point.ng), chord = 2 * sphere.radius * cosine;
    if (cosine < 1e-2f) return; // grazing: the chord is hardly longer than the offset
    // A ray origin δ below the surface changes the length of the chord by δ/cos − 2·δ·cos.
    const Vec3 start = offset_origin(point, w);
    const float offset = dot(abs(point.ng), abs(start - point.p) + point.p_error) + 4e-7f * sphere.radius;
    const auto error = [&](std::optional<float> t) {
        if (!t) return std::numeric_limits<double>::infinity();
        return static_cast<double>(abs(*t - chord) * cosine / offset);
    };
    const Hit across = accelerated.accelerator.closest({start, w});
    trial.note("radius ", exact(sphere.radius), " at ", exact(sphere.center), ", from ", exact(point.p), " along ",
               exact(w), ": ", exact(across.t), ", the chord is ", exact(chord));
    trial.record(error(across.valid() ? std::optional(across.t) : std::nullopt));
    trial.record_naive(error(naive::intersect_sphere({ray.at(hit.t), w, kTextbookTMin}, sphere)));
}

/// Tests two parallel quads 4e-5 apart. A ray leaving one outward must escape, and a ray leaving it inward must hit the
/// other quad.
void parallel_surfaces(Trial& trial) {
    TrialRandom& random = trial.random;
    constexpr float kGap = 4e-5f;
    const Frame frame = frame_from_normal(random.direction());
    const Vec3 corner = random.vector() - (frame.s + frame.t) * 2.0f;
    const Quad lower{corner, frame.s * 4.0f, frame.t * 4.0f}, upper{corner + frame.n * kGap, lower.u, lower.v};
    const AcceleratedScene accelerated(make_scene({QuadList{{lower}}, QuadList{{upper}}}));
    const Vec3 target = upper.corner + upper.u * random.uniform(0.2f, 0.8f) + upper.v * random.uniform(0.2f, 0.8f);
    const Vec3 from_above = frame.to_world({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.3f, 2)});
    const Ray ray{target + from_above, normalize(-from_above)};
    const Hit hit = accelerated.accelerator.closest(ray);
    const SurfacePoint point = surface_point(*accelerated.scene, ray, hit.valid() ? hit : Hit{1, 0, 0.5f, 0.5f, 1});
    const bool outwards = random.coin();
    Vec3 w = frame.to_local(random.direction());
    w.z = std::copysign(std::max(std::abs(w.z), 0.05f), outwards ? 1.0f : -1.0f);
    w = normalize(frame.to_world(w));
    const Hit next = accelerated.accelerator.closest({offset_origin(point, w), w});
    trial.note("n = ", exact(frame.n), ", corner ", exact(corner), ", ray from ", exact(ray.origin), " along ",
               exact(ray.direction), " hits ", hit.object, "; leaving along ", exact(w), " hits ", next.object);
    const auto wrong = [&](std::uint32_t first, std::uint32_t second) {
        return first != 1 || second != (outwards ? kNoObject : 0u);
    };
    trial.record_failure_if(wrong(hit.object, next.object));
    Ray textbook_ray{ray.at(hit.t), w, kTextbookTMin};
    trial.record_naive_failure_if(wrong(hit.object, accelerated.accelerator.closest(textbook_ray).object));
}

/// Tests that a point just above a surface 20 km wide is distinguished from the surface.
StressResult huge_ground(const StressTest& test, const StressSetting& setting) {
    constexpr float kHalf = 1e4f;
    const AcceleratedScene accelerated(
        make_scene({QuadList{{{{-kHalf, 0, kHalf}, {2 * kHalf, 0, 0}, {0, 0, -2 * kHalf}}}}}));
    return run_trials(test, setting, [&](Trial& trial) {
        TrialRandom& random = trial.random;
        const float height = random.log_uniform(1e-6f, 10);
        const Vec3 above(random.uniform(-0.9f, 0.9f) * kHalf, height, random.uniform(-0.9f, 0.9f) * kHalf);
        Vec3 down = random.direction();
        down = normalize(Vec3(down.x, -0.1f - std::abs(down.y), down.z));
        const Vec3 up(down.x, -down.y, down.z);
        const Hit hit = accelerated.accelerator.closest({above, down});
        trial.note("from ", exact(above), " along ", exact(down), ": t = ", exact(hit.t));
        trial.record_naive_failure_if(!accelerated.accelerator.closest({above, down, kTextbookTMin}).valid());
        if (!hit.valid()) return trial.record_failure_if(true);
        const SurfacePoint point = surface_point(*accelerated.scene, {above, down}, hit);
        const double truth = -static_cast<double>(above.y) / static_cast<double>(down.y);
        // Far from the surface's center, t has a rounding error in proportion to the corners' distances.
        trial.record_failure_if(!(std::abs(static_cast<double>(hit.t) - truth) <= 4e-3) ||
                                accelerated.accelerator.closest({above, up}).valid() ||
                                accelerated.accelerator.closest({offset_origin(point, up), up}).valid());
    });
}

/// Tests that inside a convex body every face is visible from every other.
StressResult convex_shadows(const StressTest& test, const StressSetting& setting) {
    std::vector<AcceleratedScene> accelerated_scenes;
    std::vector<float> scales;
    for (int decade = -8; decade <= 8; decade += 2) {
        scales.push_back(std::pow(10.0f, static_cast<float>(decade)));
        accelerated_scenes.emplace_back(
            make_scene({scaled_and_moved(icosphere(2), scales.back(), Vec3(1, -2, 3) * scales.back())}));
    }
    return run_trials(test, setting, [&](Trial& trial) {
        TrialRandom& random = trial.random;
        const std::size_t which = static_cast<std::size_t>(trial.number()) % accelerated_scenes.size();
        const AcceleratedScene& accelerated = accelerated_scenes[which];
        const Mesh& mesh = std::get<Mesh>(accelerated.scene->shapes[0]);
        const Vec3 center = Vec3(1, -2, 3) * scales[which];
        const auto on_face = [&](std::uint32_t face) { // a point away from the edges, which neighboring faces share
            const float u = random.uniform(0.02f, 0.96f), v = random.uniform(0.02f, 0.98f - u);
            const auto& [a, b, c] = mesh.triangles[face];
            return mesh.positions[a] * (1 - u - v) + mesh.positions[b] * u + mesh.positions[c] * v;
        };
        const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
        const std::uint32_t from = random.below(count), to = (from + 1 + random.below(count - 1)) % count;
        const Vec3 start = on_face(from), goal = on_face(to);
        const Ray ray{center, normalize_scaled(start - center)};
        const Hit hit = accelerated.accelerator.closest(ray);
        if (!hit.valid() || hit.primitive != from) return trial.record_failure_if(true);
        const SurfacePoint point = surface_point(*accelerated.scene, ray, hit);
        const Vec3 w = normalize_scaled(goal - point.p), origin = offset_origin(point, w);
        Hit end{0, to, 0, 0, length(goal - origin)};
        const Hit seen = accelerated.accelerator.closest({origin, w});
        trial.note("size ", exact(scales[which]), ", from face ", from, " to ", to, ": ", exact(origin), " along ",
                   exact(w), " sees face ", seen.primitive, " at ", exact(seen.t));
        trial.record_failure_if(seen.primitive != to || !seen.valid() ||
                                accelerated.accelerator.occluded({origin, w}, end));
        const Ray textbook_ray{ray.at(hit.t), w, kTextbookTMin};
        end.t = length(goal - textbook_ray.origin) - kTextbookTMin;
        trial.record_naive_failure_if(!(end.t > 0) || accelerated.accelerator.closest(textbook_ray).primitive != to);
    });
}

// Instances ----------------------------------------------------------------------------------------------------------

/// Returns the exact position of a triangle hit, computed in double from the same floats.
Vec3d exact_position(const Scene& scene, const Hit& hit) {
    const Object& object = scene.objects[hit.object];
    const PrimitiveVertices c = primitive_vertices(scene.shapes[object.shape], hit.primitive);
    const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
    const Vec3d a(c.p[0]), b(c.p[1]), d(c.p[2]);
    return transform_point(Mat4d(object.to_world), a + (b - a) * u + (d - a) * v);
}

double in_units_of(Vec3d off, Vec3 bound) {
    double worst = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double error = std::abs(off[axis]), allowed = static_cast<double>(bound[axis]);
        if (error != 0) worst = larger_error(allowed > 0 ? error / allowed : error / 1e-45, worst);
    }
    return worst;
}

void error_bounds(Trial& trial) {
    static const Mesh mesh = icosphere(0);
    TrialRandom& random = trial.random;
    const float scale = random.log_uniform(1e-6f, 1e6f);
    const Mat4 to_world = random_placement(random, scale);
    const Scene scene = make_scene(mesh, {to_world, to_world});
    const float u = random.uniform();
    const Hit hit{0, random.below(20), u, random.uniform(0, 1 - u), 1};
    const SurfacePoint point = surface_point(scene, {{}, {0, 0, 1}}, hit);
    // The point is also transformed to object space in float, as the origin of a spawned ray is, and back to the world.
    const Object& object = scene.objects[0];
    const Vec3 back = transform_point_inverse(object.to_world, object.to_object, point.p);
    const Vec3d there = transform_point(Mat4d(to_world), Vec3d(back));
    trial.note("scale ", exact(scale), ", primitive ", hit.primitive, " at ", exact(point.p), " ± ",
               exact(point.p_error));
    trial.record(in_units_of(Vec3d(point.p) - exact_position(scene, hit), point.p_error));
    trial.record(in_units_of(there - exact_position(scene, hit), point.p_error));
    trial.record_naive(in_units_of(there - exact_position(scene, hit), Vec3(1, 1, 1) * kTextbookTMin));
}

void instances_as_baked(Trial& trial) {
    static const Mesh mesh = icosphere(1);
    TrialRandom& random = trial.random;
    const float scale = random.log_uniform(1e-6f, 1e6f);
    const Mat4 to_world = random_placement(random, scale);
    Mesh moved = mesh;
    for (Vec3& p : moved.positions) p = Vec3(transform_point(Mat4d(to_world), Vec3d(p)));
    const AcceleratedScene instance(make_scene(mesh, {to_world, to_world})), baked(make_scene({moved}));
    for (int shot = 0; shot < 16; ++shot) {
        const Vec3 target = transform_point(to_world, random.vector() * 0.5f);
        const Vec3 origin = target + random.direction() * (scale * random.uniform(2, 5));
        const Ray ray{origin, normalize_scaled(target - origin)};
        const Hit a = instance.accelerator.closest(ray), b = baked.accelerator.closest(ray);
        // The hits differ because rounding chose different sides of an edge.
        if (a.valid() && b.valid() && a.primitive != b.primitive) continue;
        if (!a.valid() || !b.valid()) {
            trial.record(a.valid() == b.valid() ? 0 : std::numeric_limits<double>::infinity());
            continue;
        }
        const SurfacePoint point = surface_point(*instance.scene, ray, a);
        const double along = static_cast<double>(a.t) - static_cast<double>(b.t);
        const double off = std::abs(along * static_cast<double>(dot(ray.direction, point.ng)));
        const Vec3 reach = point.p_error + abs(ray.origin) * 4e-7f;
        trial.note("scale ", exact(scale), ", ray from ", exact(origin), " along ", exact(ray.direction), ": ",
                   exact(a.t), " as an instance, ", exact(b.t), " baked");
        trial.record(off / static_cast<double>(dot(abs(point.ng), reach)));
    }
}

constexpr std::string_view kOffset = "Pharr, Jakob and Humphreys 2023, §6.8";
constexpr std::string_view kTMin = "t > 0.001, as the books have it";

constexpr StressTest kTests[] = {
    {"departure/self-hits", "rays leaving triangles, quads and spheres of sizes 1e-8 to 1e8 do not hit them again", 0,
     "wrong", kOffset, kTMin, 200'000, trials_of<self_hits>},
    {"departure/instance-self-hits", "the same of turned, stretched and mirrored instances", 0, "wrong", kOffset, kTMin,
     200'000, trials_of<instance_self_hits>},
    {"departure/into-spheres", "rays leaving a sphere inwards meet its other side, a chord away", 8, "of the offset",
     "the chord's change with an offset start, to first order", kTMin, 200'000, trials_of<into_spheres>, 0.7},
    {"departure/parallel-surfaces", "of two sheets 4e-5 apart each lets light out on its side and hides the other", 0,
     "wrong", kOffset, kTMin, 100'000, trials_of<parallel_surfaces>},
    {"departure/huge-ground", "from 1e-6 to 10 above a ground 20 km wide: hit downwards, never upwards", 0, "wrong",
     "the sign of the plane's distance, in double", kTMin, 200'000, huge_ground},
    {"departure/convex-shadows", "every face of a convex body, of size 1e-8 to 1e8, sees every other from inside", 0,
     "wrong", kOffset, kTMin, 200'000, convex_shadows},
    {"departure/error-bounds", "an instance's surface point, and its way to the object and back, keep to p_error", 1,
     "of p_error", "judged by double", "an error of 0.001 for all", 200'000, trials_of<error_bounds>},
    {"departure/instances", "an instance is hit where the same mesh is, its vertices moved to the world", 1,
     "of the bounds", "p_error and the transformed ray's rounding, γ₄ of its origin; judged by the baked mesh", "",
     10'000, trials_of<instances_as_baked>},
};

} // namespace

std::span<const StressTest> ray_origin_tests() { return kTests; }

} // namespace duet::compare
