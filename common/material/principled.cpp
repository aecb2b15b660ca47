#include "common/material/principled.h"

#include "common/material/ggx_albedo.h"
#include "common/material/reflectance.h"

namespace duet {

namespace {

float normal_reflectance(float ior) { return sqr((ior - 1) / (ior + 1)); }

} // namespace

LayeredBsdf Principled::at(const TextureSet& textures, const SurfacePoint& point) const {
    return LayeredBsdf({evaluate_reflectance(textures, base_color, point), evaluate_unit(textures, metallic, point),
                        normal_reflectance(ior), evaluate_unit(textures, roughness, point),
                        evaluate_unit(textures, clearcoat, point),
                        evaluate_unit(textures, clearcoat_roughness, point)});
}

/// The boundary reflects 1 − (1 − F̅)/η², because only 1/η² of the directions can leave (Kubelka's relation; Egan and
/// Hilgeman 1973).
float Coated::back() const { return 1 - (1 - schlick_average(Rgb(normal_reflectance(ior))).r) / sqr(ior); }

LayeredBsdf Coated::at(const TextureSet& textures, const SurfacePoint& point) const {
    const Rgb bare = evaluate_reflectance(textures, albedo, point);
    const float normal = normal_reflectance(ior);
    // `deep` sums the series of all reflections from below; white stays white.
    const float reflected = back();
    const auto deep = [reflected](float x) { return x * (1 - reflected) / (1 - x * reflected); };
    return LayeredBsdf(
        {{deep(bare.r), deep(bare.g), deep(bare.b)}, 0, normal, evaluate_unit(textures, roughness, point), 0, 0});
}

} // namespace duet
