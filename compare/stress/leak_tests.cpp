// These tests check that closed surfaces are watertight, for any ray, size and position.
#include "common/geometry/triangle.h"
#include "compare/stress/accelerated_scene.h"
#include "compare/stress/naive.h"
#include "compare/stress/trials.h"

namespace duet::compare {

namespace {

/// A ClosedMesh is a closed mesh with its size and center.
struct ClosedMesh {
    AcceleratedScene accelerated;
    float scale;
    Vec3 center;

    explicit ClosedMesh(float scale_, Vec3 center_)
        : accelerated(make_scene({scaled_and_moved(icosphere(2, 0.1f), scale_, center_)})), scale(scale_),
          center(center_) {}
    const Mesh& mesh() const { return std::get<Mesh>(accelerated.scene->shapes[0]); }
};

/// Returns meshes around the origin of sizes 1e-6 to 1e6, and of size 1 about 1e5 away, along the diagonal and along
/// one axis.
std::vector<ClosedMesh> closed_meshes() {
    std::vector<ClosedMesh> all;
    for (const float scale : {1e-6f, 1e-4f, 1e-2f, 1.0f, 1e2f, 1e4f, 1e6f}) all.emplace_back(scale, Vec3());
    all.emplace_back(1.0f, Vec3(1e5f, -1e5f, 1e5f));
    all.emplace_back(1.0f, Vec3(0, 1e5f, 0));
    return all;
}

bool hit_by_any(const Mesh& mesh, const Ray& ray) {
    for (const auto& [a, b, c] : mesh.triangles)
        if (naive::intersect_triangle(ray, mesh.positions[a], mesh.positions[b], mesh.positions[c])) return true;
    return false;
}

/// Tests that a ray from inside hits, and that the accelerator finds the same hit as testing all triangles.
void check_ray(Trial& trial, const ClosedMesh& closed_mesh, const Ray& ray) {
    const Hit expected = brute_force_hit(*closed_mesh.accelerated.scene, ray),
              found = closed_mesh.accelerated.accelerator.closest(ray);
    trial.note("mesh of size ", exact(closed_mesh.scale), " at ", exact(closed_mesh.center), ", ray from ",
               exact(ray.origin), " along ", exact(ray.direction), ": primitive ", found.primitive, " at ",
               exact(found.t), ", testing all: ", expected.primitive, " at ", exact(expected.t));
    trial.record_failure_if(!found.valid() || !(found == expected));
    trial.record_naive_failure_if(!hit_by_any(closed_mesh.mesh(), ray));
}

const ClosedMesh& chosen(Trial& trial) {
    static const std::vector<ClosedMesh> all = closed_meshes();
    return all[static_cast<std::size_t>(trial.number()) % all.size()];
}

Vec3 inside(const ClosedMesh& closed_mesh, Trial& trial) {
    return closed_mesh.center + trial.random.vector() * (0.4f * closed_mesh.scale);
}

void leak_random(Trial& trial) {
    const ClosedMesh& closed_mesh = chosen(trial);
    check_ray(trial, closed_mesh, {inside(closed_mesh, trial), trial.random.direction()});
}

Ray toward(Vec3 origin, Vec3 target) { return {origin, normalize_scaled(target - origin)}; }

void leak_edges(Trial& trial) {
    const ClosedMesh& closed_mesh = chosen(trial);
    const Mesh& mesh = closed_mesh.mesh();
    const auto& t = mesh.triangles[trial.random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const Vec3 target = lerp(mesh.positions[t[0]], mesh.positions[t[1]], trial.random.uniform());
    check_ray(trial, closed_mesh, toward(inside(closed_mesh, trial), target));
}

void leak_vertices(Trial& trial) {
    const ClosedMesh& closed_mesh = chosen(trial);
    const auto& positions = closed_mesh.mesh().positions;
    const Vec3 vertex = positions[trial.random.below(static_cast<std::uint32_t>(positions.size()))];
    check_ray(trial, closed_mesh, toward(inside(closed_mesh, trial), vertex));
}

StressResult leak_from_outside(const StressTest& test, const StressSetting& setting) {
    std::vector<AcceleratedScene> accelerated_scenes;
    constexpr std::array<float, 5> kScales{1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f};
    for (const float scale : kScales)
        accelerated_scenes.emplace_back(make_scene({scaled_and_moved(icosphere(2), scale, {})}));
    return run_trials(test, setting, [&](Trial& trial) {
        const std::size_t which = static_cast<std::size_t>(trial.number()) % kScales.size();
        const Mesh& mesh = std::get<Mesh>(accelerated_scenes[which].scene->shapes[0]);
        // The ray is aimed at vertices and edges that face the eye, so the first face that it hits must face the eye,
        // too.
        const auto& t = mesh.triangles[trial.random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
        const float along = trial.random.coin() ? 0.0f : trial.random.uniform();
        const Vec3 target = lerp(mesh.positions[t[0]], mesh.positions[t[1]], along);
        const Vec3 outwards = normalize_scaled(target);
        const Vec3 side = normalize(outwards + trial.random.direction() * 0.6f);
        const Ray ray = toward(target + side * (kScales[which] * trial.random.log_uniform(0.1f, 1e3f)), target);
        const auto leaks = [&](std::optional<std::uint32_t> primitive) {
            if (!primitive) return true;
            const auto& [a, b, c] = mesh.triangles[*primitive];
            return dot(mesh.positions[a] + mesh.positions[b] + mesh.positions[c], ray.direction) > 0;
        };
        const Hit hit = accelerated_scenes[which].accelerator.closest(ray);
        std::optional<std::uint32_t> naive_hit;
        float nearest = kInfinity;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const auto& [a, b, c] = mesh.triangles[i];
            const auto found = naive::intersect_triangle(ray, mesh.positions[a], mesh.positions[b], mesh.positions[c]);
            if (found && *found < nearest) nearest = *found, naive_hit = i;
        }
        trial.note("ball of size ", exact(kScales[which]), ", ray from ", exact(ray.origin), " along ",
                   exact(ray.direction), ": primitive ", hit.primitive, " at ", exact(hit.t));
        trial.record_failure_if(leaks(hit.valid() ? std::optional(hit.primitive) : std::nullopt));
        trial.record_naive_failure_if(leaks(naive_hit));
    });
}

/// Tests a box, whose six quads do not share corners.
void leak_boxes(Trial& trial) {
    TrialRandom& random = trial.random;
    const float scale = random.log_uniform(1e-6f, 1e6f);
    const Vec3 middle = random.vector() * (scale * (trial.number() % 2 ? 1.0f : 100.0f));
    const Vec3 half = Vec3(random.uniform(0.1f, 1), random.uniform(0.1f, 1), random.uniform(0.1f, 1)) * scale;
    const Vec3 low = middle - half, high = middle + half;
    const AcceleratedScene accelerated(make_scene({box_quads(low, high)}));
    for (int shot = 0; shot < 16; ++shot) {
        Vec3 target(random.coin() ? low.x : high.x, random.coin() ? low.y : high.y, random.coin() ? low.z : high.z);
        const std::uint32_t axis = random.below(4); // 3: a corner
        if (axis < 3) target[axis] = lerp(low[axis], high[axis], random.uniform());
        const Ray ray = toward(lerp(low, high, random.uniform(0.2f, 0.8f)), target);
        const Hit hit = accelerated.accelerator.closest(ray);
        if (!hit.valid())
            trial.note("box ", exact(low), " to ", exact(high), ", ray from ", exact(ray.origin), " along ",
                       exact(ray.direction));
        trial.record_failure_if(!hit.valid());
    }
}

void leak_instances(Trial& trial) {
    static const Mesh mesh = icosphere(1, 0.1f);
    TrialRandom& random = trial.random;
    const float scale = random.log_uniform(1e-6f, 1e6f);
    const Mat4 to_world(
        translation(Vec3d(random.vector()) * static_cast<double>(scale) * 100.0) *
        rotation(normalize(Vec3d(random.direction())), static_cast<double>(random.uniform(0, 6))) *
        scaling(Vec3d(static_cast<double>(random.uniform(0.2f, 1)), -1, 2) * static_cast<double>(scale)));
    const AcceleratedScene accelerated(make_scene(mesh, {to_world, to_world * Mat4(scaling(Vec3(3, 3, 3)))}));
    for (int shot = 0; shot < 64; ++shot) {
        const auto& t = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
        const Vec3 on_edge = lerp(mesh.positions[t[0]], mesh.positions[t[1]], random.coin() ? 0 : random.uniform());
        const Ray ray = toward(transform_point(to_world, random.vector() * 0.3f), transform_point(to_world, on_edge));
        const Hit hit = accelerated.accelerator.closest(ray), expected = brute_force_hit(*accelerated.scene, ray);
        const bool wrong = hit.object != 0 || !(hit == expected);
        if (wrong)
            trial.note("scale ", exact(scale), ", ray from ", exact(ray.origin), " along ", exact(ray.direction),
                       ": object ", hit.object, ", testing all: ", expected.object);
        trial.record_failure_if(wrong);
    }
}

constexpr std::string_view kWatertight = "Woop, Benthin and Wald 2013, §3; judged by testing every triangle";
constexpr std::string_view kMollerTrumbore = "Möller and Trumbore 1997, epsilon 1e-6";

constexpr StressTest kTests[] = {
    {"leak/random", "rays from inside a closed mesh hit it: of sizes 1e-6 to 1e6, and 1e5 away", 0, "wrong",
     kWatertight, kMollerTrumbore, 100'000, trials_of<leak_random>},
    {"leak/edges", "the same, aimed at its edges", 0, "wrong", kWatertight, kMollerTrumbore, 100'000,
     trials_of<leak_edges>},
    {"leak/vertices", "the same, aimed at its vertices", 0, "wrong", kWatertight, kMollerTrumbore, 100'000,
     trials_of<leak_vertices>},
    {"leak/from-outside", "rays from 0.1 to 1000 radii outside, aimed at edges and vertices, hit the side they see", 0,
     "wrong", "Woop, Benthin and Wald 2013, §3; a ball's near side faces the eye", kMollerTrumbore, 100'000,
     leak_from_outside},
    {"leak/boxes", "rays from inside a box of any size and place hit it at its edges and corners", 0, "wrong",
     "neighboring quads have the very same corners", "", 20'000, trials_of<leak_boxes>},
    {"leak/instances", "rays from inside a turned, stretched and mirrored instance hit it, not the larger one around",
     0, "wrong", kWatertight, "", 3'000, trials_of<leak_instances>},
};

} // namespace

std::span<const StressTest> leak_tests() { return kTests; }

} // namespace duet::compare
