#include "raster/probes/refraction.h"

#include "raster/probes/radiance_lookup.h"
#include "raster/lighting/specular_lobe.h"
#include "raster/probes/glass_shapes.h"
#include "raster/visibility/shader.h"

#include "common/material/fresnel.h"
#include "common/material/metal.h"
#include "common/material/thin_dielectric.h"

#include <optional>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;
using Rgbs = RgbT<Floats>;

/// Holds a refracted direction, and the fraction of light that the interface transmits. At total internal reflection
/// the fraction is 0, and the direction is the mirrored one.
struct Refracted {
    Vec3s w;
    Floats through;
};
/// Refracts the unit direction w at a unit normal n on the side that w comes from. `eta` is the index beyond the
/// interface over the index before it.
Refracted refract(const Vec3s& w, const Vec3s& n, const Floats& eta) {
    const Floats zero(0.0f), cosine = clamp(-dot(w, n), zero, Floats(1.0f));
    const Floats cos2 = cos2_refracted(cosine, eta), cos_t = xsimd::sqrt(max(cos2, zero));
    const Floats over = Floats(1.0f) / eta;
    const Mask total = cos2 <= zero;
    const Vec3s through = w * over + n * (cosine * over - cos_t), mirrored = w + n * (Floats(2.0f) * cosine);
    return {select(total, mirrored, through), Floats(1.0f) - fresnel_dielectric(cosine, eta)};
}

/// Computes the light that arrives through the glass of one object in a batch of pixels.
class GlassBatch {
public:
    GlassBatch(const RasterSceneData& data, const GBuffer& gbuffer, const RadianceLookup& lookup, int x, int y)
        : data_(data), gbuffer_(gbuffer), lookup_(lookup), p_(gbuffer.points(x, y)), n_(gbuffer.normal.vector(x, y)),
          w_(gbuffer.projection.to_viewer(p_) * Floats(-1.0f)), alpha_(load(gbuffer.alpha, x, y)),
          f0_(gbuffer.specular.color(x, y)) {
        if (!gbuffer.tint.empty()) tint_ = gbuffer.tint.color(x, y);
    }

    Rgbs through(std::int32_t object, const Dielectric& glass, const Mask& lanes) const {
        const Rgbs tint = tint_.value_or(broadcast<Floats>(glass.tint.value));
        const Floats eta(glass.ior);
        const Refracted in = refract(w_, n_, eta);
        if (glass.thin) return sheet(glass.ior, tint, Floats(1.0f) - in.through, lanes);
        // Light that add_reflections() does not reflect enters the glass.
        const Floats cosine = viewer_cosine(n_, -w_);
        const Floats entering =
            Floats(1.0f) - specular_albedo(LobeLookup()(alpha_, cosine, lanes), f0_, alpha_, cosine).g;
        const auto exit = data_.glass_shapes->exit(object, gbuffer_.projection.eye(), p_, n_, in.w);
        if (!exit) { // small glass: light passes straight through
            if (data_.objects[static_cast<std::size_t>(object)].closed)
                return lookup_(p_, n_, w_, alpha_, lanes) * entering * (tint * tint);
            return lookup_(p_, n_ * Floats(-1.0f), in.w, alpha_, lanes) * entering * tint; // an open surface (water)
        }
        // All light is taken to leave here. Light that is reflected inside leaves later, mostly in about the same
        // direction.
        const Refracted out = refract(in.w, exit->n * Floats(-1.0f), Floats(1 / glass.ior));
        const auto absorbed = [&](float per_meter) { return xsimd::exp(exit->length * Floats(-per_meter)); };
        const Rgbs inside{absorbed(glass.absorption.r), absorbed(glass.absorption.g), absorbed(glass.absorption.b)};
        // Light that leaves at a grazing angle spreads out, so emitters are not visible in it, just as in rough glass.
        const Mask grazing = (out.through > Floats(0.0f)) & (out.through < Floats(0.5f));
        const Floats alpha = max(alpha_, xsimd::select(grazing, Floats(MetalBsdf::kSmoothAlpha), Floats(0.0f)));
        return lookup_(exit->p, exit->n, out.w, alpha, lanes) * entering * (tint * tint) * inside;
    }

private:
    /// Returns the light that arrives through a thin sheet, and the light that it mirrors.
    Rgbs sheet(float ior, const Rgbs& tint, const Floats& reflected, const Mask& lanes) const {
        const Floats one(1.0f), cosine = clamp(-dot(w_, n_), Floats(0.0f), one);
        const Floats inner = xsimd::sqrt(max(cos2_refracted(cosine, Floats(ior)), Floats(1e-6f)));
        const Rgbs behind = lookup_(p_, n_, w_, Floats(0.0f), lanes),
                   before = lookup_(p_, n_, w_ + n_ * (Floats(2.0f) * cosine), Floats(0.0f), lanes);
        const auto channel = [&](const Floats& passed, const Floats& b, const Floats& f) {
            const auto part = sheet_fractions(reflected, xsimd::pow(max(passed, Floats(1e-6f)), one / inner));
            return b * part.transmitted + f * part.reflected;
        };
        return {channel(tint.r, behind.r, before.r), channel(tint.g, behind.g, before.g),
                channel(tint.b, behind.b, before.b)};
    }

    const RasterSceneData& data_;
    const GBuffer& gbuffer_;
    const RadianceLookup& lookup_;
    Vec3s p_, n_, w_; ///< w_ is the direction of the camera's rays
    Floats alpha_;
    Rgbs f0_; ///< reflectance at normal incidence
    std::optional<Rgbs> tint_; ///< if it varies
};

} // namespace

void add_refraction(const RasterSceneData& data, const RasterSettings& settings, const GBuffer& gbuffer,
                    Planes3& radiance) {
    for_each_batch(gbuffer.width(), gbuffer.height(), settings.threads, [&](int x, int y) {
        Rgbs sum(Floats(0.0f));
        bool any = false;
        const Ints objects = load(gbuffer.object, x, y), materials = load(gbuffer.material, x, y);
        for_each_value(materials, lane_bits(gbuffer.visible(x, y)), [&](std::int32_t material, const Mask& its_lanes) {
            const auto* glass = std::get_if<Dielectric>(&data.scene.materials[static_cast<std::size_t>(material)]);
            if (glass == nullptr) return;
            const RadianceLookup lookup(data, gbuffer, data.reflection_probes.get(), x, y);
            const GlassBatch batch(data, gbuffer, lookup, x, y);
            for_each_value(objects, lane_bits(its_lanes), [&](std::int32_t object, const Mask& lanes) {
                sum = blend(lanes, batch.through(object, *glass, lanes), sum);
            });
            any = true;
        });
        if (any) radiance.set(x, y, radiance.color(x, y) + sum);
    });
}

} // namespace duet::raster
