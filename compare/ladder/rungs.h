// This file declares the rungs of the ladder: the quantity that each one compares, and how each pipeline renders it
// separately.
#pragma once

#include "compare/renderer.h"
#include "raster/render.h"
#include "raytrace/render.h"

#include <array>
#include <string>
#include <vector>

namespace duet::compare {

/// These are the rungs in their fixed order. A cause of difference is named after the rung at which the traced quantity
/// replaces the approximation.
struct RungName {
    const char* id;    ///< identifier in files and keys
    const char* title; ///< name of the quantity
    const char* cause; ///< name of the difference that disappears at this rung
};
inline constexpr std::size_t kRungCount = 7;
inline constexpr std::array<RungName, kRungCount> kRungNames{{
    {"visibility", "Visibility", "visibility: edges, lens, motion"},
    {"normals", "Normals and albedo", "normals and albedo"},
    {"direct", "Direct light without shadows", "unshadowed direct light"},
    {"shadows", "Direct light with shadows", "shadows"},
    {"environment", "Ambient and environment light", "environment light and its occlusion"},
    {"reflections", "Reflections", "reflections and refractions"},
    {"everything", "Everything", "indirect light"},
}};

/// Each is the part of the rasterizer's light that a rung compares alone.
///@{
inline constexpr raster::LightComponentSet kLightsAlone{
    .emission = true, .direct = true, .environment = false, .reflection = false};
inline constexpr raster::LightComponentSet kEnvironmentAlone{
    .emission = false, .direct = false, .environment = true, .reflection = false};
inline constexpr raster::LightComponentSet kReflectionAlone{
    .emission = false, .direct = false, .environment = false, .reflection = true};
///@}

/// Holds both pipelines, prepared for the same scene.
struct PreparedPair {
    raster::RasterScene raster;
    raster::RasterSettings raster_settings; ///< of the full image
    raytrace::PathTracerScene raytrace;
    raytrace::PathTracerSettings raytrace_settings; ///< of the full image, with an even number of samples
};
/// Prepares the scene for both pipelines. The scene must outlive the result. An odd number of raytrace_spp is rounded
/// up.
PreparedPair prepare_pair(const Scene& scene, const ComparisonSettings& settings);

/// Describes a quantity that both pipelines can render separately: in Rendering::radiance or, for rung 1, in
/// Rendering::hit.
struct RungRenderers {
    std::string name;
    raster::RasterSettings raster_settings;
    raytrace::PathTracerSettings raytrace_settings;
    RenderFunction raster, raytrace; ///< render functions with these settings
};

/// Says what both pipelines render at a rung.
struct RungPlan {
    std::vector<RungRenderers> renderers;       ///< empty if the scene does not have the rung's light
    std::string raster_method, raytrace_method; ///< how each pipeline computes the quantity, as a sentence
    std::string note;                     ///< what the scene or the rasterizer lacks; empty: nothing
};

/// Returns what both pipelines render at each rung. A new approximation of the rasterizer must be added to the settings
/// of its rung here and, if it contributes light, to raster::LightComponentImages. The rest of the ladder needs no
/// change.
std::array<RungPlan, kRungCount> plan_rungs(const Scene& scene, const PreparedPair& pair);

} // namespace duet::compare
