// Phong's model: diffuse light, and a highlight about the mirror direction.
#pragma once

#include "common/vec/float_bits.h"
#include "raster/shader/lights.h"

namespace duet::raster {

/// The BRDF's two parts: base colour / π, and 4 % of the light in a lobe (m + 2)/(2π) · cosᵐ about the mirror
/// direction, which no direction makes more of than it receives (Phong 1975, «Illumination for Computer Generated
/// Pictures»; normalized as in Lafortune and Willems 1994, «Using the Modified Phong Reflectance Model for Physically
/// Based Rendering»). m = 32 = 2⁵: five squarings.
inline constexpr int kPhongSquarings = 5;
inline constexpr float kPhongDiffuse = kInvPi;
inline constexpr float kPhongSpecular = 0.04f * ((1 << kPhongSquarings) + 2) * kInvPi / 2;

/// What becomes of light from wi: the cosine at which it arrives, and what of the highlight's middle wo has, of which
/// kPhongSpecular by solid angle is sent on. wi is unit; light from behind (n·wi <= 0) gives none.
template <typename T> struct PhongFactors {
    T cosine, lobe;

    PhongFactors(const Direction<T>& n, const Direction<T>& wo, Vec3T<T> wi) {
        const T arriving = dot(n.v, wi) * n.scale;
        cosine = max(arriving, T(0));
        const T leaving = dot(n.v, wo.v);
        // The mirror direction's cosine with wo; three products that need not wait for each other.
        lobe = max(fused(arriving, (leaving + leaving) * n.scale, -dot(wi, wo.v)) * wo.scale, T(0));
        for (int i = 0; i < kPhongSquarings; ++i) lobe = lobe * lobe;
    }
    bool behind() const { return none_of_lanes(cosine > T(0)); } ///< gives no light at all
};

/// Radiance of a surface of a base colour under all lights, `ambient` being the radiance from all around; place() is its
/// point in the world.
template <typename T, bool kSuns, typename Place>
RgbT<T> phong(Lights<kSuns> lights, Rgb ambient, RgbT<T> base, const Place& place, const Direction<T>& n, const Direction<T>& wo) {
    RgbT<T> sum = base * spread<T>(ambient);
    const RgbT<T> diffuse = base * T(kPhongDiffuse);
    for_each_incident(lights, place, [&](const IncidentT<T>& light) {
        const PhongFactors<T> f(n, wo, light.wi);
        if (f.behind()) return;
        const RgbT<T> arriving = light.irradiance * f.cosine;
        const auto reflected = [&](const T& base_over_pi) { return fused(f.lobe, T(kPhongSpecular), base_over_pi); };
        sum = {fused(arriving.r, reflected(diffuse.r), sum.r), fused(arriving.g, reflected(diffuse.g), sum.g),
               fused(arriving.b, reflected(diffuse.b), sum.b)};
    });
    return sum;
}

/// The same in two parts, before the base colour is known: for who works it out elsewhere than the sample.
template <typename T> struct PhongLight {
    RgbT<T> irradiance; ///< W/m², cosine and all
    RgbT<T> highlights; ///< radiance
};
template <typename T, typename Place>
PhongLight<T> phong_light(Lights<false> lights, const Place& place, const Direction<T>& n, const Direction<T>& wo) {
    PhongLight<T> sum{RgbT<T>(T(0)), RgbT<T>(T(0))};
    for_each_incident(lights, place, [&](const IncidentT<T>& light) {
        const PhongFactors<T> f(n, wo, light.wi);
        if (f.behind()) return;
        const RgbT<T> arriving = light.irradiance * f.cosine;
        sum.irradiance += arriving;
        sum.highlights += arriving * (f.lobe * T(kPhongSpecular));
    });
    return sum;
}
/// Light interpolated: at a triangle's edge a weight may round to less than none, light may not.
template <typename T> PhongLight<T> not_negative(const PhongLight<T>& light) {
    const auto each = [](const RgbT<T>& c) { return RgbT<T>(max(c.r, T(0)), max(c.g, T(0)), max(c.b, T(0))); };
    return {each(light.irradiance), each(light.highlights)};
}
template <typename T> RgbT<T> phong(const PhongLight<T>& light, Rgb ambient, RgbT<T> base) {
    return base * (light.irradiance * T(kPhongDiffuse) + spread<T>(ambient)) + light.highlights;
}

/// What shaders have in common that work light out in their vertex function, at point p for normal n, both in the world:
/// it is interpolated, and the base colour is each sample's own.
struct LightAtVertices {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> using Varyings = PhongLight<T>;

    template <typename T> static Varyings<T> light(const VertexInput<T>& v, Vec3T<T> p, Vec3T<T> n) {
        return phong_light(Lights<false>{v.object.data.scene.lights}, [&] { return p; }, Direction<T>{n, T(1)},
                           Direction<T>{v.object.to_viewer(p), T(1)});
    }
    template <typename T, typename F> RgbT<T> fragment(const F& f) const {
        return f.with_emitted(phong(not_negative(f.at), f.object.data.ambient, f.base_color()));
    }
};

} // namespace duet::raster
