#include "raster/probes/irradiance_probes.h"

#include "raster/geometry/lane_math.h"
#include "raster/lighting/background.h"
#include "raster/lighting/spherical_harmonics.h"
#include "raster/visibility/shader.h"

#include "common/sampling/hash.h"
#include "common/system/parallel.h"

#include <algorithm>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;

constexpr int kDistanceSide = 16; ///< texels along a side of an octahedral map of distances

constexpr int kSide = 16, kFineSide = 32; ///< pixels along a side of a face of a probe's cube
constexpr int kBatch = static_cast<int>(Floats::size);
static_assert(kSide % kBatch == 0);
/// Probes with fewer bright pixels than this are rendered with kFineSide.
constexpr float kFewestPixels = 64;
constexpr int kMostBounces = 12;
constexpr float kNegligible = 0.01f; ///< fraction of all light; a bounce that adds less is the last one

/// Calls visit for every pixel of a cube of side × side pixels a face whose column is a multiple of `columns`.
template <typename Visit> void for_each_pixel(int side, int columns, const Visit& visit) {
    for (std::size_t face = 0; face < 6; ++face)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; x += columns) visit(ProbeCapture::Pixel{face, x, y});
}

/// Projects the light that arrives at a probe from batches of pixels to the harmonics of the irradiance. The weights of
/// the pixels are the same for all probes of one resolution and are stored in a table.
class Projection {
public:
    explicit Projection(int side) {
        for (auto& face : weights_) face.fill(PlaneFloat(side, side));
        for_each_pixel(side, 1, [&](const ProbeCapture::Pixel& p) {
            const std::array<float, 9> basis = harmonics(ProbeCapture::direction(p, side));
            const float solid_angle = ProbeCapture::solid_angle(p, side);
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
const Projection& projection(int side) {
    static const Projection table(kSide), fine(kFineSide);
    return side == kSide ? table : fine;
}

/// Returns the number of pixels of equal light that have the same ratio of (sum of light)² to (sum of squares) as a
/// capture's pixels (Kish 1965, "Survey Sampling"). It is small if nearly all light comes from a small bright area,
/// whose edges then make a large error. It is infinite if there is no light.
float effective_pixels(const ProbeCapture& capture) {
    Floats sum(0.0f), squares(0.0f);
    for_each_pixel(capture.side(), kBatch, [&](const ProbeCapture::Pixel& p) {
        const RgbT<Floats> color = capture.faces()[p.face].direct.color(p.x, p.y);
        const Floats light = color.r + color.g + color.b;
        sum += light, squares += light * light;
    });
    const float all = xsimd::hadd(squares);
    return all > 0 ? sqr(xsimd::hadd(sum)) / all : kInfinity;
}

/// Returns the sum of all further bounces, as a multiple of the last one, if each adds the same fraction of the one
/// before.
float rest_of_series(float last, float before) {
    const float ratio = before > 0 ? std::clamp(last / before, 0.0f, 0.95f) : 0;
    return ratio / (1 - ratio);
}

} // namespace

float IrradianceProbes::spacing() const { return static_cast<float>(std::max({step_.x, step_.y, step_.z})); }

IrradianceProbes::IrradianceProbes(const RasterSceneData& data, const RasterSceneData& seen,
                                   const RasterSettings& settings) {
    place(data, seen);
    const SolidTest solids(data, seen);
    std::vector<std::unique_ptr<ProbeCapture>> captures(probes_.size());
    parallel_for(probes_.size(), settings.threads, [&](std::size_t i) {
        Vec3d& position = probes_[i].position = grid_point(i);
        if (!move_out_of_solids(solids, position)) return;
        // A probe's pixels are far apart, so almost all lights are near to some of them. The probe averages over all
        // pixels, which removes the noise of choosing few lights.
        constexpr std::size_t kMostLights = 8;
        const ProbeCapture::Selection selection{
            .excluded = data.glass, .sun = false, .lights = {kMostLights, unit_float(high_bits(mix_bits(i)))}};
        for (const int side : {kSide, kFineSide}) {
            captures[i] = std::make_unique<ProbeCapture>(seen, settings, position, side, 0, selection);
            if (effective_pixels(*captures[i]) >= kFewestPixels) break;
        }
        captures[i]->add_fog(seen, settings, {});
    });
    drop_strays(captures);
    find_sights(captures);
    parallel_for(probes_.size(), settings.threads, [&](std::size_t i) {
        if (captures[i]) set_distances(*captures[i], probes_[i]);
    });
    find_sky(data, settings, captures);
    bounce_light(captures, settings.threads);
}

/// Sets the irradiance of all probes. After the direct light, each bounce takes the light of the one before.
void IrradianceProbes::bounce_light(const std::vector<std::unique_ptr<ProbeCapture>>& captures, int threads) {
    std::vector<std::vector<Weights>> weights(probes_.size());
    float added_before = 0;
    for (int k = 0; k <= kMostBounces; ++k) {
        std::vector<IrradianceHarmonics> next(probes_.size());
        parallel_for(probes_.size(), threads, [&](std::size_t i) {
            if (captures[i]) next[i] = gather(*captures[i], k, weights[i]);
        });
        float lit = 0, added = 0; // sum over the probes of the part of its light that this bounce adds
        for (std::size_t i = 0; i < probes_.size(); ++i) {
            const float before = luminance(probes_[i].irradiance[0]), now = luminance(next[i][0]);
            if (captures[i] && now > 0) ++lit, added += (now - before) / now;
        }
        const bool last = added <= kNegligible * lit || k == kMostBounces;
        const float rest = last && k > 1 ? rest_of_series(added, added_before) : 0;
        for (std::size_t i = 0; i < probes_.size(); ++i)
            for (std::size_t c = 0; c < next[i].size(); ++c) {
                Rgb& irradiance = probes_[i].irradiance[c];
                irradiance = next[i][c] + (next[i][c] - irradiance) * rest;
            }
        fill_solids();
        if (last) break;
        added_before = added;
    }
}

/// Finds how much of the environment lights points far beyond the probes. Above open ground with objects, the probes
/// see the environment in at least a quarter of all directions; through the windows of a room, in less than an eighth.
void IrradianceProbes::find_sky(const RasterSceneData& data, const RasterSettings& settings,
                                const std::vector<std::unique_ptr<ProbeCapture>>& captures) {
    if (!shows_environment(data, settings)) return;
    sky_ = data.sky_irradiance;
    float seen = 0, all = 0;
    for (const auto& capture : captures) {
        if (!capture) continue;
        for_each_pixel(capture->side(), 1, [&](const ProbeCapture::Pixel& pixel) {
            const float solid_angle = ProbeCapture::solid_angle(pixel, capture->side());
            all += solid_angle;
            if (capture->distance(pixel) == kInfinity) seen += solid_angle;
        });
    }
    openness_ = all > 0 ? clamp(8 * seen / all - 1, 0.0f, 1.0f) : 0;
}

void IrradianceProbes::set_distances(const ProbeCapture& capture, Probe& probe) const {
    // A point may be interpolated from probes up to a cell's diagonal away. Larger distances make no difference.
    const float farthest = 1.5f * static_cast<float>(length(step_));
    probe.distance = OctahedralMap(kDistanceSide);
    Image<Vec3> sums(kDistanceSide, kDistanceSide); // sums of distance, squared distance and solid angle
    for_each_pixel(capture.side(), 1, [&](const ProbeCapture::Pixel& pixel) {
        const Vec2 at = octahedral(ProbeCapture::direction(pixel, capture.side()));
        const float distance = min(capture.distance(pixel), farthest),
                    weight = ProbeCapture::solid_angle(pixel, capture.side());
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

/// Returns the harmonics of the irradiance at a probe. The surfaces around it reflect direct light and, after the first
/// bounce, the irradiance of the probes from the previous bounce. The first bounce computes the interpolation weights
/// of the surfaces, and all later bounces reuse them.
IrradianceHarmonics IrradianceProbes::gather(const ProbeCapture& capture, int bounce,
                                             std::vector<Weights>& weights_of_batches) const {
    Projection::Sum sum{};
    std::size_t next = 0;
    const ProbeCapture::Face& first = capture.faces().front();
    const bool hazy = bounce > 0 && !first.haze.empty();
    const Vec3s center{Floats(0.0f), Floats(0.0f), Floats(0.0f)};
    const RgbT<Floats> around = hazy ? mean_radiance(first.gbuffer.projection.eye(), center, {}) : RgbT<Floats>();
    for_each_pixel(capture.side(), kBatch, [&](const ProbeCapture::Pixel& p) {
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
        projection(capture.side()).add(p, light, sum);
    });
    IrradianceHarmonics result;
    for (std::size_t i = 0; i < 9; ++i)
        result[i] = {xsimd::hadd(sum[i].r), xsimd::hadd(sum[i].g), xsimd::hadd(sum[i].b)};
    return result;
}

std::size_t IrradianceProbes::memory_bytes() const {
    if (probes_.empty()) return 0;
    return probes_.size() * (sizeof(Probe) + sizeof(sights_[0]) + probes_.front().distance.memory_bytes());
}

} // namespace duet::raster
