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
constexpr std::int64_t kRaysPerTask = 64 * static_cast<std::int64_t>(kBlock); ///< number of rays generated and traced
                                                                              ///< at a time

/// Generates the random samples of a ray.
class RandomStream {
public:
    RandomStream(std::uint64_t seed, std::uint64_t index) : state_(hash_combine(mix_bits(seed + 1), index)) {}
    float uniform() { return unit_float(high_bits(stream_number(state_, next_++))); }
    std::size_t below(std::size_t n) {
        return static_cast<std::size_t>(stream_number(state_, next_++) % static_cast<std::uint64_t>(n));
    }

private:
    std::uint64_t state_, next_ = 0;
};

/// Returns how many more times a line from p leaves the mesh than enters it: 0 outside, 1 inside, 2 where two
/// parts overlap.
int winding_number(const ReferenceTracer& exact, Vec3d p) {
    Rayd ray{p, normalize(Vec3d(0.3183, 0.7071, 0.6314))};
    int winding = 0;
    while (true) {
        const ReferenceHit hit = exact.nearest(ray);
        if (!hit.valid()) return winding;
        const std::vector<Vec3d> c = exact.corners(hit.object, hit.primitive);
        winding += dot(cross(c[1] - c[0], c[2] - c[0]), ray.direction) > 0 ? 1 : -1;
        ray.t_min = hit.t;
    }
}

/// Holds all objects' triangles under one index, with their corners in world space.
class Targets {
public:
    Targets(const KernelScene& scene, const HitOracle& oracle) : exact_(oracle.exact()) {
        for (std::size_t object = 0; object < scene.scene->objects.size(); ++object) {
            first_.push_back(count_);
            count_ += scene.mesh_of(object).triangles.size();
        }
    }
    std::size_t count() const { return count_; }
    Vec3d point(std::size_t number, std::size_t kind, RandomStream& random) const {
        const auto object = static_cast<std::size_t>(std::ranges::upper_bound(first_, number) - first_.begin()) - 1;
        const std::vector<Vec3d> p =
            exact_.corners(static_cast<std::uint32_t>(object), static_cast<std::uint32_t>(number - first_[object]));
        if (kind == 0) return p[0];
        const float x = random.uniform();
        if (kind == 1) return lerp(p[0], p[1], static_cast<double>(x));
        const Vec2d uv(uniform_triangle(Vec2(x, random.uniform())));
        return p[0] * (1 - uv.x - uv.y) + p[1] * uv.x + p[2] * uv.y;
    }

private:
    const ReferenceTracer& exact_;
    std::vector<std::size_t> first_;
    std::size_t count_ = 0;
};

constexpr std::int64_t kRaysPerOrigin = 16; ///< consecutive rays that share an origin and are aimed at neighbors

Ray aimed_ray(const Targets& targets, const std::vector<Vec3>& origins, std::uint64_t seed, std::int64_t number) {
    RandomStream shared_random(seed, static_cast<std::uint64_t>(number / kRaysPerOrigin));
    const Vec3 origin = origins[shared_random.below(origins.size())];
    const auto index_in_group = static_cast<std::size_t>(number % kRaysPerOrigin);
    const std::size_t triangle = (shared_random.below(targets.count()) + index_in_group / 3) % targets.count();
    RandomStream own_random(~seed, static_cast<std::uint64_t>(number));
    const Vec3 target(targets.point(triangle, static_cast<std::size_t>(number) % 3, own_random));
    return {origin, normalize_scaled(target - origin)};
}

std::vector<Vec3> choose_origins(const KernelScene& scene, const HitOracle& oracle, std::uint64_t seed) {
    if (!scene.enclosed) return points_inside(scene, oracle, kOrigins, seed);
    std::vector<Vec3> points;
    const Box3& box = scene.scene->bounds; // in a closed room, the box of the walls
    for (std::uint64_t i = 0; i < kOrigins; ++i) {
        RandomStream random(~seed, i);
        const auto along = [&](std::size_t axis) {
            return box.low[axis] + (0.01f + 0.98f * random.uniform()) * (box.high[axis] - box.low[axis]);
        };
        const float x = along(0), y = along(1), z = along(2);
        points.emplace_back(x, y, z);
    }
    return points;
}

} // namespace

std::vector<Vec3> points_inside(const KernelScene& scene, const HitOracle& oracle, std::size_t count,
                                std::uint64_t seed) {
    const Mesh& mesh = scene.triangles();
    const double size = length(Vec3d(scene.scene->bounds.diagonal()));
    std::vector<Vec3> points;
    for (std::uint64_t attempt = 0; attempt < 4 * count && points.size() < count; ++attempt) {
        RandomStream random(~seed, attempt);
        const std::vector<Vec3d> c =
            oracle.exact().corners(0, static_cast<std::uint32_t>(random.below(mesh.triangles.size())));
        const Vec3d n = cross(c[1] - c[0], c[2] - c[0]);
        if (!(length(n) > 0)) continue;
        Rayd inwards{(c[0] + c[1] + c[2]) / 3.0, -normalize(n)};
        inwards.t_min = 1e-9 * size;
        const ReferenceHit other = oracle.exact().nearest(inwards);
        if (!other.valid() || other.t < 1e-4 * size) continue;
        const Vec3 p(inwards.at(other.t * (0.1 + 0.8 * static_cast<double>(random.uniform()))));
        if (winding_number(oracle.exact(), Vec3d(p)) > 0) points.push_back(p);
    }
    return points;
}

Watertight test_watertight(const KernelScene& scene, const HitOracle& oracle, const std::vector<TracerFactory>& kernels,
                           std::int64_t rays, std::uint64_t seed, int threads, const Control& control) {
    DUET_CHECK(scene.closed());
    const std::vector<Vec3> origins = choose_origins(scene, oracle, seed);
    if (origins.empty()) throw Error(scene.mesh + ": no point inside was found: the mesh is too thin");
    const Targets targets(scene, oracle);

    Watertight result{rays, std::vector<Watertight::Kernel>(kernels.size())};
    std::mutex mutex; // protects the sums and the progress
    std::int64_t done = 0;
    parallel_for(static_cast<std::size_t>((rays + kRaysPerTask - 1) / kRaysPerTask), threads, [&](std::size_t batch) {
        if (control.stopped()) return;
        const std::int64_t first = static_cast<std::int64_t>(batch) * kRaysPerTask;
        std::vector<Ray> aimed;
        std::vector<ReferenceHit> truth;
        for (std::int64_t i = first; i < std::min(first + kRaysPerTask, rays); ++i) {
            aimed.push_back(aimed_ray(targets, origins, seed, i));
            truth.push_back(oracle.first_hit(aimed.back()));
        }
        std::vector<Watertight::Kernel> found(kernels.size());
        for (std::size_t k = 0; k < kernels.size(); ++k) {
            const std::vector<RayResult> ray_results = trace_all(kernels[k](aimed), aimed.size(), 1);
            for (std::size_t i = 0; i < aimed.size(); ++i) {
                found[k].misses += !ray_results[i].hit();
                found[k].faults.count(oracle.closest(aimed[i], ray_results[i], truth[i]));
            }
        }
        const std::lock_guard lock(mutex);
        for (std::size_t k = 0; k < kernels.size(); ++k) {
            result.kernels[k].misses += found[k].misses;
            result.kernels[k].faults += found[k].faults;
        }
        done += std::ssize(aimed);
        control.report(static_cast<double>(done) / static_cast<double>(rays));
    });
    return result;
}

} // namespace duet::compare
