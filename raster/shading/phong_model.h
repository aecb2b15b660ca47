// Implements the Phong reflection model: a diffuse term and a specular highlight around the mirror direction.
#pragma once

#include "common/vec/simd.h"
#include "raster/lighting/incident_light.h"

namespace duet::raster {

/// The BRDF has two terms: base color / π, and 4 % of the light in a lobe (m + 2)/(2π) · cosᵐ around the mirror
/// direction. The lobe reflects at most the incident energy for every direction (Phong 1975, "Illumination for
/// Computer Generated Images"; normalized as in Lafortune and Willems 1994, "Using the Modified Phong Reflectance
/// Model for Physically Based Rendering"). m = 32 = 2⁵ takes five squarings.
inline constexpr int kPhongSquarings = 5;
inline constexpr float kPhongDiffuse = kInvPi;
inline constexpr float kPhongSpecular = 0.04f * ((1 << kPhongSquarings) + 2) * kInvPi / 2;

/// Computes the factors of reflection from wi to wo: the incident cosine, clamped to 0, and the lobe cosᵐ of the
/// angle between wo and the mirror direction. kPhongSpecular scales the lobe to a BRDF. wi must be unit. Light from
/// behind (n·wi <= 0) has cosine 0.
template <typename T> struct PhongFactors {
    T cosine, lobe;

    PhongFactors(const Direction<T>& n, const Direction<T>& wo, Vec3T<T> wi) {
        const T arriving = dot(n.v, wi) * n.scale;
        cosine = max(arriving, T(0));
        const T leaving = dot(n.v, wo.v);
        // The lobe needs the cosine between the mirror direction and wo. Its three products do not depend on each
        // other.
        lobe = max(multiply_add(arriving, (leaving + leaving) * n.scale, -dot(wi, wo.v)) * wo.scale, T(0));
        for (int i = 0; i < kPhongSquarings; ++i) lobe = lobe * lobe;
    }
    bool behind() const { return none_of(cosine > T(0)); } ///< whether no lane receives light
};

/// Returns the radiance of a surface under all lights. `base` is the base color, `ambient` the radiance from all
/// directions, and position() returns the world-space point.
template <typename T, typename Position>
RgbT<T> phong(std::span<const Light> lights, Rgb ambient, RgbT<T> base, const Position& position,
              const Direction<T>& n, const Direction<T>& wo) {
    RgbT<T> sum = base * broadcast<T>(ambient);
    const RgbT<T> diffuse = base * T(kPhongDiffuse);
    for_each_incident(lights, position, [&](const IncidentT<T>& light) {
        const PhongFactors<T> f(n, wo, light.wi);
        if (f.behind()) return;
        const RgbT<T> arriving = light.irradiance * f.cosine;
        const auto reflected = [&](const T& base_over_pi) {
            return multiply_add(f.lobe, T(kPhongSpecular), base_over_pi);
        };
        sum = {multiply_add(arriving.r, reflected(diffuse.r), sum.r),
               multiply_add(arriving.g, reflected(diffuse.g), sum.g),
               multiply_add(arriving.b, reflected(diffuse.b), sum.b)};
    });
    return sum;
}

/// Stores the light at a point in two terms that do not depend on the base color, for shaders that compute it at the
/// vertices.
template <typename T> struct PhongLight {
    RgbT<T> irradiance; ///< W/m², includes the cosine
    RgbT<T> highlights; ///< radiance
};
/// Returns the light at the world-space point that position() returns.
template <typename T, typename Position>
PhongLight<T> phong_light(std::span<const Light> lights, const Position& position, const Direction<T>& n,
                          const Direction<T>& wo) {
    PhongLight<T> sum{RgbT<T>(T(0)), RgbT<T>(T(0))};
    for_each_incident(lights, position, [&](const IncidentT<T>& light) {
        const PhongFactors<T> f(n, wo, light.wi);
        if (f.behind()) return;
        const RgbT<T> arriving = light.irradiance * f.cosine;
        sum.irradiance += arriving;
        sum.highlights += arriving * (f.lobe * T(kPhongSpecular));
    });
    return sum;
}
/// Clamps interpolated light at 0, because a weight at a triangle's edge may round to a negative value.
template <typename T> PhongLight<T> clamp_nonnegative(const PhongLight<T>& light) {
    const auto each = [](const RgbT<T>& c) { return RgbT<T>(max(c.r, T(0)), max(c.g, T(0)), max(c.b, T(0))); };
    return {each(light.irradiance), each(light.highlights)};
}
/// Returns the radiance of a surface with base color `base` under the given light.
template <typename T> RgbT<T> phong(const PhongLight<T>& light, Rgb ambient, RgbT<T> base) {
    return base * (light.irradiance * T(kPhongDiffuse) + broadcast<T>(ambient)) + light.highlights;
}

/// Provides the common part of shaders that compute light in their vertex function, at world-space point p with
/// normal n. The light is interpolated, and the base color is evaluated per sample.
struct VertexLighting {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> using Varyings = PhongLight<T>;

    template <typename T> static Varyings<T> light(const VertexInput<T>& v, Vec3T<T> p, Vec3T<T> n) {
        return phong_light(std::span(v.object.data.scene.lights), [&] { return p; }, Direction<T>{n, T(1)},
                           Direction<T>{v.object.to_viewer(p), T(1)});
    }
    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        return f.with_emitted(phong(clamp_nonnegative(f.at), f.object.data.ambient, f.base_color()));
    }
};

} // namespace duet::raster
