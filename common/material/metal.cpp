#include "common/material/metal.h"

#include "common/material/reflectance.h"

namespace duet {

template <typename T>
MetalBsdfT<T>::MetalBsdfT(Rgb reflectance_, float alpha_) : reflectance(reflectance_), alpha(alpha_) {
    if (!smooth())
        multiple_scattering =
            ggx_multiple_scattering(schlick_average(reflectance), ggx_average_albedo(alpha).energy_loss);
}

template <typename T>
MetalBsdfT<T>::MetalBsdfT(const Conductor& conductor, float alpha_)
    : reflectance(conductor.f0), alpha(alpha_), n(conductor.n), k(conductor.k) {
    if (!smooth())
        multiple_scattering = ggx_multiple_scattering(conductor.average_fresnel, ggx_average_albedo(alpha).energy_loss);
}

template <typename T> RgbT<T> MetalBsdfT<T>::directional_albedo(T cosine) const {
    if (smooth()) return fresnel(cosine);
    const GgxAlbedo single = ggx_albedo(alpha, cosine);
    return single.albedo(reflectance) +
           multiple_scattering * ((1 - single.energy) * kPi * ggx_average_albedo(alpha).energy_loss);
}

template struct MetalBsdfT<float>;

MetalBsdf Metal::at(const TextureSet& textures, const SurfacePoint& point) const {
    const float alpha = sqr(evaluate_clamped(textures, roughness, point));
    return conductor.valid() ? MetalBsdf(conductor, alpha)
                             : MetalBsdf(evaluate_reflectance(textures, reflectance, point), alpha);
}

} // namespace duet
