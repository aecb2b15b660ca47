#include "raster/lighting/lit_batch.h"

#include "common/material/ggx.h"
#include "common/material/layered.h"
#include "common/material/metal.h"
#include "common/material/microfacet.h"
#include "raster/lighting/polygon_light.h"
#include "raster/lighting/sphere_light.h"

namespace duet::raster {
namespace {

using Lanes = LitBatch::Lanes;
using Color = RgbT<Floats>;
const Floats kNone(0.0f), kOne(1.0f);

Color black_outside(const Lanes& lanes, const Color& c) { return blend(lanes, c, Color(kNone)); }

/// Returns ggx_multiple_scattering(…)·lost(wo), the BRDF of multiple scattering between microfacets without its factor
/// lost(wi). `normal` is the reflectance at normal incidence.
Color several_reflections(const Color& normal, const LobeTables& tables) {
    constexpr float kLeast = 0.004f; // as in ggx_multiple_scattering, which neglects the loss of narrow lobes
    const Floats mean = max(tables.mean_lost, Floats(kLeast));
    const Floats lost = xsimd::select(tables.mean_lost < Floats(kLeast), kNone, kOne - tables.energy);
    if (lane_bits(lost > kNone) == 0) return Color(kNone);
    const Floats factor = lost * (kOne - mean) * Floats(kInvPi) / mean;
    const auto channel = [&](const Floats& r) {
        const Floats average = r + (kOne - r) * Floats(1.0f / 21); // schlick_average
        return average * average * factor / (kOne - average * mean);
    };
    return {channel(normal.r), channel(normal.g), channel(normal.b)};
}

} // namespace

LitBatch::LitBatch(const GBuffer& gbuffer, int x, int y, const Lanes& lanes, Tables& tables)
    : p_(gbuffer.points(x, y)), z_(gbuffer.normal.vector(x, y)), lanes_(lanes),
      diffuse_(gbuffer.diffuse.color(x, y) * Floats(kInvPi)) {
    constexpr float kRounding = 1e-5f; // relative to the distance, ten times the rounding error of floats
    rounding_ = xsimd::sqrt(dot(p_, p_)) * Floats(kRounding);
    const Vec3T<Floats> v = gbuffer.projection.to_viewer(p_);
    const Floats cosine = dot(z_, v);
    const Vec3T<Floats> across = v - z_ * cosine;
    const Floats sine2 = dot(across, across);
    // This vector gives the frame's x axis. Where the viewer looks along the normal, any perpendicular vector serves.
    const Lanes y_is_far = abs(z_.y) < Floats(0.7f);
    const Vec3T<Floats> other = select(y_is_far, Vec3T<Floats>(-z_.z, kNone, z_.x), Vec3T<Floats>(kNone, z_.z, -z_.y));
    const Vec3T<Floats> side = select(sine2 > Floats(1e-6f), across, other);
    x_ = side * inverse_sqrt(max(dot(side, side), Floats(1e-12f)));
    y_ = cross(z_, x_);
    constexpr float kGrazing = 1e-3f; // a bent normal may face away from the viewer
    const Floats up = clamp(cosine, Floats(kGrazing), kOne);
    wo_ = {xsimd::sqrt(kOne - up * up), kNone, up};

    const Color normal = gbuffer.specular.color(x, y);
    const Floats alpha = load(gbuffer.alpha, x, y);
    const Lanes specular = lanes_ & (max_component(normal) > kNone) & (alpha >= Floats(MetalBsdf::kSmoothAlpha));
    Floats coat = kNone, under(1.0f);
    if (!gbuffer.coat.empty()) coat = load(gbuffer.coat, x, y);
    if (const Lanes coated = lanes_ & (coat > kNone); lane_bits(coated) != 0) {
        const Floats width = load(gbuffer.coat_alpha, x, y);
        const Lobe& lobe = add_lobe(tables.coat, Color(Floats(LayeredBsdf::kCoatF0)), width, coat, coated);
        under = kOne - (lobe.albedo.r + lobe.several.r * lobe.mean_lost) * Floats(kPi);
    }
    if (lane_bits(specular) != 0) add_lobe(tables.specular, normal, alpha, under, specular);
    uniform_ = diffuse_;
    for (std::size_t i = 0; i < lobe_count_; ++i)
        uniform_ += black_outside(lobes_[i].lanes, lobes_[i].several * lobes_[i].mean_lost);
}

const LitBatch::Lobe& LitBatch::add_lobe(LobeLookup& lookup, const Color& normal, const Floats& alpha,
                                         const Floats& weight, const Lanes& lanes) {
    const LobeTables t = lookup(alpha, wo_.z, lanes);
    Lobe& lobe = lobes_[lobe_count_++];
    lobe.lookup = &lookup, lobe.cosine_space = CosineSpaceT<Floats>::of(t.m11, t.m13, t.m22, t.m31, t.m33);
    lobe.alpha = alpha, lobe.normal = normal, lobe.weight = weight, lobe.lanes = lanes, lobe.mean_lost = t.mean_lost;
    lobe.albedo = (normal + (Color(kOne) - normal) * t.share) * (t.energy * weight * Floats(kInvPi));
    lobe.several = several_reflections(normal, t) * weight;
    return lobe;
}

template <std::size_t N> Color LitBatch::from_polygon(const FrameLight& light, const Lanes& diffuse_lanes) const {
    const Vec3T<Floats> corner = broadcast<Floats>(light.position) - p_;
    const Floats behind = dot(corner, broadcast<Floats>(light.axis));
    Lanes lanes = lanes_ & ((light.two_sided ? abs(behind) : -behind) > rounding_);
    if (lane_bits(lanes) == 0) return Color(kNone);
    const PolygonT<Floats> polygon{local(corner), local(broadcast<Floats>(light.u)), local(broadcast<Floats>(light.v))};
    const Floats& u = polygon.u.z;
    const Floats& v = polygon.v.z;
    const Floats highest = polygon.corner.z + max(max(u, v), max(kNone, N == 4 ? u + v : kNone));
    lanes = lanes & (highest > kNone);
    if (lane_bits(lanes) == 0) return Color(kNone);
    const auto form_factor = [&](const PolygonT<Floats>& shape, const Lanes& where) {
        const Floats signed_factor = polygon_form_factor_times_pi<N>(shape, where);
        return xsimd::select(where, light.two_sided ? abs(signed_factor) : max(signed_factor, kNone), kNone);
    };
    Color sum(kNone);
    if (const Lanes diffuse = lanes & diffuse_lanes; lane_bits(diffuse) != 0)
        sum += uniform_ * form_factor(polygon, diffuse);
    for (std::size_t i = 0; i < lobe_count_; ++i) {
        const Lobe& lobe = lobes_[i];
        const auto& to_cosine = lobe.cosine_space;
        if (const Lanes glossy = lanes & lobe.lanes; lane_bits(glossy) != 0)
            sum += black_outside(glossy, lobe.albedo * form_factor({to_cosine(polygon.corner), to_cosine(polygon.u),
                                                                    to_cosine(polygon.v)}, glossy));
    }
    return sum * broadcast<Floats>(light.emitted);
}

Color LitBatch::from_sphere(const FrameLight& light, const Lanes& diffuse_lanes) const {
    const Vec3T<Floats> way = broadcast<Floats>(light.position) - p_;
    const Floats squared = dot(way, way), radius2 = Floats(sqr(light.radius)), height = dot(way, z_);
    const Lanes outside = squared > radius2;
    // A two-sided sphere lights points inside it from all directions, but not points on its own surface.
    const Lanes inside = (light.two_sided ? lanes_ : Lanes(false)) & (!outside) & (height > -rounding_);
    const Lanes lanes = (lanes_ & outside & (height > Floats(-light.radius) + rounding_)) | inside;
    if (lane_bits(lanes) == 0) return Color(kNone);
    const Floats inverse = inverse_sqrt(max(squared, Floats(1e-30f)));
    const Floats sine2 = min(radius2 * inverse * inverse, Floats(1 - 1e-6f));
    Color sum(kNone);
    if (const Lanes diffuse = lanes & diffuse_lanes; lane_bits(diffuse) != 0)
        sum += uniform_ *
               xsimd::select(inside, Floats(kPi), sphere_form_factor_times_pi(height * inverse, sine2, diffuse));
    if (lobe_count_ == 0) return black_outside(lanes, sum) * broadcast<Floats>(light.emitted);
    const Vec3T<Floats> d = local(way * inverse);
    for (std::size_t i = 0; i < lobe_count_; ++i)
        if (const Lanes glossy = lanes & lobes_[i].lanes; lane_bits(glossy) != 0)
            sum += black_outside(glossy, lobes_[i].albedo * sphere_in_lobe(lobes_[i].cosine_space, d, sine2, glossy));
    return black_outside(lanes, sum) * broadcast<Floats>(light.emitted);
}

Color LitBatch::from_direction(const Vec3T<Floats>& wi, const Floats& irradiance, const Lanes& diffuse_lanes,
                               std::size_t lobe_count) const {
    const Floats cosine = dot(wi, z_);
    const Lanes lanes = lanes_ & (cosine > kNone) & (irradiance > kNone);
    if (lane_bits(lanes) == 0) return Color(kNone);
    Color sum = black_outside(diffuse_lanes, diffuse_);
    for (std::size_t i = 0; i < lobe_count; ++i) {
        const Lobe& lobe = lobes_[i];
        if (lane_bits(lanes & lobe.lanes) == 0) continue;
        const Vec3T<Floats> w(dot(wi, x_), dot(wi, y_), max(cosine, Floats(1e-6f)));
        const MicrofacetT<Floats> h = microfacet(wo_, w);
        const Color fresnel = fresnel_schlick(lobe.normal, h.cosine);
        Color reflected = fresnel * (ggx_reflection(wo_, w, h.normal, lobe.alpha) * lobe.weight);
        const Lanes lossy = lanes & lobe.lanes & (max_component(lobe.several) > kNone);
        if (lane_bits(lossy) != 0) reflected += lobe.several * lobe.lookup->lost(lobe.alpha, w.z, lossy);
        sum += black_outside(lobe.lanes, reflected);
    }
    return black_outside(lanes, sum * (cosine * irradiance));
}

Color LitBatch::from_position(const FrameLight& light, const Lanes& diffuse_lanes) const {
    const Vec3T<Floats> way = broadcast<Floats>(light.position) - p_;
    const Floats inverse = inverse_sqrt(max(dot(way, way), Floats(1e-30f)));
    const Vec3T<Floats> wi = way * inverse;
    Floats fraction = inverse * inverse;
    if (light.kind == FrameLight::Kind::kSpot) fraction = dimmed_by_cone(light, wi, fraction);
    return from_direction(wi, fraction, diffuse_lanes, lobe_count_) * broadcast<Floats>(light.emitted);
}

Color LitBatch::reflected(const FrameLight& light, Lobes lobes) const {
    const Lanes diffuse = lobes == Lobes::kAll ? lanes_ & (max_component(uniform_) > kNone) : Lanes(false);
    switch (light.kind) {
    case FrameLight::Kind::kTriangle:
        return from_polygon<3>(light, diffuse);
    case FrameLight::Kind::kQuad:
        return from_polygon<4>(light, diffuse);
    case FrameLight::Kind::kSphere:
        return from_sphere(light, diffuse);
    case FrameLight::Kind::kPoint:
    case FrameLight::Kind::kSpot:
        return from_position(light, diffuse);
    case FrameLight::Kind::kSun:
        return from_direction(broadcast<Floats>(light.axis), kOne, diffuse, light.diffuse_only ? 0 : lobe_count_) *
               broadcast<Floats>(light.emitted);
    }
    return Color(kNone);
}

Color LitBatch::diffuse(const Color& irradiance) const { return black_outside(lanes_, uniform_ * irradiance); }

} // namespace duet::raster
