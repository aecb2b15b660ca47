// Places the irradiance probes of a scene.
#include "raster/prepare_limits.h"
#include "raster/probes/irradiance_probes.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// The time to render probes is proportional to their number times that of the triangles. These bounds keep it within
/// about a second.
constexpr double kMostTriangles = 1e8;
constexpr int kMostProbes = 512, kFewestProbes = 27;
/// This is the detail that probes show, as a fraction of the distance between them. It is a little less than the width
/// of a pixel at the next probe, 1/8 of the distance.
constexpr double kDetail = 0.1;

/// Returns the region that probes fill: the scene without very large objects, and not far beyond the camera's target.
/// Points near the region use the nearest probes.
Box3d region_of(const RasterSceneData& data) {
    const Scene& scene = data.scene;
    const Camera& camera = scene.camera;
    double view = length(camera.look_at - camera.eye);
    if (camera.projection == Camera::Projection::kOrthographic) view = std::max(view, camera.height);
    const double reach = 2 * view;
    Box3 bounds;
    for (const RasterObject& object : data.objects)
        if (static_cast<double>(length(object.bounds.diagonal())) < 10 * view) bounds.extend(object.bounds);
    if (bounds.empty()) bounds = scene.bounds;
    Box3d box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto low = static_cast<double>(bounds.low[axis]), high = static_cast<double>(bounds.high[axis]);
        box.low[axis] = std::clamp(camera.look_at[axis] - reach, low, high);
        box.high[axis] = std::clamp(camera.look_at[axis] + reach, low, high);
        // A flat scene needs room above and below, too.
        const double least = 0.05 * view, short_of = least - (box.high[axis] - box.low[axis]);
        if (short_of > 0) box.low[axis] -= short_of / 2, box.high[axis] += short_of / 2;
    }
    return box;
}

int most_probes(const Scene& scene) {
    return std::max(PrepareLimits(scene).irradiance_probes(kMostProbes), kFewestProbes);
}

/// Returns the number of probes that so many primitives allow, up to most_probes.
double probe_count(std::int64_t primitives, int most) {
    return std::clamp(kMostTriangles / (6 * static_cast<double>(primitives) + 1e3), static_cast<double>(kFewestProbes),
                      static_cast<double>(most));
}

/// Returns the spacing of so many probes.
double spacing_of(const Vec3d& extent, double probes) { return std::cbrt(extent.x * extent.y * extent.z / probes); }

} // namespace

double IrradianceProbes::detail(const RasterSceneData& data) {
    const int most = most_probes(data.scene);
    if (probe_count(data.primitives, most) == most) return 0;
    const Box3d box = region_of(data);
    return kDetail * spacing_of(box.high - box.low, most);
}

/// Spaces the probes so that cells are close to cubes. The outermost probes lie half a cell within the region, so that
/// none is in an outer wall.
void IrradianceProbes::place(const RasterSceneData& data, const RasterSceneData& seen) {
    const Box3d box = region_of(data);
    const Vec3d extent = box.high - box.low;
    const double most = probe_count(seen.primitives, most_probes(data.scene));
    double cell = spacing_of(extent, most);
    const auto count = [&](std::size_t axis) {
        return std::clamp(static_cast<int>(std::lround(extent[axis] / cell)), 2, 64);
    };
    while (count(0) * count(1) * count(2) > static_cast<int>(1.2 * most)) cell *= 1.1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        size_[axis] = count(axis);
        step_[axis] = extent[axis] / size_[axis];
        origin_[axis] = box.low[axis] + step_[axis] / 2;
    }
    probes_.resize(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]));
}

Vec3d IrradianceProbes::grid_point(std::size_t probe) const {
    const auto i = static_cast<int>(probe);
    return origin_ + Vec3d(step_.x * (i % size_[0]), step_.y * (i / size_[0] % size_[1]),
                           step_.z * (i / (size_[0] * size_[1])));
}

/// Moves a probe that lies inside an object along an axis, by up to one grid step. Returns false if no step leads
/// outside.
bool IrradianceProbes::move_out_of_solids(const SolidTest& solids, Vec3d& position) const {
    if (!solids.inside(position)) return true;
    std::vector<Vec3d> steps; // steps that lead outside
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double side : {1.0, -1.0}) {
            Vec3d step;
            step[axis] = side * step_[axis];
            if (!solids.inside(position + step)) steps.push_back(step);
        }
    for (const double part : {0.25, 0.5, 0.75, 1.0})
        for (const Vec3d& step : steps)
            if (part == 1 || !solids.inside(position + step * part)) {
                position += step * part;
                return true;
            }
    return false;
}

/// Returns whether no surface hides the probe `to` from the probe `from`. `capture` is that of `from`.
bool IrradianceProbes::sees(const ProbeCapture& capture, std::size_t from, std::size_t to) const {
    constexpr float kSeen = 0.95f; // fraction of the distance; below 1, because pixels are coarse
    const Vec3 between(probes_[to].position - probes_[from].position);
    const float distance = length(between); // 0 if a probe was moved onto another
    return !(distance > 0) || capture.distance(capture.pixel(between)) > kSeen * distance;
}

/// Removes probes that were moved beyond other surfaces, such as the ground. A probe stays if a chain of neighbors,
/// each visible from the one before, connects it to a probe on the grid.
void IrradianceProbes::drop_strays(std::vector<std::unique_ptr<ProbeCapture>>& captures) const {
    std::vector<bool> connected(probes_.size());
    std::vector<std::size_t> next;
    const auto connect = [&](std::size_t i) { connected[i] = true, next.push_back(i); };
    for (std::size_t i = 0; i < probes_.size(); ++i)
        if (captures[i] && probes_[i].position == grid_point(i)) connect(i);
    if (next.empty()) return; // an object fills the grid
    while (!next.empty()) {
        const std::size_t from = next.back();
        next.pop_back();
        for_each_neighbor(from, [&](std::size_t i) {
            if (!connected[i] && captures[i] && sees(*captures[from], from, i)) connect(i);
        });
    }
    for (std::size_t i = 0; i < probes_.size(); ++i)
        if (!connected[i]) captures[i].reset();
}

std::size_t IrradianceProbes::corner_of(std::size_t cell, unsigned corner) const {
    const auto row = static_cast<std::size_t>(size_[0]), layer = row * static_cast<std::size_t>(size_[1]);
    return cell + (corner & 1) + row * (corner >> 1 & 1) + layer * (corner >> 2);
}

/// Finds which probes of each cell see each other. Probes inside objects count as seeing all others and being seen by
/// them.
void IrradianceProbes::find_sights(const std::vector<std::unique_ptr<ProbeCapture>>& captures) {
    sights_.assign(probes_.size(), {});
    for (std::size_t cell = 0; corner_of(cell, 7) < probes_.size(); ++cell)
        for (unsigned a = 0; a < 8; ++a)
            for (unsigned b = 0; b < 8; ++b) {
                const std::size_t from = corner_of(cell, a), to = corner_of(cell, b);
                if (!captures[from] || !captures[to] || sees(*captures[from], from, to))
                    sights_[cell][b] = static_cast<std::uint8_t>(sights_[cell][b] | 1u << a);
            }
}

/// Gives probes inside objects the mean irradiance of their neighbors, from the surfaces inwards. Such probes have
/// weight only where a point sees no other probe.
void IrradianceProbes::fill_solids() {
    std::vector<bool> filled(probes_.size());
    for (std::size_t i = 0; i < probes_.size(); ++i) filled[i] = !probes_[i].distance.empty();
    for (bool any = true; any;) {
        any = false;
        const std::vector<bool> before = filled;
        for (std::size_t i = 0; i < probes_.size(); ++i) {
            if (before[i]) continue;
            IrradianceHarmonics sum{};
            float count = 0;
            for_each_neighbor(i, [&](std::size_t neighbor) {
                if (!before[neighbor]) return;
                for (std::size_t c = 0; c < 9; ++c) sum[c] += probes_[neighbor].irradiance[c];
                ++count;
            });
            if (count == 0) continue;
            for (std::size_t c = 0; c < 9; ++c) probes_[i].irradiance[c] = sum[c] / count;
            filled[i] = any = true;
        }
    }
}

/// Calls visit for the neighbors of a probe, up to 26.
template <typename Visit> void IrradianceProbes::for_each_neighbor(std::size_t probe, const Visit& visit) const {
    const auto i = static_cast<int>(probe);
    const std::array<int, 3> at{i % size_[0], i / size_[0] % size_[1], i / (size_[0] * size_[1])};
    const auto range = [&](std::size_t axis) {
        return std::pair(std::max(at[axis] - 1, 0), std::min(at[axis] + 1, size_[axis] - 1));
    };
    const auto [x0, x1] = range(0);
    const auto [y0, y1] = range(1);
    const auto [z0, z1] = range(2);
    for (int z = z0; z <= z1; ++z)
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x)
                if (const int n = x + size_[0] * (y + size_[1] * z); n != i) visit(static_cast<std::size_t>(n));
}

} // namespace duet::raster
