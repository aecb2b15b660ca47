// Defines the G-buffer of deferred shading. It stores each pixel's visible surface once, for stages that each add one
// effect (Saito and Takahashi 1990, "Comprehensible Rendering of 3-D Shapes"; Akenine-Möller et al. 2018, "Real-Time
// Rendering", §20.1).
#pragma once

#include "raster/gbuffer/plane.h"
#include "raster/gbuffer/screen_projection.h"

namespace duet::raster {

/// Selects the planes that only some scenes need.
struct OptionalPlanes {
    bool coat = false; ///< a material has a clear coat
    bool tint = false; ///< the tint of a glass varies
};

/// Holds one visible surface per pixel as a structure of arrays. Every opaque material is reduced to the same lobes:
/// Lambert's diffuse lobe, a GGX specular lobe with Schlick's Fresnel term, and a clear coat. Each stage thus has one
/// formula for all materials.
struct GBuffer {
    ScreenProjection projection;
    PlaneFloat reversed_depth;  ///< near / depth, in (0, 1]; 0 for the background
    Planes3 normal;             ///< unit shading normal on the viewer's side, in world space
    /// This is the height of the smooth surface above the flat triangle that approximates it, in meters along the
    /// normal; 0 in hollows. Shadow maps are sampled at this height, because coarse meshes would shade themselves
    /// otherwise (Hanika 2021, "Hacking the Shadow Terminator").
    PlaneFloat bulge;
    /// This is the fraction of diffusely incident light that the diffuse lobe reflects to this viewer. Light that the
    /// layers above absorb or reflect is already subtracted.
    Planes3 diffuse;
    Planes3 specular;           ///< reflectance of the specular lobe at normal incidence; 0: no specular lobe
    PlaneFloat alpha;           ///< GGX width of the specular lobe, in [0, 1]; below MetalBsdf::kSmoothAlpha a mirror
    PlaneFloat coat;            ///< fraction covered by the clear coat, in [0, 1]; empty if no material has one
    PlaneFloat coat_alpha;      ///< GGX width of the coat; empty if no material has one
    Planes3 tint;               ///< fraction of light that glass transmits at a crossing; empty if no tint varies
    PlaneInt object;            ///< index into Scene::objects; unspecified in the background
    PlaneInt material;          ///< index into Scene::materials; unspecified in the background
    /// These are points relative to the eye, for surfaces that a caller found along its own rays
    /// (raster/shading/hit_shader.h). The planes are empty for rasterized surfaces, whose points follow from their
    /// pixels and depths.
    Planes3 position;
    bool eye_enclosed = false;  ///< whether an object that is left out encloses the eye and hides it from the surfaces

    GBuffer(const ScreenProjection& view, int width, int height, OptionalPlanes planes);
    int width() const { return reversed_depth.width(); }
    int height() const { return reversed_depth.height(); }
    /// Returns the points of a batch of pixels, relative to the eye. Those of the background are at a finite distance.
    Vec3T<Floats> points(int x, int y) const {
        if (!position.empty()) return position.vector(x, y);
        const Floats depth = load(reversed_depth, x, y);
        return projection.point(Floats(static_cast<float>(x)) + load(kLanesAsFloats, 0),
                                Floats(static_cast<float>(y)),
                                xsimd::select(depth > Floats(0.0f), depth, Floats(1.0f)));
    }
    /// Returns the lanes of a batch in which a surface is visible.
    xsimd::batch_bool<float> visible(int x, int y) const { return load(reversed_depth, x, y) > Floats(0.0f); }
    std::size_t memory_bytes() const;
};

} // namespace duet::raster
