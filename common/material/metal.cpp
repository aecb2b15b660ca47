#include "common/material/metal.h"

#include "common/material/reflectance.h"

namespace duet {

template <typename T> MetalBsdfT<T>::MetalBsdfT(Rgb reflectance_, float alpha_) : reflectance(reflectance_), alpha(alpha_) {
    if (!smooth()) multiple = ggx_multiple(schlick_average(reflectance), ggx_means(alpha).lost);
}

template <typename T>
MetalBsdfT<T>::MetalBsdfT(const Conductor& conductor, float alpha_)
    : reflectance(conductor.normal), alpha(alpha_), n(conductor.n), k(conductor.k) {
    if (!smooth()) multiple = ggx_multiple(conductor.average, ggx_means(alpha).lost);
}

template <typename T> RgbT<T> MetalBsdfT<T>::albedo(T cosine) const {
    if (smooth()) return fresnel(cosine);
    const GgxAlbedo single = ggx_albedo(alpha, cosine);
    return single.of(reflectance) + multiple * ((1 - single.energy) * kPi * ggx_means(alpha).lost);
}

template struct MetalBsdfT<float>;

MetalBsdf Metal::at(const TextureSet& textures, const SurfacePoint& point) const {
    const float alpha = sqr(evaluate_unit(textures, roughness, point));
    return conductor.exists() ? MetalBsdf(conductor, alpha)
                              : MetalBsdf(evaluate_reflectance(textures, reflectance, point), alpha);
}

} // namespace duet
