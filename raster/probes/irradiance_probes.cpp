#include "raster/probes/irradiance_probes.h"

#include "raster/geometry/lane_math.h"
#include "raster/lighting/background.h"
#include "raster/lighting/spherical_harmonics.h"
#include "raster/visibility/shader.h"

#include "common/sampling/hash.h"
#include "common/system/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;

constexpr int kDistanceSide = 16; ///< texels of an octahedral map of distances
/// Before their visibility is judged, points are moved off their surface and towards the viewer by these fractions of
/// the distance between probes, as the maps of distances are coarse (Majercik et al. 2021, "Scaling Probe-Based
/// Real-Time Dynamic Global Illumination for Production", §4.1). The normal alone does not lead away from a corner,
/// such as that of a wall with a roof, and light would leak in there.
constexpr float kNormalBias = 0.2f, kViewBias = 0.3f;
/// Points beyond the outermost probes are interpolated where they would be this fraction of a cell further in, since
/// the outermost probes may be hidden.
constexpr float kInset = 0.02f;

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
            for (std::size_t i = 0; i < 9; ++i)
                weights_[p.face][i](p.x, p.y) = basis[i] * static_cast<float>(kIrradianceFactors[i]) * solid_angle;
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

} // namespace

float IrradianceProbes::spacing() const { return static_cast<float>(std::max({step_.x, step_.y, step_.z})); }

IrradianceProbes::IrradianceProbes(const RasterSceneData& data, const RasterSettings& settings) {
    place(data);
    const SolidTest solids(data);
    std::vector<std::unique_ptr<ProbeCapture>> captures(probes_.size());
    parallel_for(probes_.size(), settings.threads, [&](std::size_t i) {
        Vec3d& position = probes_[i].position = grid_point(i);
        if (!move_out_of_solids(solids, position)) return;
        // Pixels of a probe are far apart, so almost all lights are near to some. Its light is a mean over all of them.
        constexpr std::size_t kMostLights = 8;
        const ChosenLights lights{kMostLights, unit_float(high_bits(mix_bits(i)))};
        captures[i] = std::make_unique<ProbeCapture>(data, settings, position, kSide, data.glass, lights);
        captures[i]->add_fog(data, settings, {});
    });
    drop_strays(captures);
    parallel_for(probes_.size(), settings.threads, [&](std::size_t i) {
        if (captures[i]) set_distances(*captures[i], probes_[i]);
    });
    find_sky(data, settings, captures);
    std::vector<std::vector<Weights>> weights(probes_.size());
    for (int k = 0; k <= kBounces; ++k) {
        std::vector<IrradianceHarmonics> next(probes_.size());
        parallel_for(probes_.size(), settings.threads, [&](std::size_t i) {
            if (captures[i]) next[i] = gather(*captures[i], k, weights[i]);
        });
        for (std::size_t i = 0; i < probes_.size(); ++i) probes_[i].irradiance = next[i];
        fill_solids();
    }
}

/// Far points are lit by the environment alone, if the probes see it. Over open ground, with objects about them, they
/// see it in a quarter of all directions or more; through the windows of a room, in less than an eighth.
void IrradianceProbes::find_sky(const RasterSceneData& data, const RasterSettings& settings,
                                const std::vector<std::unique_ptr<ProbeCapture>>& captures) {
    if (!shows_environment(data, settings)) return;
    sky_ = data.sky_irradiance;
    float seen = 0, all = 0;
    for (const auto& capture : captures) {
        if (!capture) continue;
        for_each_pixel(1, [&](const ProbeCapture::Pixel& pixel) {
            const float solid_angle = ProbeCapture::solid_angle(pixel, kSide);
            all += solid_angle;
            if (capture->distance(pixel) == kInfinity) seen += solid_angle;
        });
    }
    openness_ = all > 0 ? clamp(8 * seen / all - 1, 0.0f, 1.0f) : 0;
}

/// Returns how much of the light is the sky's at a distance from the grid in cells.
Floats IrradianceProbes::sky_share(const Floats& cells) {
    constexpr float kNear = 0.5f, kFar = 3; // the region ends half a cell beyond its outermost probes
    return clamp((cells - Floats(kNear)) * Floats(1 / (kFar - kNear)), Floats(0.0f), Floats(1.0f));
}

RgbT<Floats> IrradianceProbes::faded_to_sky(const RgbT<Floats>& irradiance, const std::array<Floats, 9>& basis,
                                            const Floats& cells) const {
    const Floats fade = min(sky_share(cells), Floats(openness_));
    if (!xsimd::any(fade > Floats(0.0f))) return irradiance;
    return irradiance + (irradiance_at(sky_, basis) - irradiance) * fade;
}

void IrradianceProbes::set_distances(const ProbeCapture& capture, Probe& probe) const {
    // A point may be interpolated from probes up to a cell's diagonal away; beyond, distances make no difference.
    const float farthest = 1.5f * static_cast<float>(length(step_));
    probe.distance = OctahedralMap(kDistanceSide);
    Image<Vec3> sums(kDistanceSide, kDistanceSide); // of distance, its square, and solid angle
    for_each_pixel(1, [&](const ProbeCapture::Pixel& pixel) {
        const Vec2 at = octahedral(ProbeCapture::direction(pixel, kSide));
        const float distance = min(capture.distance(pixel), farthest), weight = ProbeCapture::solid_angle(pixel, kSide);
        sums(cell_of(at.x, kDistanceSide), cell_of(at.y, kDistanceSide)) +=
            Vec3(distance, distance * distance, 1) * weight;
    });
    for (int y = 0; y < kDistanceSide; ++y)
        for (int x = 0; x < kDistanceSide; ++x) {
            const Vec3 sum = sums(x, y);
            probe.distance.texel(x, y) = {sum.x / sum.z, sum.y / sum.z, 0, 0};
        }
    probe.distance.finish();
}

/// Holds how much the eight probes about each of a batch of points count.
struct IrradianceProbes::Weights {
    alignas(64) std::array<std::int32_t, Ints::size> cells; ///< the first probe of each cell
    std::array<Floats, 8> corners;                          ///< by corner of the cell: x + 2y + 4z
    Floats sum;
    Floats beyond; ///< distance from the grid in cells
};

/// Returns the harmonics of the irradiance at a probe: of the light that the surfaces around it reflect of what the
/// lights emit, and, after the first bounce, of what the probes held after the last one. The first bounce sets the
/// weights with which the surfaces get light from the probes, and all later ones use them.
IrradianceHarmonics IrradianceProbes::gather(const ProbeCapture& capture, int bounce,
                                             std::vector<Weights>& weights_of_batches) const {
    Projection::Sum sum{};
    std::size_t next = 0;
    const ProbeCapture::Face& first = capture.faces().front();
    const bool hazy = bounce > 0 && !first.haze.empty();
    const Vec3s center{Floats(0.0f), Floats(0.0f), Floats(0.0f)};
    const RgbT<Floats> around = hazy ? mean_radiance(first.gbuffer.projection.eye(), center, {}) : RgbT<Floats>();
    for_each_pixel(kBatch, [&](const ProbeCapture::Pixel& p) {
        const ProbeCapture::Face& face = capture.faces()[p.face];
        RgbT<Floats> light = face.direct.color(p.x, p.y);
        const Mask seen = face.gbuffer.visible(p.x, p.y);
        if (bounce > 0 && xsimd::any(seen)) {
            const GBuffer& g = face.gbuffer;
            const RgbT<Floats> albedo = g.diffuse.color(p.x, p.y) + g.specular.color(p.x, p.y);
            const Vec3s point = g.points(p.x, p.y), n = g.normal.vector(p.x, p.y);
            if (bounce == 1)
                weights_of_batches.push_back(
                    weights(g.projection.eye(), point, n, to_viewer(g.projection, point), seen));
            const RgbT<Floats> arriving = irradiance(weights_of_batches[next++], n, seen);
            light += blend(seen, albedo * arriving * Floats(kInvPi), RgbT<Floats>(Floats(0.0f)));
        }
        if (hazy) light += face.haze.color(p.x, p.y) * around;
        projection().add(p, light, sum);
    });
    IrradianceHarmonics result;
    for (std::size_t i = 0; i < 9; ++i)
        result[i] = {xsimd::hadd(sum[i].r), xsimd::hadd(sum[i].g), xsimd::hadd(sum[i].b)};
    return result;
}

namespace {

/// Weights of probes inside objects, and of those that a point does not see. Where they are the nearest, light changes
/// over this fraction of a cell.
constexpr float kInside = 1e-2f, kHidden = 3e-3f;
constexpr float kBehind = 0.05f; ///< added to the weight of a probe, so that none behind the surface has 0

/// Returns how much a probe with these distances counts at points with the normals n that may not see it.
Floats visibility(const OctahedralMap& distances, const Vec3s& to_probe, const Vec3s& n) {
    if (distances.empty()) return Floats(kInside);
    const Floats squared = max(dot(to_probe, to_probe), Floats(1e-20f)), over = inverse_sqrt(squared);
    const Floats distance = squared * over, cosine = dot(to_probe, n) * over, half(0.5f), one(1.0f);
    // Probes behind the surface count less, but smoothly, so that no edge shows (Majercik et al. 2019, §5.2).
    const Floats front = (cosine + one) * half;
    const auto [mean, mean_square] = distances.at<2>(-to_probe);
    const Floats variance = max(mean_square - mean * mean, Floats(1e-4f) * mean_square);
    const Floats behind = max(distance - mean, Floats(0.0f));
    const Floats seen = variance / (variance + behind * behind); // Chebyshev's inequality
    return (front * front + Floats(kBehind)) * (seen * seen * seen + Floats(kHidden));
}

} // namespace

/// Says between which probes a batch of points lies.
struct IrradianceProbes::Place {
    alignas(64) std::array<std::int32_t, Ints::size> cells; ///< the first probe of each cell
    std::array<Floats, 3> f;                                ///< position in the cell
    Floats beyond;                                          ///< distance from the grid in cells

    /// Returns the weight of a corner of the cell, x + 2y + 4z, in the linear interpolation.
    Floats weight(int corner) const {
        const auto part = [&](std::size_t axis) { return corner >> axis & 1 ? f[axis] : Floats(1.0f) - f[axis]; };
        return part(0) * part(1) * part(2);
    }
};

IrradianceProbes::Place IrradianceProbes::place_of(const Vec3d& eye, const Vec3s& p) const {
    const Vec3 first(origin_ - eye), step(step_);
    Place result{{}, {}, Floats(0.0f)};
    std::array<Ints, 3> cell;
    const std::array<Floats, 3> at{p.x, p.y, p.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Floats unclamped = (at[axis] - Floats(first[axis])) * Floats(1 / step[axis]);
        const Floats g =
            clamp(unclamped, Floats(kInset), Floats(static_cast<float>(size_[axis] - 1) - kInset));
        result.beyond = max(result.beyond, abs(unclamped - g));
        cell[axis] = xsimd::min(truncated(g), Ints(size_[axis] - 2));
        result.f[axis] = g - xsimd::batch_cast<float>(cell[axis]);
    }
    (cell[0] + Ints(size_[0]) * (cell[1] + Ints(size_[1]) * cell[2])).store_aligned(result.cells.data());
    return result;
}

/// Returns the probe at a corner, x + 2y + 4z, of the cell with this first probe.
std::size_t IrradianceProbes::probe_at(std::int32_t first, int corner) const {
    return static_cast<std::size_t>(first + (corner & 1) + size_[0] * ((corner >> 1 & 1) + size_[1] * (corner >> 2)));
}

/// Calls use(first, own) for the cells in which the given lanes lie: the cell's first probe, and its lanes. Cells are
/// large, so a batch mostly lies in one.
template <typename Cells, typename Use> void for_each_cell(const Cells& cells, std::uint32_t left, const Use& use) {
    while (left != 0) {
        const std::int32_t first = cells[static_cast<std::size_t>(std::countr_zero(left))];
        const auto own = xsimd::bool_cast(Ints::load_aligned(cells.data()) == Ints(first));
        left &= ~lane_bits(own);
        use(first, own);
    }
}

RgbT<Floats> IrradianceProbes::mean_radiance(const Vec3d& eye, const Vec3s& p, const AmbientLight& sky) const {
    const Place place = place_of(eye, p);
    RgbT<Floats> result(Floats(0.0f));
    for_each_cell(place.cells, lane_bits(Mask(true)), [&](std::int32_t first, const Mask& own) {
        RgbT<Floats> sum(Floats(0.0f));
        for (int corner = 0; corner < 8; ++corner)
            sum += broadcast<Floats>(probes_[probe_at(first, corner)].irradiance[0]) * place.weight(corner);
        result = blend(own, sum, result);
    });
    result *= Floats(kInvPi); // the first harmonic of the irradiance is π times the mean radiance
    const Floats share = sky_share(place.beyond);
    if (!xsimd::any(share > Floats(0.0f))) return result;
    const RgbT<Floats> far = sky ? sky(p) * Floats(openness_) : RgbT<Floats>(Floats(0.0f));
    return result + (far - result) * share;
}

/// Returns by how much a point is moved for the test of what it sees: at most half of the way to the viewer.
Vec3s IrradianceProbes::bias(const Vec3s& n, const Vec3s& to_viewer) const {
    const auto step = static_cast<float>(std::min({step_.x, step_.y, step_.z}));
    const Floats over = inverse_sqrt(max(dot(to_viewer, to_viewer), Floats(std::numeric_limits<float>::min())));
    return n * Floats(kNormalBias * step) + to_viewer * min(Floats(kViewBias * step) * over, Floats(0.5f));
}

IrradianceProbes::Weights IrradianceProbes::weights(const Vec3d& eye, const Vec3s& p, const Vec3s& n,
                                                    const Vec3s& to_viewer, const Mask& mask) const {
    const Place place = place_of(eye, p);
    const Vec3s at = p + bias(n, to_viewer);
    Weights result{place.cells, {}, Floats(0.0f), place.beyond};
    for_each_cell(place.cells, lane_bits(mask), [&](std::int32_t base, const Mask& own) {
        Floats sum(0.0f);
        for (int corner = 0; corner < 8; ++corner) {
            const Probe& probe = probes_[probe_at(base, corner)];
            const Vec3s to_probe = broadcast<Floats>(Vec3(probe.position - eye)) - at;
            const Floats weight = place.weight(corner) * visibility(probe.distance, to_probe, n);
            Floats& lanes = result.corners[static_cast<std::size_t>(corner)];
            lanes = xsimd::select(own, weight, lanes);
            sum += weight;
        }
        result.sum = xsimd::select(own, sum, result.sum);
    });
    return result;
}

RgbT<Floats> IrradianceProbes::irradiance(const Weights& weights, const Vec3s& n, const Mask& mask) const {
    const std::array<Floats, 9> basis = harmonics(n);
    RgbT<Floats> result(Floats(0.0f));
    for_each_cell(weights.cells, lane_bits(mask), [&](std::int32_t base, const Mask& own) {
        RgbT<Floats> light(Floats(0.0f));
        for (int corner = 0; corner < 8; ++corner)
            light += irradiance_at(probes_[probe_at(base, corner)].irradiance, basis) *
                     weights.corners[static_cast<std::size_t>(corner)];
        const Floats over = Floats(1.0f) / weights.sum;
        result = blend(own, light * over, result);
    });
    return faded_to_sky(result, basis, weights.beyond);
}

RgbT<Floats> IrradianceProbes::irradiance(const Vec3d& eye, const Vec3s& p, const Vec3s& n, const Vec3s& to_viewer,
                                          const Mask& mask) const {
    return irradiance(weights(eye, p, n, to_viewer, mask), n, mask);
}

std::size_t IrradianceProbes::memory_bytes() const {
    return probes_.empty() ? 0 : probes_.size() * (sizeof(Probe) + probes_.front().distance.memory_bytes());
}

} // namespace duet::raster
