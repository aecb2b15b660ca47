#include "raster/gbuffer/surface_lobes.h"

namespace duet::raster {
namespace {

Rgb outer_reflectance(float eta) { return Rgb(sqr((eta - 1) / (eta + 1))); }

struct LobesOf {
    float cosine;

    SurfaceLobes operator()(const DiffuseBsdf& b) const { return {.diffuse = b.albedo, .specular = {}}; }
    /// The directional albedo is exact under uniform light, and close under light from an area.
    SurfaceLobes operator()(const RoughDiffuseBsdf& b) const { return {.diffuse = b.reflected(cosine), .specular = {}}; }
    SurfaceLobes operator()(const MetalBsdf& b) const {
        return {.diffuse = {}, .specular = b.reflectance, .alpha = b.alpha};
    }
    SurfaceLobes operator()(const LayeredBsdf& b) const {
        return {.diffuse = b.albedos(cosine).diffuse,
                .specular = b.glossy.normal,
                .alpha = b.glossy.alpha,
                .coat = b.coat,
                .coat_alpha = b.coat_alpha};
    }
    SurfaceLobes operator()(const RoughDielectricBsdf& b) const {
        return {.diffuse = {}, .specular = outer_reflectance(b.eta), .alpha = b.alpha};
    }
    SurfaceLobes operator()(const DielectricBsdf& b) const {
        return {.diffuse = {}, .specular = outer_reflectance(b.eta), .alpha = 0};
    }
    SurfaceLobes operator()(const ThinDielectricBsdf&) const { return {.diffuse = {}, .specular = {}, .alpha = 0}; }
};

} // namespace

SurfaceLobes surface_lobes(const Bsdf& bsdf, float cosine) { return std::visit(LobesOf{cosine}, bsdf); }

} // namespace duet::raster
