// Interpolates irradiance between the eight probes around each point. Probes that the point does not see have a small
// weight (Majercik et al. 2019, §5.2).
#include "raster/probes/irradiance_probes.h"

#include "raster/geometry/lane_math.h"
#include "raster/lighting/spherical_harmonics.h"
#include "raster/visibility/shader.h"

#include <algorithm>
#include <limits>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;

/// Points are moved off their surface and toward the viewer before their visibility is tested, because the distance
/// maps are coarse (Majercik et al. 2021, "Scaling Probe-Based Real-Time Dynamic Global Illumination for Production",
/// §4.1). The constants are fractions of the distance between probes. A move along the normal alone does not lead away
/// from a corner, such as that of a wall with a roof, and light would leak in there.
constexpr float kNormalBias = 0.2f, kViewBias = 0.3f;
/// Points beyond the outermost probes are interpolated at a point this fraction of a cell further in, because the
/// outermost probes may be hidden.
constexpr float kInset = 0.02f;
/// These are the weights of probes inside objects, and of probes that a point does not see. Where such probes are the
/// nearest, the irradiance changes over this fraction of a cell.
constexpr float kInside = 1e-2f, kHidden = 3e-3f;
constexpr float kBlind = 0.05f; ///< where the weights add up to less, the point may have been moved into an object
constexpr float kBehind = 0.05f; ///< added to each weight, so that probes behind the surface have some, too

/// Returns the weight of a probe with these distances at points with the normals n, by its visibility from there.
Floats visibility(const OctahedralMap& distances, const Vec3s& to_probe, const Vec3s& n) {
    if (distances.empty()) return Floats(kInside);
    const Floats squared = max(dot(to_probe, to_probe), Floats(1e-20f)), over = inverse_sqrt(squared);
    const Floats distance = squared * over, cosine = dot(to_probe, n) * over, half(0.5f), one(1.0f);
    // Probes behind the surface have less weight. The transition is smooth, so that no edge shows (Majercik et al.
    // 2019, §5.2).
    const Floats front = (cosine + one) * half;
    const auto [mean, mean_square] = distances.at<2>(-to_probe);
    const Floats variance = max(mean_square - mean * mean, Floats(1e-4f) * mean_square);
    const Floats behind = max(distance - mean, Floats(0.0f));
    const Floats seen = variance / (variance + behind * behind); // upper bound by Chebyshev's inequality
    return (front * front + Floats(kBehind)) * (seen * seen * seen + Floats(kHidden));
}

} // namespace

/// Returns the weight of the sky's irradiance at a distance from the grid, in cells.
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

/// Locates a batch of points between the probes.
struct IrradianceProbes::Place {
    Ints cells;              ///< the first probe of each cell
    std::array<Floats, 3> f; ///< position in the cell
    Floats beyond;           ///< distance from the grid, in cells

    /// Returns the weight of a corner of the cell in the linear interpolation.
    Floats weight(unsigned corner) const {
        const auto part = [&](std::size_t axis) { return corner >> axis & 1 ? f[axis] : Floats(1.0f) - f[axis]; };
        return part(0) * part(1) * part(2);
    }
};

IrradianceProbes::Place IrradianceProbes::place_of(const Vec3d& eye, const Vec3s& p) const {
    const Vec3 first(origin_ - eye), step(step_);
    Place result{Ints(0), {}, Floats(0.0f)};
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
    result.cells = cell[0] + Ints(size_[0]) * (cell[1] + Ints(size_[1]) * cell[2]);
    return result;
}

RgbT<Floats> IrradianceProbes::mean_radiance(const Vec3d& eye, const Vec3s& p, const AmbientLight& sky) const {
    const Place place = place_of(eye, p);
    RgbT<Floats> result(Floats(0.0f));
    for_each_value(place.cells, lane_bits(Mask(true)), [&](std::int32_t first, const Mask& own) {
        RgbT<Floats> sum(Floats(0.0f));
        for (unsigned i = 0; i < 8; ++i) {
            const Probe& probe = probes_[corner_of(static_cast<std::size_t>(first), i)];
            sum += broadcast<Floats>(probe.irradiance[0]) * place.weight(i);
        }
        result = blend(own, sum, result);
    });
    result *= Floats(kInvPi); // the first harmonic of the irradiance is π times the mean radiance
    const Floats share = sky_share(place.beyond);
    if (!xsimd::any(share > Floats(0.0f))) return result;
    const RgbT<Floats> far = sky ? sky(p) * Floats(openness_) : RgbT<Floats>(Floats(0.0f));
    return result + (far - result) * share;
}

namespace {

/// Lowers the weights of probes that fewer than half of the cell's probes see, counted by weight. An example is a probe
/// in the open that a point in a room sees through a window.
void discount_unseen(const std::array<std::uint8_t, 8>& sights, std::array<Floats, 8>& weights) {
    const std::array<Floats, 8> before = weights;
    Floats all(0.0f);
    for (const Floats& weight : before) all += weight;
    const Floats over = Floats(2.0f) / all;
    for (std::size_t i = 0; i < 8; ++i) {
        Floats seen_by(0.0f);
        for (const std::size_t other : SetBits(sights[i])) seen_by += before[other];
        const Floats share = min(seen_by * over, Floats(1.0f)), squared = share * share;
        weights[i] *= squared * squared;
    }
}

} // namespace

IrradianceProbes::Weights IrradianceProbes::weights(const Vec3d& eye, const Vec3s& p, const Vec3s& n,
                                                    const Vec3s& to_viewer, const Mask& mask) const {
    const Place place = place_of(eye, p);
    const auto step = static_cast<float>(std::min({step_.x, step_.y, step_.z}));
    const Floats over = inverse_sqrt(max(dot(to_viewer, to_viewer), Floats(std::numeric_limits<float>::min())));
    const Vec3s free = p + to_viewer * min(Floats(kViewBias * step) * over, Floats(0.5f)),
                above = free + n * Floats(kNormalBias * step);
    Weights result{place.cells, {}, Floats(0.0f), place.beyond};
    for_each_value(place.cells, lane_bits(mask), [&](std::int32_t base, const Mask& own) {
        const auto cell = static_cast<std::size_t>(base);
        std::array<Floats, 8> corners;
        const auto add = [&](const Vec3s& at, const Floats& share) {
            Floats sum(0.0f);
            for (unsigned i = 0; i < 8; ++i) {
                const Probe& probe = probes_[corner_of(cell, i)];
                const Vec3s to_probe = broadcast<Floats>(Vec3(probe.position - eye)) - at;
                const Floats weight = place.weight(i) * visibility(probe.distance, to_probe, n);
                corners[i] += weight * share, sum += weight;
            }
            return sum;
        };
        corners.fill(Floats(0.0f));
        const Floats sight = add(above, Floats(1.0f));
        // The normal may lead into an object just above the surface, where no probe is seen. The way to the viewer
        // leads into none.
        const Floats blind = max(Floats(1.0f) - sight * Floats(1 / kBlind), Floats(0.0f));
        if (xsimd::any(own & (blind > Floats(0.0f)))) add(free, blind);
        if (std::ranges::any_of(sights_[cell], [](std::uint8_t seen) { return seen != 0xff; }))
            discount_unseen(sights_[cell], corners);
        Floats sum(0.0f);
        for (std::size_t i = 0; i < 8; ++i) {
            result.corners[i] = xsimd::select(own, corners[i], result.corners[i]);
            sum += corners[i];
        }
        result.sum = xsimd::select(own, sum, result.sum);
    });
    return result;
}

RgbT<Floats> IrradianceProbes::irradiance(const Weights& weights, const Vec3s& n, const Mask& mask) const {
    const std::array<Floats, 9> basis = harmonics(n);
    RgbT<Floats> result(Floats(0.0f));
    for_each_value(weights.cells, lane_bits(mask), [&](std::int32_t base, const Mask& own) {
        RgbT<Floats> light(Floats(0.0f));
        for (unsigned i = 0; i < 8; ++i) {
            const Probe& probe = probes_[corner_of(static_cast<std::size_t>(base), i)];
            light += irradiance_at(probe.irradiance, basis) * weights.corners[i];
        }
        const Floats over = Floats(1.0f) / weights.sum;
        result = blend(own, light * over, result);
    });
    return faded_to_sky(result, basis, weights.beyond);
}

RgbT<Floats> IrradianceProbes::irradiance(const Vec3d& eye, const Vec3s& p, const Vec3s& n, const Vec3s& to_viewer,
                                          const Mask& mask) const {
    return irradiance(weights(eye, p, n, to_viewer, mask), n, mask);
}

} // namespace duet::raster
