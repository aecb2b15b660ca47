// Phong's model: diffuse light, and a highlight about the mirror direction.
#pragma once

#include "common/image/rgb.h"

namespace duet::raster {

/// The BRDF's two parts: base colour / π, and 4 % of the light in a lobe (m + 2)/(2π) · cosᵐ about the mirror
/// direction, which no direction makes more of than it receives (Phong 1975, «Illumination for Computer Generated
/// Pictures»; normalized as in Lafortune and Willems 1994, «Using the Modified Phong Reflectance Model for Physically
/// Based Rendering»). m = 32 = 2⁵: five squarings.
inline constexpr int kPhongSquarings = 5;
inline constexpr float kPhongDiffuse = kInvPi;
inline constexpr float kPhongSpecular = 0.04f * ((1 << kPhongSquarings) + 2) * kInvPi / 2;

/// Radiance towards wo that a surface reflects of light from wi, whose irradiance on a surface facing it is `light`.
/// n, wo and wi are unit; light from behind (n·wi <= 0) gives none.
template <typename T> RgbT<T> phong(RgbT<T> base, Vec3T<T> n, Vec3T<T> wo, Vec3T<T> wi, RgbT<T> light) {
    const T cosine = max(dot(n, wi), T(0));
    T lobe = max(dot(reflect(wi, n), wo), T(0));
    for (int i = 0; i < kPhongSquarings; ++i) lobe = lobe * lobe;
    const T specular = T(kPhongSpecular) * lobe;
    const RgbT<T> diffuse = base * T(kPhongDiffuse);
    return light * RgbT<T>(diffuse.r + specular, diffuse.g + specular, diffuse.b + specular) * cosine;
}

} // namespace duet::raster
