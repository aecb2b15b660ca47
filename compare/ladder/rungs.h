// The rungs of the ladder: what is compared at each, and how either pipeline renders it by itself.
#pragma once

#include "compare/pipeline.h"
#include "raster/render.h"
#include "raytrace/render.h"

#include <array>
#include <string>
#include <vector>

namespace duet::compare {

/// The rungs in their fixed order. A cause of difference is named for the rung at which the traced quantity takes its
/// place.
struct RungName {
    const char* id;    ///< in files and keys
    const char* title; ///< the quantity
    const char* cause; ///< what a difference is called that goes away at this rung
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

/// The two pipelines, prepared for one scene, and what they share.
struct PreparedPair {
    raster::Prepared raster;
    raster::Settings raster_settings; ///< of the full picture
    raytrace::Prepared raytrace;
    raytrace::Settings raytrace_settings; ///< of the full picture; an even number of samples
};
PreparedPair prepare_pair(const Scene& scene, const PipelineSettings& settings);

/// Something that both pipelines render, alone: in Rendering::radiance, or, of rung 1, in Rendering::hit.
struct Quantity {
    std::string name;
    RenderFunction raster, raytrace;
    int raster_spp, raytrace_spp;
};

struct RungPlan {
    std::vector<Quantity> quantities;     ///< none where the scene does not have the rung's light
    std::string raster_way, raytrace_way; ///< how each comes by it: a sentence
    std::string note;                     ///< what the scene or the rasterizer lacks; empty: nothing
};

/// An approximation that the rasterizer learns belongs into its rung's settings here, and, where it makes light, into
/// raster::LightParts: the rest of the ladder follows.
std::array<RungPlan, kRungCount> plan_rungs(const Scene& scene, const PreparedPair& pair);

} // namespace duet::compare
