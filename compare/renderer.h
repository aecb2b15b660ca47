// This file provides the two pipelines behind one type, so that comparison code calls both in the same way.
#pragma once

#include "common/program/render_program.h"
#include "common/rendering.h"
#include "common/scene/scene.h"
#include "raster/render.h"
#include "raytrace/render.h"

#include <string>
#include <vector>

namespace duet::compare {

/// Holds settings that both renderings of a comparison share, and the sample count of each.
struct ComparisonSettings {
    int raster_spp = 16, raytrace_spp = 64;
    int max_depth = 64; ///< maximum number of scattering events of a path (path tracer)
    int threads = 0;    ///< 0: all hardware threads
    std::uint64_t seed = 0;
};

/// A Renderer is prepared for one scene, which must outlive it.
struct Renderer {
    std::string name;            ///< "raster" or "raytrace"
    RenderFunction render_image; ///< renders the full image
    RenderFunction render_hits;  ///< renders Rendering::hit: one ray per pixel through its center and the lens center,
                                 ///< when the shutter opens
    double prepare_seconds = 0;
};

/// Prepares the rasterizer for a scene.
Renderer raster_renderer(const Scene& scene, const ComparisonSettings& settings);
/// Prepares the path tracer for a scene.
Renderer raytrace_renderer(const Scene& scene, const ComparisonSettings& settings);

/// Returns the rasterizer's settings of the full image.
raster::RasterSettings raster_settings(const ComparisonSettings& settings);
/// Returns the path tracer's settings of the full image.
raytrace::PathTracerSettings path_tracer_settings(const ComparisonSettings& settings);
/// Returns the settings for Rendering::hit alone: one ray per pixel, and the cheapest shading.
raster::RasterSettings hit_settings(raster::RasterSettings settings);
raytrace::PathTracerSettings hit_settings(raytrace::PathTracerSettings settings);

/// Returns a function that renders the prepared scene of either pipeline.
template <typename Prepared, typename Settings>
RenderFunction render_function(const Prepared& prepared, const Settings& settings) {
    return
        [prepared, settings](const View& view, Control& control) { return render(prepared, view, settings, control); };
}

/// Returns Renderer::render_hits of the rasterizer alone, and prepares no shading.
RenderFunction raster_hits(const Scene& scene, const ComparisonSettings& settings);
/// Returns Renderer::render_hits of the path tracer alone.
RenderFunction raytrace_hits(const Scene& scene, const ComparisonSettings& settings);

/// Returns the view of the scene's camera, in the scene's image size.
View scene_view(const Scene& scene);
/// Returns the view with `scale` times the width and the height, rounded, each at least one pixel.
View scaled(View view, double scale);
/// Returns the view of the scene's camera in the given size or, for 0 × 0, in the scene's size times `scale`.
View scene_view(const Scene& scene, ImageSize size, double scale);

} // namespace duet::compare
