#include "raster/lighting/reflections.h"

#include "raster/lighting/specular_lobe.h"
#include "raster/probes/reflection_probes.h"

#include "common/material/metal.h"

#include <bit>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;
using Rgbs = RgbT<Floats>;

/// Lobes narrower than this GGX width show the image's own pixels; wider ones would need them blurred.
constexpr float kSharpest = 0.02f;
/// A pixel shows a point if their depths differ by less than this fraction.
constexpr float kDepthTolerance = 0.02f;

Rgbs blend(const Mask& where, const Rgbs& a, const Rgbs& b) {
    return {xsimd::select(where, a.r, b.r), xsimd::select(where, a.g, b.g), xsimd::select(where, a.b, b.b)};
}

/// Returns the fraction of uniform light that a lobe reflects to the viewer, all scattering included. A mirror's is
/// Schlick's term.
Rgbs albedo(const LobeTables& tables, const Rgbs& normal, const Floats& alpha, const Floats& cosine) {
    const Floats one(1.0f), grazing = one - cosine, square = grazing * grazing;
    const Mask mirror = alpha < Floats(MetalBsdf::kSmoothAlpha);
    const Floats energy = xsimd::select(mirror, one, tables.energy),
                 share = xsimd::select(mirror, square * square * grazing, tables.share);
    const auto channel = [&](const Floats& f0) {
        const Floats once = energy * (f0 + (one - f0) * share);
        // Light scattered more than once (ggx_multiple in common/material/ggx_albedo.h, times the lost fractions).
        const Floats mean = f0 + (one - f0) * Floats(1.0f / 21);
        return once + mean * mean * (one - tables.mean_lost) / (one - mean * tables.mean_lost) * (one - energy);
    };
    return {channel(normal.r), channel(normal.g), channel(normal.b)};
}

/// Looks up the surroundings of one batch of pixels.
class Surroundings {
public:
    Surroundings(const PreparedData& data, const GBuffer& gbuffer, const ReflectionProbes* probes, const Planes3& image,
                 int x, int y)
        : data_(data), gbuffer_(gbuffer), probes_(probes), image_(image), p_(gbuffer.points(x, y)),
          n_(gbuffer.normal.vector(x, y)) {
        load(gbuffer.object, x, y).store_aligned(objects_.data());
    }

    /// Returns what arrives from about the unit direction w, filtered by a lobe of width alpha.
    Rgbs operator()(const Vec3s& w, const Floats& alpha, const Mask& lanes) const {
        const Mask mirror = alpha < Floats(MetalBsdf::kSmoothAlpha);
        const Vec3s axis = dominant_direction(n_, w, alpha);
        if (probes_ == nullptr) return look_up(*data_.environment_map, w, axis, alpha, mirror);
        Rgbs result(Floats(0.0f));
        for (std::uint32_t left = lane_bits(lanes); left != 0;) {
            const std::size_t probe = probes_->probe_of(objects_[static_cast<std::size_t>(std::countr_zero(left))]);
            std::uint32_t own = 0;
            for (std::uint32_t rest = left; rest != 0; rest &= rest - 1) {
                const int i = std::countr_zero(rest);
                if (probes_->probe_of(objects_[static_cast<std::size_t>(i)]) == probe) own |= 1u << i;
            }
            left &= ~own;
            result = blend(lanes_from<float>(own), from_probe(probe, w, axis, alpha, mirror), result);
        }
        return result;
    }

private:
    static Rgbs look_up(const RadianceMap& map, const Vec3s& w, const Vec3s& axis, const Floats& alpha,
                        const Mask& mirror) {
        if (xsimd::all(mirror)) return map.at(w);
        const Rgbs rough = map.at(axis, alpha);
        return xsimd::any(mirror) ? blend(mirror, map.at(w), rough) : rough;
    }

    Rgbs from_probe(std::size_t probe, const Vec3s& w, const Vec3s& axis, const Floats& alpha,
                    const Mask& mirror) const {
        const Vec3d eye = gbuffer_.projection.eye();
        const Vec3s hit = probes_->trace(probe, eye, p_, w);
        const Mask sharp = alpha < Floats(kSharpest);
        // The axis of a wide lobe meets surfaces elsewhere, but about as far away.
        const Rgbs from_map = look_up(probes_->map(probe), hit, xsimd::all(sharp) ? hit : trace_axis(probe, axis), alpha,
                                      mirror);
        if (!xsimd::any(sharp)) return from_map;
        const Vec3 center = gbuffer_.projection.relative(probes_->center(probe));
        return on_screen(hit + Vec3s{Floats(center.x), Floats(center.y), Floats(center.z)}, sharp, from_map);
    }
    Vec3s trace_axis(std::size_t probe, const Vec3s& axis) const {
        const Vec3s unit_axis = axis * inverse_sqrt(max(dot(axis, axis), Floats(1e-20f)));
        return probes_->trace(probe, gbuffer_.projection.eye(), p_, unit_axis);
    }

    /// Returns the image's pixels where they show the points q, relative to the eye, and `otherwise` elsewhere.
    Rgbs on_screen(const Vec3s& q, const Mask& lanes, const Rgbs& otherwise) const {
        const auto [xw, yw, depth, w] = gbuffer_.projection.homogeneous(q);
        const Floats over = Floats(1.0f) / w, x = xw * over, y = yw * over, none(0.0f);
        const Floats right(static_cast<float>(gbuffer_.width() - 1)), bottom(static_cast<float>(gbuffer_.height() - 1));
        const Mask inside = lanes & (depth > Floats(gbuffer_.projection.near())) & (x >= none) & (y >= none) &
                            (x <= right) & (y <= bottom);
        if (!xsimd::any(inside)) return otherwise;
        const Ints index = truncated(xsimd::select(inside, y + Floats(0.5f), none)) * Ints(image_.x.stride()) +
                           truncated(xsimd::select(inside, x + Floats(0.5f), none));
        const Floats seen = Floats(gbuffer_.projection.near()) /
                            max(gather(gbuffer_.reversed_depth.row(0), index), Floats(1e-30f));
        const Mask shows = inside & (abs(seen - depth) < Floats(kDepthTolerance) * depth);
        return blend(shows, {gather(image_.x.row(0), index), gather(image_.y.row(0), index),
                             gather(image_.z.row(0), index)}, otherwise);
    }

    const PreparedData& data_;
    const GBuffer& gbuffer_;
    const ReflectionProbes* probes_;
    const Planes3& image_;
    Vec3s p_, n_;
    alignas(64) std::array<std::int32_t, Ints::size> objects_;
};

} // namespace

void add_reflections(const PreparedData& data, const Settings& settings, const GBuffer& gbuffer,
                     const ReflectionProbes* probes, Planes3& radiance) {
    const Planes3 before = probes != nullptr ? radiance : Planes3(); // reflections read other pixels
    constexpr int kBandRows = 8;
    parallel_for(static_cast<std::size_t>((gbuffer.height() + kBandRows - 1) / kBandRows), settings.threads,
                 [&](std::size_t band) {
        LobeLookup lobe, coat_lobe;
        const int first = static_cast<int>(band) * kBandRows;
        for (int y = first; y < std::min(first + kBandRows, gbuffer.height()); ++y)
            for (int x = 0; x < gbuffer.width(); x += static_cast<int>(Floats::size)) {
                const Mask seen = gbuffer.visible(x, y);
                const Floats zero(0.0f), one(1.0f);
                const Rgbs f0 = gbuffer.specular.color(x, y);
                const Mask lanes = seen & (f0.r + f0.g + f0.b > zero);
                const Floats coat = gbuffer.coat.empty() ? zero : load(gbuffer.coat, x, y);
                const Mask coated = seen & (coat > zero);
                if (!xsimd::any(lanes | coated)) continue;
                const Vec3s n = gbuffer.normal.vector(x, y), wo = gbuffer.projection.to_viewer(gbuffer.points(x, y));
                const Floats cosine = max(dot(n, wo), Floats(1e-4f));
                const Vec3s mirrored = n * (Floats(2.0f) * cosine) - wo;
                const Surroundings surroundings(data, gbuffer, probes, before, x, y);
                const Floats alpha = load(gbuffer.alpha, x, y);
                Rgbs sum(zero);
                if (xsimd::any(lanes))
                    sum = surroundings(mirrored, alpha, lanes) *
                          albedo(lobe(alpha, cosine, lanes), f0, alpha, cosine);
                sum = blend(lanes, sum, Rgbs(zero));
                if (xsimd::any(coated)) {
                    const Floats width = load(gbuffer.coat_alpha, x, y);
                    const Floats reflected = coat * albedo(coat_lobe(width, cosine, coated), Rgbs(Floats(0.04f)), width,
                                                           cosine).r;
                    const Rgbs above = surroundings(mirrored, width, coated) * reflected;
                    sum = blend(coated, sum * (one - reflected) + above, sum);
                }
                radiance.set(x, y, radiance.color(x, y) + sum);
            }
    });
}

} // namespace duet::raster
