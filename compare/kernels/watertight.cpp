#include "compare/kernels/watertight.h"

#include "common/sampling/hash.h"
#include "common/sampling/warp.h"
#include "common/system/error.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <mutex>

namespace duet::compare {

namespace {

constexpr std::size_t kOrigins = 4096;
constexpr std::int64_t kMade = 64 * static_cast<std::int64_t>(kBlock); ///< rays made and traced at a time

/// A ray's random numbers.
class Numbers {
public:
    Numbers(std::uint64_t seed, std::uint64_t index) : state_(hash_combine(mix_bits(seed + 1), index)) {}
    float uniform() { return unit_float(high_bits(stream_number(state_, next_++))); }
    std::size_t below(std::size_t n) {
        return static_cast<std::size_t>(stream_number(state_, next_++) % static_cast<std::uint64_t>(n));
    }

private:
    std::uint64_t state_, next_ = 0;
};

/// How much oftener a line from p leaves the mesh than it enters: 0 outside, 1 inside, 2 where two parts overlap.
int winding_number(const ExactTracer& exact, Vec3d p) {
    Rayd ray{p, normalize(Vec3d(0.3183, 0.7071, 0.6314))};
    int winding = 0;
    while (true) {
        const ExactHit hit = exact.nearest(ray);
        if (!hit.valid()) return winding;
        const std::vector<Vec3d> c = exact.corners(hit.object, hit.primitive);
        winding += dot(cross(c[1] - c[0], c[2] - c[0]), ray.direction) > 0 ? 1 : -1;
        ray.t_min = hit.t;
    }
}

Vec3 target(const Mesh& mesh, Numbers& numbers, std::int64_t kind) {
    const auto& [a, b, c] = mesh.triangles[numbers.below(mesh.triangles.size())];
    const Vec3 pa = mesh.positions[a], pb = mesh.positions[b], pc = mesh.positions[c];
    if (kind == 0) return pa;
    const float x = numbers.uniform();
    if (kind == 1) return lerp(pa, pb, x);
    const Vec2 uv = uniform_triangle(Vec2(x, numbers.uniform()));
    return pa * (1 - uv.x - uv.y) + pb * uv.x + pc * uv.y;
}

Ray aimed_ray(const Mesh& mesh, const std::vector<Vec3>& origins, std::uint64_t seed, std::int64_t number) {
    Numbers numbers(seed, static_cast<std::uint64_t>(number));
    const Vec3 origin = origins[numbers.below(origins.size())];
    return {origin, normalize_scaled(target(mesh, numbers, number % 3) - origin)};
}

} // namespace

std::vector<Vec3> points_inside(const KernelScene& scene, const Judge& judge, std::size_t count, std::uint64_t seed) {
    const Mesh& mesh = scene.triangles();
    const double size = length(Vec3d(scene.scene->bounds.diagonal()));
    std::vector<Vec3> points;
    for (std::uint64_t attempt = 0; attempt < 4 * count && points.size() < count; ++attempt) {
        Numbers numbers(~seed, attempt);
        const std::vector<Vec3d> c =
            judge.exact().corners(0, static_cast<std::uint32_t>(numbers.below(mesh.triangles.size())));
        const Vec3d n = cross(c[1] - c[0], c[2] - c[0]);
        if (!(length(n) > 0)) continue;
        Rayd inwards{(c[0] + c[1] + c[2]) / 3.0, -normalize(n)};
        inwards.t_min = 1e-9 * size;
        const ExactHit other = judge.exact().nearest(inwards);
        if (!other.valid() || other.t < 1e-4 * size) continue;
        const Vec3 p(inwards.at(other.t * (0.1 + 0.8 * static_cast<double>(numbers.uniform()))));
        if (winding_number(judge.exact(), Vec3d(p)) > 0) points.push_back(p);
    }
    return points;
}

Watertight test_watertight(const KernelScene& scene, const Judge& judge, const std::vector<TracerFor>& kernels,
                           std::int64_t rays, std::uint64_t seed, int threads, const Control& control) {
    const Mesh& mesh = scene.triangles();
    DUET_CHECK(mesh.closed);
    const std::vector<Vec3> origins = points_inside(scene, judge, kOrigins, seed);
    if (origins.empty()) throw Error(scene.mesh + ": no point inside was found: the mesh is too thin");

    Watertight result{rays, std::vector<std::int64_t>(kernels.size(), 0)};
    std::mutex mutex; // of the sums and the progress
    std::int64_t done = 0;
    parallel_for(static_cast<std::size_t>((rays + kMade - 1) / kMade), threads, [&](std::size_t batch) {
        if (control.stopped()) return;
        const std::int64_t first = static_cast<std::int64_t>(batch) * kMade;
        std::vector<Ray> aimed;
        for (std::int64_t i = first; i < std::min(first + kMade, rays); ++i)
            aimed.push_back(aimed_ray(mesh, origins, seed, i));
        std::vector<std::int64_t> misses;
        for (const TracerFor& kernel : kernels) {
            const std::vector<Answer> answers = all_answers(kernel(aimed), aimed.size(), 1);
            misses.push_back(std::ranges::count_if(answers, [](const Answer& a) { return !a.hit(); }));
        }
        const std::lock_guard lock(mutex);
        for (std::size_t i = 0; i < misses.size(); ++i) result.misses[i] += misses[i];
        done += std::ssize(aimed);
        control.report(static_cast<double>(done) / static_cast<double>(rays));
    });
    return result;
}

} // namespace duet::compare
