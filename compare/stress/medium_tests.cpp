// These tests check rays in fog, clouds and solids: their columns against double precision, and the weights of paths.
#include "common/medium/density_grid.h"
#include "common/medium/medium.h"
#include "compare/stress/accelerated_scene.h"
#include "compare/stress/errors.h"
#include "compare/stress/trials.h"
#include "raytrace/integrator/medium_sampling.h"
#include "raytrace/integrator/random_walk.h"
#include "raytrace/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace duet::compare {

namespace {

constexpr double kWrong = std::numeric_limits<double>::infinity();

/// Returns a box of sides that differ by up to a factor of 1,000, at times far from the origin.
Box3 random_box(TrialRandom& random, float scale) {
    const Vec3 half(random.log_uniform(1e-3f, 1), random.log_uniform(1e-3f, 1), random.log_uniform(1e-3f, 1));
    const Vec3 center = random.vector() * (random.coin() ? 1 : random.log_uniform(1, 100));
    return {(center - half) * scale, (center + half) * scale};
}

/// Returns a grid of 2 to 20 points along each axis, many of them empty.
DensityGrid random_grid(TrialRandom& random) {
    std::array<int, 3> size{};
    std::size_t count = 1;
    for (int& points : size) {
        points = 2 + static_cast<int>(random.below(19));
        count *= static_cast<std::size_t>(points);
    }
    const float empty = random.coin() ? 0 : random.uniform();
    std::vector<float> densities(count);
    for (float& density : densities) density = random.uniform() < empty ? 0 : random.uniform();
    return {size, std::move(densities)};
}

/// Returns a ray that starts inside of a box, on its side, at its corner, or before it, at times parallel to axes.
Ray random_ray(TrialRandom& random, const Box3& box) {
    const Vec3 size = box.diagonal();
    Vec3 origin = box.low + size * Vec3(random.uniform(), random.uniform(), random.uniform());
    Vec3 direction = random.direction();
    const std::size_t axis = random.below(3);
    if (random.below(4) == 0) direction[axis] = 0;
    if (random.below(8) == 0) direction = {}, direction[axis] = random.sign();
    direction = normalize(direction);
    switch (random.below(4)) {
    case 0:
        origin[axis] = random.coin() ? box.low[axis] : box.high[axis];
        break;
    case 1:
        origin = box.corner(random.below(8));
        break;
    case 2:
        origin -= direction * (max_component(size) * random.uniform(1, 4));
        break;
    default:
        break;
    }
    return {origin, direction};
}

/// Integrates the density of a grid along a ray in double: the planes that the ray crosses are sorted, and between two
/// of them Simpson's rule is exact.
class DoubleColumn {
public:
    DoubleColumn(const DensityGrid& grid, const Box3& box, const Ray& ray) : grid_(grid) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double low = static_cast<double>(box.low[axis]);
            const double scale = (grid.size()[axis] - 1) / (static_cast<double>(box.high[axis]) - low);
            origin_[axis] = (static_cast<double>(ray.origin[axis]) - low) * scale;
            direction_[axis] = static_cast<double>(ray.direction[axis]) * scale;
        }
    }
    double operator()(double begin, double end) const {
        std::vector<double> planes{begin, end};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (int plane = 0; plane < grid_.size()[axis]; ++plane) {
                const double t = (plane - origin_[axis]) / direction_[axis];
                if (begin < t && t < end) planes.push_back(t);
            }
        std::sort(planes.begin(), planes.end());
        double sum = 0;
        for (std::size_t i = 0; i + 1 < planes.size(); ++i) sum += between(planes[i], planes[i + 1]);
        return sum;
    }
    /// Returns the mean of the densities at the midpoints of 64 equal steps, times the length.
    double marched(float begin, float end) const {
        float sum = 0;
        for (int i = 0; i < 64; ++i)
            sum += static_cast<float>(
                density(static_cast<double>(begin + (end - begin) * (static_cast<float>(i) + 0.5f) / 64)));
        return static_cast<double>(sum * (end - begin) / 64);
    }

private:
    double between(double a, double b) const {
        return (b - a) * (density(a) + 4 * density((a + b) / 2) + density(b)) / 6;
    }
    double density(double t) const {
        std::array<int, 3> cell{};
        Vec3d f;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double p = clamp(origin_[axis] + t * direction_[axis], 0.0, grid_.size()[axis] - 1.0);
            cell[axis] = std::min(static_cast<int>(p), grid_.size()[axis] - 2);
            f[axis] = p - cell[axis];
        }
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
            const int index = cell[0] + x + grid_.size()[0] * (cell[1] + y + grid_.size()[1] * (cell[2] + z));
            sum += (x ? f.x : 1 - f.x) * (y ? f.y : 1 - f.y) * (z ? f.z : 1 - f.z) *
                   static_cast<double>(grid_.densities()[static_cast<std::size_t>(index)]);
        }
        return sum;
    }

    const DensityGrid& grid_;
    Vec3d origin_, direction_;
};

void columns(Trial& trial) {
    TrialRandom& random = trial.random;
    Medium medium;
    medium.box = random_box(random, random.log_uniform(1e-6f, 1e6f));
    const auto grid = std::make_shared<const DensityGrid>(random_grid(random));
    medium.density = grid;
    const Ray ray = random_ray(random, medium.box);
    const Interval inside = overlap(medium.box, ray, kInfinity);
    const float largest = grid->largest();
    if (inside.empty() || largest == 0) return trial.record(0);
    const double begin = static_cast<double>(inside.begin), end = static_cast<double>(inside.end);
    const DoubleColumn exact_column(*grid, medium.box, ray);
    const double truth = exact_column(begin, end);
    // Rounding a coordinate moves it by 2^-24 of the number of cells, and changes the density by the same fraction of
    // its maximum. The ends of the interval and the distance that follow() finds are rounded, too.
    const int cells = *std::ranges::max_element(grid->size()) - 1;
    const double terms = static_cast<double>(largest) * ((end - begin) * cells + end);
    const auto error = [&](double found, double expected) { return in_roundoffs((found - expected) / terms); };
    const float found = column_of(medium, ray.origin, ray.direction, inside);
    trial.note("box ", exact(medium.box.low), " to ", exact(medium.box.high), ", ray ", exact(ray.origin), " toward ",
               exact(ray.direction), ", ", grid->size()[0], " x ", grid->size()[1], " x ", grid->size()[2],
               " points: column ", found, ", in double ", truth);
    trial.record(error(static_cast<double>(found), truth));
    trial.record_naive(error(exact_column.marched(inside.begin, inside.end), truth));
    const float part = found * random.uniform();
    if (!(part > 0)) return;
    const PassedColumn reached = follow(medium, ray, inside, part);
    if (!(inside.begin <= reached.t && reached.t <= inside.end)) return trial.record(kWrong);
    trial.record(error(exact_column(begin, static_cast<double>(reached.t)), static_cast<double>(part)));
}

/// Returns a medium of optical depths from 1e-6 to 1e6 that absorbs nothing, everything or a fraction, gray or colored.
Medium random_medium(TrialRandom& random, const Box3& box) {
    Medium medium;
    medium.box = box;
    const float thickness = random.log_uniform(1e-6f, 1e6f) / max_component(box.diagonal());
    const auto color = [&] {
        return random.coin() ? Rgb(random.uniform()) : Rgb(random.uniform(), random.uniform(), random.uniform());
    };
    const std::uint32_t kind = random.below(3);
    if (kind != 0) medium.scattering = color() * thickness;
    if (kind != 1) medium.absorption = color() * thickness;
    if (random.coin()) medium.density = std::make_shared<const DensityGrid>(random_grid(random));
    return medium;
}

/// Tests that a collision never raises the sum of the throughput's channels, and preserves it where nothing is
/// absorbed. This holds because the channel that determines the distance is chosen in proportion to the throughput.
void collisions(Trial& trial) {
    TrialRandom& random = trial.random;
    const float scale = random.log_uniform(1e-6f, 1e6f);
    std::vector<Medium> media;
    Box3 box = random_box(random, scale);
    for (std::uint32_t i = 0; i <= random.below(3); ++i) { // some media share a box
        media.push_back(random_medium(random, box));
        if (random.coin()) box = {box.low, box.low + box.diagonal() * random.uniform(0.1f, 2)};
    }
    const Ray ray = random_ray(random, media.front().box);
    const float t_end = random.coin() ? kInfinity : scale * random.log_uniform(1e-3f, 10);
    const Rgb before(random.uniform() + 1e-3f, random.coin() ? 0 : random.uniform(), random.uniform());
    Rgb after = before, emitted;
    raytrace::MediaOnRay on_ray(media, ray, t_end);
    const auto collision = raytrace::sample_collision(on_ray, random.uniform(), after, emitted);
    const auto sum = [](Rgb color) { return static_cast<double>(color.r) + static_cast<double>(color.g + color.b); };
    const double ratio = sum(after) / sum(before);
    const bool absorbs = std::ranges::any_of(media, [](const Medium& m) { return !is_black(m.absorption); });
    trial.note(media.size(), " media from ", exact(media.front().box.low), ", ray ", exact(ray.origin), " toward ",
               exact(ray.direction), ": throughput ", exact(Vec3(before.r, before.g, before.b)), " becomes ",
               exact(Vec3(after.r, after.g, after.b)));
    const bool valid = std::min({after.r, after.g, after.b}) >= 0 && is_black(emitted);
    if (!valid || (collision && !(collision->t >= 0 && collision->t <= t_end))) return trial.record(kWrong);
    trial.record(absorbs ? in_roundoffs(std::max(ratio - 1, 0.0)) : in_roundoffs(ratio - 1));
}

/// A ClosedShape is a closed shape, and a point on it with the normal there.
struct ClosedShape {
    Shape shape;
    Vec3 point, normal;
};
ClosedShape random_closed_shape(TrialRandom& random, float size, Vec3 center) {
    const Vec3 direction = random.direction();
    if (random.below(3) == 0) return {Sphere{center, size}, center + direction * size, direction};
    if (random.coin()) {
        const Vec3 half(random.log_uniform(0.02f, 1), random.log_uniform(0.02f, 1), random.log_uniform(0.02f, 1));
        const Vec3 p(half.x * random.uniform(-1, 1), half.y, half.z * random.uniform(-1, 1));
        return {box_quads(center - half * size, center + half * size), center + p * size, Vec3(0, 1, 0)};
    }
    Mesh mesh = scaled_and_moved(icosphere(static_cast<int>(random.below(4)), 0.3f), size, center);
    const auto& corners = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const Vec3 a = mesh.positions[corners[0]], b = mesh.positions[corners[1]], c = mesh.positions[corners[2]];
    const Vec3 normal = normalize(Vec3(cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a))));
    return {std::move(mesh), (a + b + c) * (1.0f / 3), normal};
}

/// Tests that no path is lost in a solid that absorbs nothing, and that its throughput does not change.
void walks(Trial& trial) {
    TrialRandom& random = trial.random;
    const float size = random.log_uniform(1e-6f, 1e6f);
    const Vec3 center = random.vector() * (size * (random.coin() ? 1 : random.log_uniform(1, 100)));
    ClosedShape solid = random_closed_shape(random, size, center);
    const float mean_free_path = size * random.log_uniform(0.03f, 1e3f);
    std::vector<Shape> shapes{solid.shape};
    if (random.coin()) shapes.push_back(Sphere{center + random.direction() * (size * random.uniform()), 0.4f * size});
    Scene scene = make_scene(std::move(shapes));
    scene.materials[0] = Coated{{Rgb(1.0f)}, 0.3f, 1.5f, Rgb(mean_free_path)};
    finish_scene(scene);
    raytrace::PathTracerSettings settings;
    settings.threads = 1;
    const raytrace::PathTracerScene prepared = raytrace::prepare(scene, settings);
    const raytrace::RenderPlan plan(prepared.data(), View{scene.camera, 1, 1}, settings);
    const Vec3 inward = -solid.normal, p = solid.point;
    const Vec3 error = abs(p) * 0x1p-20f;
    for (int i = 0; i < 20; ++i) {
        Vec3 direction = random.direction();
        if (dot(direction, inward) < 0) direction = -direction;
        const Ray ray{offset_origin(p, error, inward), direction};
        const Hit hit = plan.prepared.accelerator.closest(ray);
        if (!hit.valid()) continue; // the point is at an edge, and the offset has left the solid
        raytrace::PathThroughputT<float> path;
        raytrace::RayCounts counts;
        Rgb emitted;
        const SolidInterior interior = solid_interior(Rgb(1.0f), *duet::mean_free_path(scene.materials[0]));
        const auto exit = raytrace::random_walk(plan, {interior, 0}, ray, hit, random.uniform(), path, emitted,
                                                counts);
        trial.note("size ", size, ", center ", exact(center), ", mean free path ", mean_free_path, ", from ",
                   exact(ray.origin), " toward ", exact(direction), ": ", exit ? exit->collisions : -1,
                   " collisions, throughput ", exact(path.throughput.g));
        if (!exit) return trial.record(kWrong);
        const double grown = static_cast<double>(path.throughput.g) - 1;
        trial.record(in_roundoffs(grown) / static_cast<double>(counts.indirect + 1));
    }
}

constexpr StressTest kTests[] = {
    {"medium/columns",
     "the integral of a cloud's density along a ray, and the distance to a part of it, at scales 1e-6 to 1e6, from "
     "sides and corners, along axes",
     8, "2^-24 of its terms",
     "8 roundings of coordinates and of their interpolation; judged by double, plane by plane", "64 steps", 20'000,
     trials_of<columns>},
    {"medium/collisions",
     "the sum of a path's throughput never grows in fog and clouds, of depths from 1e-6 to 1e6, and is kept where they "
     "absorb nothing",
     8, "2^-24", "8 roundings; the density is the mean over the channels (Wilkie et al. 2014, §3)", "", 50'000,
     trials_of<collisions>},
    {"medium/walks",
     "no path is lost in a closed solid that absorbs nothing, and each keeps its throughput: spheres, boxes, meshes, "
     "with and without another inside or across, at scales 1e-6 to 1e6, up to 100 sizes from the origin",
     4, "2^-24 per ray", "4 roundings for each ray of the walk", "", 2'000, trials_of<walks>},
};

} // namespace

std::span<const StressTest> medium_tests() { return kTests; }

} // namespace duet::compare
