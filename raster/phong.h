// Phong's model: diffuse light, and a highlight about the mirror direction.
#pragma once

#include "raster/lights.h"

#include <span>

namespace duet::raster {

/// The BRDF's two parts: base colour / π, and 4 % of the light in a lobe (m + 2)/(2π) · cosᵐ about the mirror
/// direction, which no direction makes more of than it receives (Phong 1975, «Illumination for Computer Generated
/// Pictures»; normalized as in Lafortune and Willems 1994, «Using the Modified Phong Reflectance Model for Physically
/// Based Rendering»). m = 32 = 2⁵: five squarings.
inline constexpr int kPhongSquarings = 5;
inline constexpr float kPhongDiffuse = kInvPi;
inline constexpr float kPhongSpecular = 0.04f * ((1 << kPhongSquarings) + 2) * kInvPi / 2;

/// What reaches a surface, and what its highlights send on.
template <typename T> struct PhongLight {
    RgbT<T> irradiance; ///< W/m², cosine and all
    RgbT<T> highlights; ///< radiance
};

/// Of light from wi, whose irradiance on a surface facing it is `light`. n, wo and wi are unit; light from behind
/// (n·wi <= 0) gives none.
template <typename T> PhongLight<T> phong(Vec3T<T> n, Vec3T<T> wo, Vec3T<T> wi, RgbT<T> light) {
    const T cosine = max(dot(n, wi), T(0));
    T lobe = max(dot(reflect(wi, n), wo), T(0));
    for (int i = 0; i < kPhongSquarings; ++i) lobe = lobe * lobe;
    const RgbT<T> irradiance = light * cosine;
    return {irradiance, irradiance * (T(kPhongSpecular) * lobe)};
}

/// Of all lights, at the point of the world that place() returns.
template <typename T, typename Place>
PhongLight<T> phong(std::span<const Light> lights, const Place& place, Vec3T<T> n, Vec3T<T> wo) {
    PhongLight<T> sum{RgbT<T>(T(0)), RgbT<T>(T(0))};
    for (const Light& light : lights) {
        const IncidentT<T> arriving = incident(light, place());
        const PhongLight<T> one = phong(n, wo, arriving.wi, arriving.irradiance);
        sum.irradiance += one.irradiance;
        sum.highlights += one.highlights;
    }
    return sum;
}

/// Radiance of a surface of a base colour, `ambient` being the radiance from all around.
template <typename T> RgbT<T> phong(RgbT<T> base, const PhongLight<T>& light, Rgb ambient) {
    return base * (light.irradiance * T(kPhongDiffuse) + spread<T>(ambient)) + light.highlights;
}

} // namespace duet::raster
