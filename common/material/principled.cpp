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

LayeredBsdf Coated::at(const TextureSet& textures, const SurfacePoint& point) const {
    const Rgb bare = evaluate_reflectance(textures, albedo, point);
    const float normal = normal_reflectance(ior);
    // The boundary reflects the fraction 1 − (1 − F̅)/η² of diffuse light from below: only 1/η² of the
    // directions can leave (Kubelka's relation; Egan and Hilgeman 1973). `deep` sums the series of all such
    // reflections; white stays white.
    const float back = 1 - (1 - schlick_average(Rgb(normal)).r) / sqr(ior);
    const auto deep = [back](float x) { return x * (1 - back) / (1 - x * back); };
    return LayeredBsdf(
        {{deep(bare.r), deep(bare.g), deep(bare.b)}, 0, normal, evaluate_unit(textures, roughness, point), 0, 0});
}

} // namespace duet
