#include "raster/probes/irradiance_probes.h"

#include "raster/geometry/lane_math.h"
#include "raster/visibility/shader.h"

#include "common/system/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;

/// The time to render probes grows with their number times the triangles. These bounds keep it within about a second.
constexpr double kMostTriangles = 1e8;
constexpr int kMostProbes = 512, kFewestProbes = 27;
constexpr int kDistanceSide = 16; ///< texels of an octahedral map of distances
/// Points are lifted off their surface by this fraction of the distance between probes before their visibility is
/// judged, as the maps of distances are coarse (Majercik et al., §5.2).
constexpr float kBias = 0.4f;
/// Points beyond the outermost probes are interpolated where they would be this fraction of a cell further in, since
/// the outermost probes may be hidden.
constexpr float kInset = 0.02f;

/// The polynomials of the real spherical harmonics of orders 0, 1 and 2, without constant factors (Ramamoorthi and
/// Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps", eq. 3).
template <typename T> std::array<T, 9> harmonics(const Vec3T<T>& w) {
    return {T(1),      w.y,       w.z, w.x, w.x * w.y, w.y * w.z, T(3) * w.z * w.z - T(1), w.x * w.z,
            w.x * w.x - w.y * w.y};
}
/// For each harmonic, the square of its constant factor times that of the clamped cosine (eq. 8): what projection and
/// evaluation apply together.
constexpr std::array<float, 9> kFactors = [] {
    constexpr std::array<double, 9> constants = {0.28209479177387814, 0.4886025119029199,  0.4886025119029199,
                                                 0.4886025119029199,  1.0925484305920792,  1.0925484305920792,
                                                 0.31539156525252005, 1.0925484305920792,  0.5462742152960396};
    std::array<float, 9> result{};
    for (std::size_t i = 0; i < 9; ++i)
        result[i] = static_cast<float>(constants[i] * constants[i] * kPiDouble *
                                       (i == 0 ? 1.0 : i < 4 ? 2.0 / 3 : 0.25));
    return result;
}();

/// Calls visit for all pixels of a probe's cube, in steps of some columns.
template <typename Visit> void for_each_pixel(int columns, const Visit& visit) {
    for (std::size_t face = 0; face < 6; ++face)
        for (int y = 0; y < IrradianceProbes::kSide; ++y)
            for (int x = 0; x < IrradianceProbes::kSide; x += columns) visit(ProbeCapture::Pixel{face, x, y});
}
constexpr int kBatch = static_cast<int>(Floats::size);
static_assert(IrradianceProbes::kSide % kBatch == 0);

/// Projects light that arrives at a probe from batches of pixels to the harmonics of the irradiance. What a pixel
/// counts in a harmonic is the same for all probes, so it stands in a table.
class Projection {
public:
    Projection() {
        for (auto& face : weights_) face.fill(PlaneFloat(IrradianceProbes::kSide, IrradianceProbes::kSide));
        for_each_pixel(1, [&](const ProbeCapture::Pixel& p) {
            const std::array<float, 9> basis = harmonics(ProbeCapture::direction(p, IrradianceProbes::kSide));
            const float solid_angle = ProbeCapture::solid_angle(p, IrradianceProbes::kSide);
            for (std::size_t i = 0; i < 9; ++i) weights_[p.face][i](p.x, p.y) = basis[i] * kFactors[i] * solid_angle;
        });
    }

    using Sum = std::array<RgbT<Floats>, 9>;
    void add(const ProbeCapture::Pixel& first, const RgbT<Floats>& light, Sum& sum) const {
        for (std::size_t i = 0; i < 9; ++i) sum[i] += light * load(weights_[first.face][i], first.x, first.y);
    }

private:
    std::array<std::array<PlaneFloat, 9>, 6> weights_;
};
const Projection& projection() {
    static const Projection table;
    return table;
}

/// Returns the region that probes fill: the scene without what is very large, and not far beyond what its camera looks
/// at. Points outside use the nearest probes.
Box3d region_of(const RasterSceneData& data) {
    const Scene& scene = data.scene;
    const Camera& camera = scene.camera;
    const double view = length(camera.look_at - camera.eye), reach = 2 * view;
    Box3 bounds;
    for (const RasterObject& object : data.objects)
        if (static_cast<double>(length(object.bounds.diagonal())) < 10 * view) bounds.extend(object.bounds);
    if (bounds.empty()) bounds = scene.bounds;
    Box3d box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto low = static_cast<double>(bounds.low[axis]), high = static_cast<double>(bounds.high[axis]);
        box.low[axis] = std::clamp(camera.look_at[axis] - reach, low, high);
        box.high[axis] = std::clamp(camera.look_at[axis] + reach, low, high);
        // A flat scene, too, has room above and below.
        const double least = 0.05 * view, short_of = least - (box.high[axis] - box.low[axis]);
        if (short_of > 0) box.low[axis] -= short_of / 2, box.high[axis] += short_of / 2;
    }
    return box;
}

} // namespace

/// Spreads the probes so that cells are close to cubes. The outermost probes stand half a cell within the region, so
/// that none lies in an outer wall.
void IrradianceProbes::place(const RasterSceneData& data) {
    const Box3d box = region_of(data);
    const Vec3d extent = box.high - box.low;
    const double most = std::clamp(kMostTriangles / (6 * static_cast<double>(data.primitives) + 1e3),
                                   static_cast<double>(kFewestProbes), static_cast<double>(kMostProbes));
    double cell = std::cbrt(extent.x * extent.y * extent.z / most);
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

/// Moves a probe that lies inside an object along an axis, by up to a step. Returns false if a step leads nowhere
/// outside.
bool IrradianceProbes::move_out_of_solids(const SolidTest& solids, Vec3d& position) const {
    if (!solids.inside(position)) return true;
    std::vector<Vec3d> steps; // that lead outside
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

float IrradianceProbes::spacing() const { return static_cast<float>(std::max({step_.x, step_.y, step_.z})); }

IrradianceProbes::IrradianceProbes(const RasterSceneData& data, const RasterSettings& settings) {
    place(data);
    const SolidTest solids(data);
    std::vector<std::unique_ptr<ProbeCapture>> captures(probes_.size());
    parallel_for(probes_.size(), settings.threads, [&](std::size_t i) {
        Vec3d& position = probes_[i].position = grid_point(i);
        if (!move_out_of_solids(solids, position)) return;
        captures[i] = std::make_unique<ProbeCapture>(data, settings, position, kSide, data.glass);
        set_distances(*captures[i], probes_[i]);
    });
    for (int k = 0; k <= kBounces; ++k) {
        std::vector<Harmonics> next(probes_.size());
        parallel_for(probes_.size(), settings.threads, [&](std::size_t i) {
            if (captures[i]) next[i] = gather(*captures[i], k);
        });
        for (std::size_t i = 0; i < probes_.size(); ++i) probes_[i].irradiance = next[i];
        fill_solids();
    }
}

/// Gives probes inside objects the mean irradiance of their neighbors, from the surfaces inwards. They count where a
/// point sees no other probe.
void IrradianceProbes::fill_solids() {
    std::vector<bool> filled(probes_.size());
    for (std::size_t i = 0; i < probes_.size(); ++i) filled[i] = !probes_[i].distance.empty();
    for (bool any = true; any;) {
        any = false;
        const std::vector<bool> before = filled;
        for (std::size_t i = 0; i < probes_.size(); ++i) {
            if (before[i]) continue;
            Harmonics sum{};
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

/// Calls visit for the up to 26 probes of the cells about a probe.
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

void IrradianceProbes::set_distances(const ProbeCapture& capture, Probe& probe) const {
    // A point may be interpolated from probes up to a cell's diagonal away; beyond, distances make no difference.
    const float farthest = 1.5f * static_cast<float>(length(step_));
    probe.distance = OctahedralMap(kDistanceSide);
    Image<Vec3> sums(kDistanceSide, kDistanceSide); // of distance, its square, and solid angle
    for_each_pixel(1, [&](const ProbeCapture::Pixel& pixel) {
        const Vec2 at = octahedral(ProbeCapture::direction(pixel, kSide));
        const auto cell = [](float v) {
            return std::clamp(static_cast<int>((v + 1) * 0.5f * static_cast<float>(kDistanceSide)), 0,
                              kDistanceSide - 1);
        };
        const float distance = min(capture.distance(pixel), farthest), weight = ProbeCapture::solid_angle(pixel, kSide);
        sums(cell(at.x), cell(at.y)) += Vec3(distance, distance * distance, 1) * weight;
    });
    for (int y = 0; y < kDistanceSide; ++y)
        for (int x = 0; x < kDistanceSide; ++x) {
            const Vec3 sum = sums(x, y);
            probe.distance.texel(x, y) = {sum.x / sum.z, sum.y / sum.z, 0, 0};
        }
    probe.distance.finish();
}

/// Returns the harmonics of the irradiance at a probe: of the light that the surfaces around it reflect of what the
/// lights emit, and, after the first bounce, of what the probes held after the last one.
IrradianceProbes::Harmonics IrradianceProbes::gather(const ProbeCapture& capture, int bounce) const {
    Projection::Sum sum{};
    for_each_pixel(kBatch, [&](const ProbeCapture::Pixel& p) {
        const ProbeCapture::Face& face = capture.faces()[p.face];
        RgbT<Floats> light = face.direct.color(p.x, p.y);
        const Mask seen = face.gbuffer.visible(p.x, p.y);
        if (bounce > 0 && xsimd::any(seen)) {
            const GBuffer& g = face.gbuffer;
            const RgbT<Floats> albedo = g.diffuse.color(p.x, p.y) + g.specular.color(p.x, p.y);
            const RgbT<Floats> arriving =
                irradiance(g.projection.eye(), g.points(p.x, p.y), g.normal.vector(p.x, p.y), seen);
            light += blend(seen, albedo * arriving * Floats(kInvPi), RgbT<Floats>(Floats(0.0f)));
        }
        projection().add(p, light, sum);
    });
    Harmonics result;
    for (std::size_t i = 0; i < 9; ++i)
        result[i] = {xsimd::hadd(sum[i].r), xsimd::hadd(sum[i].g), xsimd::hadd(sum[i].b)};
    return result;
}

/// The weight of one of the eight probes about a batch of points, and its irradiance.
struct IrradianceProbes::Corner {
    Floats weight;
    RgbT<Floats> irradiance;

    Corner(const Probe& probe, const Vec3s& to_probe, const Vec3s& n, const std::array<Floats, 9>& basis,
           const Floats& trilinear) {
        weight = trilinear * (probe.distance.empty() ? Floats(kInside) : visibility(probe, to_probe, n));
        irradiance = RgbT<Floats>(Floats(0.0f));
        for (std::size_t i = 0; i < 9; ++i) irradiance += broadcast<Floats>(probe.irradiance[i]) * basis[i];
        const Floats none(0.0f);
        irradiance = {max(irradiance.r, none), max(irradiance.g, none), max(irradiance.b, none)};
    }

private:
    /// Weights of probes inside objects, and of those that a point does not see. Where they are the nearest, light
    /// changes over this fraction of a cell.
    static constexpr float kInside = 1e-2f, kHidden = 1e-4f;

    static Floats visibility(const Probe& probe, const Vec3s& to_probe, const Vec3s& n) {
        const Floats squared = max(dot(to_probe, to_probe), Floats(1e-20f)), over = inverse_sqrt(squared);
        const Floats distance = squared * over, cosine = dot(to_probe, n) * over, half(0.5f), one(1.0f);
        // Probes behind the surface count less, but smoothly, so that no edge shows (Majercik et al., §5.2).
        const Floats front = (cosine + one) * half;
        const auto [mean, mean_square] = probe.distance.at<2>(-to_probe);
        const Floats variance = max(mean_square - mean * mean, Floats(1e-4f) * mean_square);
        const Floats behind = max(distance - mean, Floats(0.0f));
        const Floats seen = variance / (variance + behind * behind); // Chebyshev's inequality
        return max((front * front + Floats(0.2f)) * seen * seen * seen, Floats(kHidden));
    }
};

RgbT<Floats> IrradianceProbes::irradiance(const Vec3d& eye, const Vec3s& p, const Vec3s& n, const Mask& mask) const {
    const Vec3 first(origin_ - eye), step(step_);
    std::array<Ints, 3> cell;
    std::array<Floats, 3> f;
    const std::array<Floats, 3> at{p.x, p.y, p.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Floats g = clamp((at[axis] - Floats(first[axis])) * Floats(1 / step[axis]), Floats(kInset),
                               Floats(static_cast<float>(size_[axis] - 1) - kInset));
        cell[axis] = xsimd::min(truncated(g), Ints(size_[axis] - 2));
        f[axis] = g - xsimd::batch_cast<float>(cell[axis]);
    }
    alignas(64) std::array<std::int32_t, Ints::size> cells;
    (cell[0] + Ints(size_[0]) * (cell[1] + Ints(size_[1]) * cell[2])).store_aligned(cells.data());
    const std::array<Floats, 9> basis = harmonics(n);
    RgbT<Floats> result(Floats(0.0f));
    // Cells are large, so a batch mostly lies in one.
    for (std::uint32_t left = lane_bits(mask); left != 0;) {
        const std::int32_t base = cells[static_cast<std::size_t>(std::countr_zero(left))];
        const auto own = Ints::load_aligned(cells.data()) == Ints(base);
        left &= ~lane_bits(own);
        Floats sum(0.0f);
        RgbT<Floats> light(Floats(0.0f));
        for (int corner = 0; corner < 8; ++corner) {
            const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
            const auto probe = static_cast<std::size_t>(base + dx + size_[0] * (dy + size_[1] * dz));
            const Vec3 q(probes_[probe].position - eye);
            const float bias = kBias * std::min({step.x, step.y, step.z});
            const auto part = [&](std::size_t axis, int far) { return far ? f[axis] : Floats(1.0f) - f[axis]; };
            const Corner c(probes_[probe],
                           Vec3s{Floats(q.x) - p.x, Floats(q.y) - p.y, Floats(q.z) - p.z} - n * Floats(bias), n, basis,
                           part(0, dx) * part(1, dy) * part(2, dz));
            sum += c.weight;
            light += c.irradiance * c.weight;
        }
        const Floats over = Floats(1.0f) / sum;
        const auto lanes = xsimd::bool_cast(own);
        result = {xsimd::select(lanes, light.r * over, result.r), xsimd::select(lanes, light.g * over, result.g),
                  xsimd::select(lanes, light.b * over, result.b)};
    }
    return result;
}

std::size_t IrradianceProbes::memory_bytes() const {
    return probes_.empty() ? 0 : probes_.size() * (sizeof(Probe) + probes_.front().distance.memory_bytes());
}

} // namespace duet::raster
