// This file defines layered reflection (varnish, plastic, lacquered metal): a glossy layer over a diffuse or metallic
// base, with a clear coat on top.
#pragma once

#include "common/image/rgb.h"
#include "common/material/bsdf.h"

namespace duet {

/// A GlossyLayer is a lobe of GGX microfacets with Schlick's Fresnel term and multiple-scattering compensation, as in
/// MetalBsdf.
struct GlossyLayer {
    Rgb f0;         ///< reflectance at normal incidence
    float alpha;    ///< GGX width, at least LayeredBsdf::kSmoothest
    Rgb multiple_scattering; ///< factor of the multiple-scattering lobe (ggx_multiple_scattering)
};

/// A LayeredBsdf is a stack of layers. The base is a diffuse surface under a dielectric, mixed with a metal of the
/// same roughness. A clear coat covers both.
///
/// Light that a layer reflects does not reach the layer below. The diffuse surface is attenuated by 1 − E(wi) and
/// 1 − E(wo), where E is the directional albedo of the layer above. The product is normalized so that a white
/// surface under a clear dielectric reflects all light (Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled
/// Specular-Matte BRDF Model with Importance Sampling", §4). The base under the coat is multiplied by
/// 1 − max(E(wo), E(wi)), so that a mirror under the coat reflects all light.
///
/// The BSDF is reciprocal and acts on both sides of the surface. It never reflects more light than it receives
/// (tested).
struct LayeredBsdf {
    static constexpr float kSmoothest = 1e-3f; ///< least alpha; no lobe is a perfect mirror

    Rgb diffuse;         ///< albedo of the diffuse surface times its fraction of the mix
    GlossyLayer glossy;  ///< dielectric and metal, mixed
    float dielectric;    ///< reflectance of the dielectric alone at normal incidence
    float dielectric_multiple;
    float coat;          ///< fraction of the surface that the coat covers, in [0, 1]
    float coat_alpha, coat_multiple;

    /// This is the reflectance at normal incidence of a coat with index of refraction 1.5.
    static constexpr float kCoatF0 = 0.04f;

    struct Description {
        Rgb color;            ///< albedo of the diffuse surface, and the metal's reflectance at normal incidence
        float metallic = 0;   ///< metal's fraction of the mix, in [0, 1]
        float dielectric = 0.04f;
        float roughness = 0;
        float coat = 0, coat_roughness = 0;
    };
    explicit LayeredBsdf(const Description& d);

    /// Returns the BSDF without the cosine; black where wo and wi are on different sides.
    Rgb eval(Vec3 wo, Vec3 wi, TransportMode mode) const;
    /// Draws wi. `lobe` in [0, 1) chooses the layer.
    std::optional<BsdfSample> sample(Vec3 wo, float lobe, Vec2 u, TransportMode mode) const;
    /// Returns the density, by solid angle, with which sample draws wi.
    float pdf(Vec3 wo, Vec3 wi, TransportMode mode) const;

    /// Albedos holds the directional albedo of each layer: the fraction of uniform incident light that the layer
    /// sends to the viewer.
    struct Albedos {
        Rgb diffuse, glossy, coat;
    };
    /// Returns the albedos for a viewer at the angle of this cosine, in [0, 1].
    Albedos albedos(float cosine) const;
    /// Returns the fraction of the light from this cosine, in [0, 1], that passes the dielectric and the coat.
    float passed(float cosine) const;
    /// Returns the fraction of diffuse light that passes the dielectric and the coat: the cosine-weighted mean of
    /// passed(), at least 0.0001.
    float mean_passed() const;
};

} // namespace duet
