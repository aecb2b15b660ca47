#include "common/material/principled.h"

#include "common/material/ggx_albedo.h"
#include "common/material/reflectance.h"

namespace duet {

namespace {

float f0_from_ior(float ior) { return sqr((ior - 1) / (ior + 1)); }

} // namespace

LayeredBsdf Principled::at(const TextureSet& textures, const SurfacePoint& point) const {
    return LayeredBsdf({evaluate_reflectance(textures, base_color, point), evaluate_clamped(textures, metallic, point),
                        f0_from_ior(ior), evaluate_clamped(textures, roughness, point),
                        evaluate_clamped(textures, clearcoat, point),
                        evaluate_clamped(textures, clearcoat_roughness, point)});
}

SubsurfaceBsdf Principled::subsurface_at(const TextureSet& textures, const SurfacePoint& point) const {
    LayeredBsdf surface = at(textures, point);
    const float fraction = evaluate_clamped(textures, subsurface, point);
    surface.diffuse *= 1 - fraction;
    return {surface, fraction * (1 - evaluate_clamped(textures, metallic, point)),
            solid_interior(evaluate_reflectance(textures, base_color, point), mean_free_path)};
}

/// The boundary reflects 1 − (1 − F̅)/η², because only 1/η² of the directions can leave (Kubelka's relation; Egan and
/// Hilgeman 1973).
float Coated::internal_reflectance() const { return 1 - (1 - schlick_average(Rgb(f0_from_ior(ior))).r) / sqr(ior); }

LayeredBsdf Coated::at(const TextureSet& textures, const SurfacePoint& point) const {
    const Rgb base = evaluate_reflectance(textures, albedo, point);
    const float f0 = f0_from_ior(ior);
    // `with_interreflection` sums the series of all reflections from below; white stays white.
    const float reflected = internal_reflectance();
    const auto with_interreflection = [reflected](float x) { return x * (1 - reflected) / (1 - x * reflected); };
    return LayeredBsdf({{with_interreflection(base.r), with_interreflection(base.g), with_interreflection(base.b)},
                        0,
                        f0,
                        evaluate_clamped(textures, roughness, point),
                        0,
                        0});
}

SubsurfaceBsdf Coated::subsurface_at(const TextureSet& textures, const SurfacePoint& point) const {
    LayeredBsdf surface = at(textures, point);
    const Rgb seen = surface.diffuse, base = evaluate_reflectance(textures, albedo, point);
    surface.diffuse = Rgb();
    const float back = internal_reflectance();
    const Rgb factor(free_path_factor(base.r, back), free_path_factor(base.g, back), free_path_factor(base.b, back));
    return {surface, 1, solid_interior(seen, mean_free_path * factor)};
}

} // namespace duet
