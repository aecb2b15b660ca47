// Defines the settings of the rasterizer.
#pragma once

#include "common/rendering.h"

namespace duet::raster {

enum class Shading {
    kLit,       ///< materials and lights, by deferred shading (raster/shading/deferred.h)
    kPhong,     ///< Phong's model: diffuse light and highlights of the lights, the environment's mean as ambient light
    kGouraud,   ///< Phong's model, computed at the vertices and interpolated
    kFlat,      ///< Phong's model, evaluated once per triangle
    kToon,      ///< Phong's model, quantized into bands
    kWireframe, ///< edges with hidden lines removed
    kLines,     ///< edges as one-pixel lines, white on black, without hidden-line removal
    kEdges,     ///< RasterSettings::edges alone, black on white
    kNormal,    ///< shading normals as colors: (n + 1)/2
    kAlbedo,    ///< base colors
    kDepth,     ///< d / (d + depth), where d is the distance from the camera to its look-at point
};

/// Selects the components of light that Shading::kLit computes (LightComponentImages in raster/shading/deferred.h).
struct LightComponentSet {
    bool emission = true, direct = true, environment = true, reflection = true;

    bool all() const { return emission && direct && environment && reflection; }
};

/// Selects the output format of a rendering.
enum class Output {
    kRadiance,      ///< Rendering::radiance and the requested auxiliary images
    kSrgb8,         ///< Rendering::srgb; with one sample per pixel, each is encoded as soon as it is shaded
    kReversedDepth, ///< Rendering::reversed_depth: reversed depth only, e.g. for a shadow map; nothing is shaded
};

/// Holds the settings of the rasterizer.
struct RasterSettings : RenderSettings {
    Shading shading = Shading::kLit;
    Output output = Output::kRadiance; ///< kReversedDepth uses only one sample per pixel
    bool front_faces_only = false;     ///< cull back faces of all meshes and quads, as real-time renderers do
    /// Multisampling (raster/visibility/multisample.h) takes 2, 4, 8 or 16 samples per pixel for coverage and depth,
    /// and shades once per primitive. 0 turns it off. It requires samples_per_pixel = 1, and uses the lens center and
    /// the time the shutter opens.
    int multisamples = 0;
    bool sample_shading = false;  ///< with multisamples: shade each sample, as supersampling does
    /// Returns whether multisamples are shaded one by one. Deferred shading always does this, because its effects read
    /// neighboring pixels, and only the first primitive of a pixel has them.
    bool shades_each_sample() const { return sample_shading || shading == Shading::kLit; }
    bool edges = false;           ///< draw lines where depth, normals or objects change (raster/overlay/edges.h)
    LightComponentSet components; ///< components can be turned off, to examine others or to measure their cost
    bool shadows = true; ///< Shading::kLit: use shadow maps; prepare() must be called with this setting, too
    /// A shadow map has this many texels per side, in [64, 8192]. Each face of a cube map has half as many, and each
    /// map of an area light a quarter. Maps are smaller if all of them would take too much memory.
    int shadow_map_side = 2048;
    int shadow_cells = 2; ///< a rectangular light is divided into this many cells per side, in [1, 8], each with a map
    /// Shading::kLit: GTAO on diffuse surfaces (raster/screen_space/gtao.h). prepare() must be called with it,
    /// too, because mirrors show it.
    bool ambient_occlusion = true;
    /// Shading::kLit: diffuse light between surfaces, from irradiance probes; prepare() must be called with it, too.
    bool indirect_light = true;
    bool subsurface = true; ///< Shading::kLit: subsurface scattering of solids (raster/screen_space/subsurface.h)
    bool fog = true; ///< Shading::kLit: media (raster/fog/fog_grid.h); prepare() must be called with this setting, too
    /// Without indirect light, occluders of the environment are at most this far away, in meters. 0 stands for half of
    /// the minimum of the scene's diagonal and the distance from the camera's eye to its look-at point. With indirect
    /// light, the probes see distant occluders, and the limit is half of their spacing.
    double occlusion_radius = 0;
    /// Turns on the environment as a light and as the background. Without it there are only area, point, spot and sun
    /// lights.
    bool environment = true;
};

} // namespace duet::raster
