#include "raster/probes/radiance_lookup.h"

#include "common/material/metal.h"

#include <bit>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;
using Rgbs = RgbT<Floats>;

/// Lobes narrower than this GGX width show the image's own pixels; wider ones would need them blurred.
constexpr float kSharpest = 0.02f;
/// Specular reflectance at normal incidence below which the diffuse light is most of what a pixel shows.
constexpr float kMostlyDiffuse = 0.2f;
/// A pixel shows a point if their depths differ by less than this fraction.
constexpr float kDepthTolerance = 0.02f;

} // namespace

struct RadianceLookup::Query {
    const Vec3s &p, &w;
    Vec3s axis; ///< of the lobe; w for a mirror
    const Floats& alpha;
    Mask mirror;

    Query(const Vec3s& p_, const Vec3s& n, const Vec3s& w_, const Floats& alpha_)
        : p(p_), w(w_), axis(dominant_direction(n, w_, alpha_)), alpha(alpha_),
          mirror(alpha_ < Floats(MetalBsdf::kSmoothAlpha)) {}

    /// Looks a map up in the directions `sharp` for mirrors and `rough` for wider lobes.
    Rgbs at(const RadianceMap& map, const Vec3s& sharp, const Vec3s& rough) const {
        if (xsimd::all(mirror)) return map.at(sharp);
        const Rgbs filtered = map.at(rough, alpha);
        return xsimd::any(mirror) ? blend(mirror, map.at(sharp), filtered) : filtered;
    }
};

RadianceLookup::RadianceLookup(const RasterSceneData& data, const GBuffer& gbuffer, const ReflectionProbes* probes,
                               const Planes3& image, int x, int y)
    : data_(data), gbuffer_(gbuffer), probes_(probes), image_(image) {
    load(gbuffer.object, x, y).store_aligned(objects_.data());
}

Rgbs RadianceLookup::operator()(const Vec3s& p, const Vec3s& n, const Vec3s& w, const Floats& alpha,
                                const Mask& lanes) const {
    const Query query(p, n, w, alpha);
    if (probes_ == nullptr) return query.at(*data_.environment_map, w, query.axis);
    Rgbs result(Floats(0.0f));
    for (std::uint32_t left = lane_bits(lanes); left != 0;) {
        const std::size_t probe = probes_->probe_of(objects_[static_cast<std::size_t>(std::countr_zero(left))]);
        std::uint32_t own = 0;
        for (std::uint32_t rest = left; rest != 0; rest &= rest - 1) {
            const int i = std::countr_zero(rest);
            if (probes_->probe_of(objects_[static_cast<std::size_t>(i)]) == probe) own |= 1u << i;
        }
        left &= ~own;
        result = blend(lanes_from<float>(own), from_probe(probe, query), result);
    }
    return result;
}

Rgbs RadianceLookup::from_probe(std::size_t probe, const Query& query) const {
    const Vec3d eye = gbuffer_.projection.eye();
    const auto trace = [&](const Vec3s& w, bool lights) { return probes_->trace(probe, eye, query.p, w, lights); };
    Vec3s hit = trace(query.w, xsimd::all(query.mirror));
    if (probes_->map(probe).has_lights() && xsimd::any(query.mirror) && !xsimd::all(query.mirror))
        hit = select(query.mirror, trace(query.w, true), hit);
    const Mask sharp = query.alpha < Floats(kSharpest);
    // The axis of a wide lobe meets surfaces elsewhere.
    const Vec3s unit_axis = query.axis * inverse_sqrt(max(dot(query.axis, query.axis), Floats(1e-20f)));
    const Rgbs from_map = query.at(probes_->map(probe), hit, xsimd::all(sharp) ? hit : trace(unit_axis, false));
    if (!xsimd::any(sharp)) return from_map;
    const Vec3 center = gbuffer_.projection.relative(probes_->center(probe));
    return on_screen(hit + Vec3s{Floats(center.x), Floats(center.y), Floats(center.z)}, sharp, query.mirror, from_map);
}

/// Returns the image's pixels where they show the points q, relative to the eye. Only mirrors see what emits: the light
/// that wider lobes reflect of it is direct light.
Rgbs RadianceLookup::on_screen(const Vec3s& q, const Mask& lanes, const Mask& mirror, const Rgbs& otherwise) const {
    const auto [xw, yw, depth, w] = gbuffer_.projection.homogeneous(q);
    const Floats over = Floats(1.0f) / w, x = xw * over, y = yw * over, none(0.0f);
    const Floats right(static_cast<float>(gbuffer_.width() - 1)), bottom(static_cast<float>(gbuffer_.height() - 1));
    const Mask inside =
        lanes & (depth > Floats(gbuffer_.projection.near())) & (x >= none) & (y >= none) & (x <= right) & (y <= bottom);
    if (!xsimd::any(inside)) return otherwise;
    const Ints index = truncated(xsimd::select(inside, y + Floats(0.5f), none)) * Ints(image_.x.stride()) +
                       truncated(xsimd::select(inside, x + Floats(0.5f), none));
    const Floats seen =
        Floats(gbuffer_.projection.near()) / max(gather(gbuffer_.reversed_depth.row(0), index), Floats(1e-30f));
    // The image does not hold reflections yet. Surfaces that mostly reflect are in the probe's map, with the
    // environment's reflection.
    const auto reflectance = [&](const PlaneFloat& plane) { return gather(plane.row(0), index); };
    const Planes3& specular = gbuffer_.specular;
    const Mask diffuse =
        max(reflectance(specular.x), max(reflectance(specular.y), reflectance(specular.z))) < Floats(kMostlyDiffuse);
    const Ints object = xsimd::max(gather(gbuffer_.object.row(0), index), Ints(0));
    const Mask dark = mirror | xsimd::bool_cast(gather(data_.emits.data(), object) == Ints(0));
    const Mask shows = inside & diffuse & dark & (abs(seen - depth) < Floats(kDepthTolerance) * depth);
    return blend(shows,
                 {gather(image_.x.row(0), index), gather(image_.y.row(0), index), gather(image_.z.row(0), index)},
                 otherwise);
}

} // namespace duet::raster
