// This header lists the materials that tests iterate over and measures their albedo.
#pragma once

#include "common/material/material.h"
#include "raytrace/sampling/sampler.h"

#include <cmath>
#include <string>
#include <vector>

namespace duet {

/// Returns a unit vector at height z and azimuth phi in radians.
inline Vec3 direction(float z, float phi) {
    const float r = std::sqrt((1 - z) * (1 + z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

struct NamedBsdf {
    std::string name;
    Bsdf bsdf;
    float narrowest = 1;   ///< alpha of the narrowest lobe
    bool lossless = false; ///< true if it absorbs nothing
    double found = 0.997;  ///< lower bound of the density's integral; the remaining samples fall below the surface
};

inline LayeredBsdf layers(Rgb color, float metallic, float roughness, float coat = 0, float coat_roughness = 0) {
    return LayeredBsdf({color, metallic, 0.04f, roughness, coat, coat_roughness});
}
inline Bsdf coated(Rgb albedo, float roughness) { return bsdf_at(Coated{{albedo}, roughness}, {}, SurfacePoint{}); }
inline Bsdf gold(float alpha) { return MetalBsdf(*find_conductor("gold"), alpha); }

/// Returns the non-specular reflective materials.
inline std::vector<NamedBsdf> rough_materials() {
    const Rgb red(0.8f, 0.5f, 0.2f), white(1.0f);
    return {{"diffuse", DiffuseBsdf{red}},
            {"metal 1", MetalBsdf{Rgb(0.9f, 0.6f, 0.3f), 1.0f}, 1, false, 0.45},
            {"metal 0.3", MetalBsdf{white, 0.3f}, 0.3f, true, 0.8},
            {"metal 0.05", MetalBsdf{Rgb(0.5f), 0.05f}, 0.05f, false, 0.8},
            {"white metal 1", MetalBsdf{white, 1.0f}, 1, true, 0.45},
            {"gold 0.1", gold(0.1f), 0.1f, false, 0.8},
            {"gold 0.5", gold(0.5f), 0.5f, false, 0.6},
            {"clay 0.3", RoughDiffuseBsdf{red, 0.3f}},
            {"clay 1", RoughDiffuseBsdf{red, 1}},
            {"white clay 1", RoughDiffuseBsdf{white, 1}, 1, true},
            {"plastic 0.3", coated(red, 0.55f), 0.3f, false, 0.8},
            {"white plastic 0.3", coated(white, 0.55f), 0.3f, true, 0.8},
            {"white plastic 1", coated(white, 1), 1, true, 0.5},
            {"principled 0.5", layers(red, 0.5f, 0.6f), 0.36f, false, 0.8},
            {"white principled 0.4, metal", layers(white, 1, 0.6f), 0.36f, true, 0.8},
            {"white principled 0.4, dielectric", layers(white, 0, 0.6f), 0.36f, true, 0.8},
            {"clear coat", layers(red, 0.3f, 0.8f, 0.7f, 0.5f), 0.25f, false, 0.6}};
}
/// Returns the non-specular transmissive materials.
inline std::vector<NamedBsdf> frosted_materials() {
    return {{"frosted glass 0.3", RoughDielectricBsdf{1.5f, Rgb(1.0f), 0.3f}, 0.3f, true, 0.8},
            {"frosted water 0.5", RoughDielectricBsdf{1.33f, Rgb(0.9f, 1.0f, 0.8f), 0.5f}, 0.5f, false, 0.6},
            {"frosted diamond 1", RoughDielectricBsdf{2.4f, Rgb(1.0f), 1.0f}, 1, true, 0.4}};
}
inline std::vector<NamedBsdf> all_materials() {
    std::vector<NamedBsdf> all = rough_materials();
    for (NamedBsdf& frosted : frosted_materials()) all.push_back(std::move(frosted));
    all.push_back({"metal 0.001", MetalBsdf{Rgb(0.9f), 0.001f}});
    all.push_back({"frosted 0.0005", RoughDielectricBsdf{1.5f, Rgb(1.0f), 0.0005f}});
    all.push_back({"shiny plastic", coated(Rgb(0.7f), 0)});
    all.push_back({"mirror", MetalBsdf{Rgb(0.9f, 0.8f, 0.7f), 0.0f}});
    all.push_back({"gold mirror", gold(0)});
    all.push_back({"glass", DielectricBsdf{1.5f, Rgb(0.9f, 1.0f, 0.8f)}});
    all.push_back({"air", DielectricBsdf{1.0f, Rgb(1.0f)}});
    all.push_back({"diamond", DielectricBsdf{2.4f, Rgb(1.0f)}});
    all.push_back({"window", ThinDielectricBsdf{1.5f, Rgb(0.9f, 1.0f, 0.8f)}});
    all.push_back({"clear window", ThinDielectricBsdf{1.5f, Rgb(1.0f)}, 1, true});
    all.push_back({"black film of no index", ThinDielectricBsdf{1.0f, Rgb(0.0f)}});
    all.push_back({"frosted, hardly refracting", RoughDielectricBsdf{1.002f, Rgb(1.0f), 0.3f}});
    return all;
}

/// The cosines of wo range from straight above to 1e-7, on both sides.
inline constexpr float kCosines[] = {1.0f,  0.999f, 0.7f,   0.3f,  0.05f, 1e-3f, 1e-5f,
                                     1e-7f, -1e-7f, -1e-4f, -0.2f, -0.9f, -1.0f};

/// Calls f(lobe, u) for a jittered set of `n` random samples and for all corners of the unit cube.
template <typename F> void for_numbers(int n, F f) {
    for (const float x : {0.0f, kOneMinusEpsilon})
        for (const float y : {0.0f, kOneMinusEpsilon})
            for (const float z : {0.0f, kOneMinusEpsilon}) f(x, Vec2{y, z});
    Sampler sampler(SamplerKind::kSobol, 17, n);
    for (int i = 0; i < n; ++i) {
        sampler.start(0, 0, static_cast<std::uint32_t>(i));
        const float lobe = sampler.get_2d().x;
        f(lobe, sampler.get_2d());
    }
}

/// Returns the fraction of uniform incident light of radiance 1 that is scattered to wo, as the mean sample weight.
inline Rgbd albedo(const Bsdf& bsdf, Vec3 wo, TransportMode mode, int n) {
    Rgbd sum;
    Sampler sampler(SamplerKind::kSobol, 23, n);
    for (int i = 0; i < n; ++i) {
        sampler.start(0, 0, static_cast<std::uint32_t>(i));
        const float lobe = sampler.get_2d().x;
        if (const auto s = sample(bsdf, wo, lobe, sampler.get_2d(), mode)) sum += Rgbd(s->weight);
    }
    return sum / static_cast<double>(n);
}

} // namespace duet
