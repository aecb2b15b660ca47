// These classes are the BSDFs of batched surfaces (PlainSurfaces) with one path per lane, bit-equal to those of
// common/material. All have the same interface: kLit says whether there is any lobe other than delta lobes, kThrough
// whether light is transmitted, kDirection whether sample() uses two random samples for the direction, and kLobe
// whether it uses one for the lobe; eval() and pdf() are for light samples.
#pragma once

#include "common/material/fresnel.h"
#include "common/material/ggx.h"
#include "common/material/ggx_albedo.h"
#include "common/material/microfacet.h"
#include "raytrace/integrator/lanes.h"

namespace duet::raytrace::lanes {

#if XSIMD_WITH_AVX

/// Holds the random samples of the vertices.
struct Numbers {
    Vec2T<Floats> bsdf;
    Floats lobe;
};

/// Holds a BSDF sample per lane; see BsdfSample. `some` marks the lanes that have one.
struct LaneSample {
    Vec wi;
    Color weight;
    Floats pdf;
    Mask some;
    Mask transmitted; ///< valid only with kThrough
    Floats refraction; ///< valid only with kThrough: factor of PathState::refraction if transmitted
};

inline Mask is_black_lane(const Color& c) {
    const Floats zero(0.0f);
    return (c.r == zero) & (c.g == zero) & (c.b == zero);
}
inline Floats negated_where(const Mask& condition, Floats x) { return select(condition, -x, x); }

/// Loads a color of each path's BSDF.
template <typename BsdfType> Color colors(std::span<const PlainPath> paths, Rgb BsdfType::* color) {
    Columns columns;
    for_lanes(paths,
              [&](std::size_t i, const PlainPath& path) { columns.set(i, std::get<BsdfType>(*path.bsdf).*color); });
    return columns.colors();
}
/// Loads a number of each path's BSDF.
template <typename BsdfType> Floats floats(std::span<const PlainPath> paths, float BsdfType::* number) {
    Column column;
    for_lanes(paths,
              [&](std::size_t i, const PlainPath& path) { column.of[i] = std::get<BsdfType>(*path.bsdf).*number; });
    return column.floats();
}

class MattLanes {
public:
    static constexpr bool kLit = true, kThrough = false;
    static constexpr bool kDirection = true, kLobe = false;

    explicit MattLanes(std::span<const PlainPath> paths)
        : albedo_(colors(paths, &DiffuseBsdf::albedo)) {}

    /// `wo` and `wi` must be on the same side of the surface.
    Color eval(const Vec&, const Vec&) const { return albedo_ * Floats(kInvPi); }
    Floats pdf(const Vec&, const Vec& wi) const { return cosine_hemisphere_pdf(abs(wi.z)); }
    LaneSample sample(const Vec& wo, const Numbers& u) const {
        Vec wi = cosine_hemisphere(u.bsdf);
        const Floats density = cosine_hemisphere_pdf(wi.z), zero(0.0f);
        wi.z = negated_where(wo.z < zero, wi.z);
        return {wi, albedo_, density, Mask(true), Mask(false), zero};
    }

private:
    Color albedo_;
};

/// Computes the Fresnel term of MetalBsdf.
class MetalFresnel {
public:
    explicit MetalFresnel(std::span<const PlainPath> paths)
        : normal_(colors(paths, &MetalBsdf::reflectance)), n_(colors(paths, &MetalBsdf::n)),
          named_(n_.r != Floats(0.0f)) {
        if (any(named_)) k_ = colors(paths, &MetalBsdf::k);
    }

    Color operator()(Floats cosine) const {
        const Color plain = fresnel_schlick(normal_, cosine);
        if (!any(named_)) return plain;
        const auto channel = [&](Floats schlick, Floats n, Floats k) {
            return select(named_, fresnel_conductor(cosine, n, k), schlick);
        };
        return {channel(plain.r, n_.r, k_.r), channel(plain.g, n_.g, k_.g), channel(plain.b, n_.b, k_.b)};
    }

private:
    static bool any(const Mask& mask) { return lane_bits(mask) != 0; }

    Color normal_, n_, k_;
    Mask named_; // lanes of conductors, which use n and k
};

class MirrorLanes {
public:
    static constexpr bool kLit = false, kThrough = false;
    static constexpr bool kDirection = false, kLobe = false;

    explicit MirrorLanes(std::span<const PlainPath> paths) : fresnel_(paths) {}

    LaneSample sample(const Vec& wo, const Numbers&) const {
        return {{-wo.x, -wo.y, wo.z}, fresnel_(abs(wo.z)), Floats(1.0f),
                wo.z != Floats(0.0f), Mask(false),         Floats(0.0f)};
    }

private:
    MetalFresnel fresnel_;
};

class MetalLanes {
public:
    static constexpr bool kLit = true, kThrough = false;
    static constexpr bool kDirection = true, kLobe = true;

    explicit MetalLanes(std::span<const PlainPath> paths)
        : fresnel_(paths), multiple_(colors(paths, &MetalBsdf::multiple)),
          single_(is_black_lane(multiple_)), any_multiple_(lane_bits(single_) != (1u << kLanes) - 1),
          alpha_(floats(paths, &MetalBsdf::alpha)) {}

    Color eval(const Vec& wo, const Vec& wi) const {
        const Vec above = upwards(wo), to = upwards(wi);
        return eval(above, to, microfacet(above, to), lost(above.z));
    }
    Floats pdf(const Vec& wo, const Vec& wi) const {
        const Vec above = upwards(wo), to = upwards(wi);
        return pdf(above, to, microfacet(above, to), lost(above.z));
    }
    LaneSample sample(const Vec& wo, const Numbers& u) const {
        const Floats zero(0.0f), one(1.0f);
        const Vec above = upwards(wo);
        const Floats lost_there = lost(above.z);
        const Mask several = ~single_ & (u.lobe >= one - lost_there);
        Vec wi = normalize(reflect(above, ggx_sample_visible_normal(above, alpha_, u.bsdf)));
        if (lane_bits(several) != 0) wi = select(several, cosine_hemisphere(u.bsdf), wi);
        const Mask some = (wo.z != zero) & (wi.z > zero);
        // The microfacets of lanes whose directions are on different sides are not valid, and `some` excludes those
        // lanes.
        const MicrofacetT<Floats> h = microfacet(above, wi);
        const Floats density = pdf(above, wi, h, lost_there);
        const Color weight = eval(above, wi, h, lost_there) * (wi.z / density);
        wi.z = negated_where(wo.z < zero, wi.z);
        return {wi, weight, density, some, Mask(false), zero};
    }

private:
    Color eval(const Vec& wo, const Vec& wi, const MicrofacetT<Floats>& h, Floats lost_at_wo) const {
        const Color one = fresnel_(h.cosine) * ggx_reflection(wo, wi, h.normal, alpha_);
        return any_multiple_ ? one + multiple_ * (lost_at_wo * lost(wi.z)) : one;
    }
    Floats pdf(const Vec& wo, const Vec& wi, const MicrofacetT<Floats>& h, Floats lost_at_wo) const {
        const Floats several = select(single_, Floats(0.0f), lost_at_wo);
        return ggx_reflections_pdf(wo, wi, h.normal, alpha_, several);
    }
    // Returns ggx_lost of each lane, or 0 if no lane has multiple scattering.
    Floats lost(Floats cosine) const {
        if (!any_multiple_) return Floats(0.0f);
        const Column cosines(cosine), alphas(alpha_);
        Column losts;
        for (std::size_t i = 0; i < kLanes; ++i) losts.of[i] = ggx_lost(alphas.of[i], cosines.of[i]);
        return losts.floats();
    }

    MetalFresnel fresnel_;
    Color multiple_;
    Mask single_; // lanes without multiple scattering
    bool any_multiple_;
    Floats alpha_;
};

class GlassLanes {
public:
    static constexpr bool kLit = false, kThrough = true;
    static constexpr bool kDirection = false, kLobe = true;

    explicit GlassLanes(std::span<const PlainPath> paths)
        : tint_(colors(paths, &DielectricBsdf::tint)), eta_(floats(paths, &DielectricBsdf::eta)) {}

    LaneSample sample(const Vec& wo, const Numbers& u) const {
        const Floats zero(0.0f), one(1.0f), cos_o = abs(wo.z);
        const Mask outside = wo.z > zero;
        const Floats relative = select(outside, eta_, one / eta_), reflected = fresnel_dielectric(cos_o, relative);
        const Mask reflects = u.lobe < reflected;
        const Floats cos_t = safe_sqrt(cos2_refracted(cos_o, relative));
        const Vec refracted = refract(wo, cos_t, relative);
        const Color through = tint_ * (one / (relative * relative));
        return {select(reflects, Vec(-wo.x, -wo.y, wo.z), refracted),
                {select(reflects, one, through.r), select(reflects, one, through.g), select(reflects, one, through.b)},
                select(reflects, reflected, one - reflected),
                (wo.z != zero) & (reflects | (cos_t != zero)),
                ~reflects,
                select(outside, one / (eta_ * eta_), eta_ * eta_)};
    }

private:
    Color tint_;
    Floats eta_;
};

#endif

} // namespace duet::raytrace::lanes
