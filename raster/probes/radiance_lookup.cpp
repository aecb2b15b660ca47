#include "raster/probes/radiance_lookup.h"

#include "common/material/metal.h"

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;
using Rgbs = RgbT<Floats>;

/// Lobes below this GGX width, that of the first filtered map, are traced like mirrors.
constexpr float kNarrow = sqr(1.0f / RadianceMap::kLevels);

} // namespace

struct RadianceLookup::Query {
    const Vec3s &p, &w;
    Vec3s axis; ///< axis of the lobe; equal to w for a mirror
    const Floats& alpha;
    Mask mirror;

    Query(const Vec3s& p_, const Vec3s& n, const Vec3s& w_, const Floats& alpha_)
        : p(p_), w(w_), axis(dominant_direction(n, w_, alpha_)), alpha(alpha_),
          mirror(alpha_ < Floats(MetalBsdf::kSmoothAlpha)) {}

    /// Samples a map in the directions `sharp` for mirrors and `rough` for wider lobes.
    Rgbs at(const RadianceMap& map, const Vec3s& sharp, const Vec3s& rough) const {
        if (xsimd::all(mirror)) return map.at(sharp);
        const Rgbs filtered = map.at(rough, alpha);
        return xsimd::any(mirror) ? blend(mirror, map.at(sharp), filtered) : filtered;
    }
};

RadianceLookup::RadianceLookup(const RasterSceneData& data, const GBuffer& gbuffer, const ReflectionProbes* probes,
                               int x, int y)
    : data_(data), gbuffer_(gbuffer), probes_(probes) {
    if (probes == nullptr) return;
    alignas(64) std::array<std::int32_t, Ints::size> each;
    load(gbuffer.object, x, y).store_aligned(each.data());
    for (const std::size_t lane : SetBits(lane_bits(gbuffer.visible(x, y))))
        each[lane] = static_cast<std::int32_t>(probes->probe_of(each[lane]));
    probe_ = Ints::load_aligned(each.data());
}

Rgbs RadianceLookup::operator()(const Vec3s& p, const Vec3s& n, const Vec3s& w, const Floats& alpha,
                                const Mask& lanes) const {
    const Query query(p, n, w, alpha);
    if (probes_ == nullptr) return query.at(*data_.environment_map, w, query.axis);
    Rgbs result(Floats(0.0f));
    for_each_value(probe_, lane_bits(lanes), [&](std::int32_t probe, const Mask& own) {
        result = blend(own, from_probe(static_cast<std::size_t>(probe), query, own), result);
    });
    return result;
}

Rgbs RadianceLookup::from_probe(std::size_t probe, const Query& query, const Mask& lanes) const {
    const Vec3d eye = gbuffer_.projection.eye();
    const RadianceMap& map = probes_->map(probe);
    const Mask narrow = query.alpha < Floats(kNarrow), traced = lanes & narrow;
    const auto trace = [&](bool lights) { return probes_->trace(probe, eye, query.p, query.w, lights, traced); };
    Vec3s hit = trace(xsimd::all(query.mirror));
    if (map.has_lights() && xsimd::any(query.mirror) && !xsimd::all(query.mirror))
        hit = select(query.mirror, trace(true), hit);
    if (xsimd::all(narrow | ~lanes)) return query.at(map, hit, hit);
    const Vec3s unit_axis = query.axis * inverse_sqrt(max(dot(query.axis, query.axis), Floats(1e-20f)));
    const Vec3s blurred = probes_->trace_lobe(probe, eye, query.p, unit_axis, query.alpha, lanes & ~narrow);
    return query.at(map, hit, select(narrow, hit, blurred));
}

} // namespace duet::raster
