// The two pipelines as one type: whoever compares them calls both alike.
#pragma once

#include "common/film/rendering.h"
#include "common/program/render_program.h"
#include "common/scene/scene.h"

#include <string>
#include <vector>

namespace duet::compare {

/// What both renderings of a comparison share, and each one's number of samples.
struct PipelineSettings {
    int raster_spp = 16, raytrace_spp = 64;
    int max_depth = 64; ///< the path tracer's scattering events at most
    int threads = 0;    ///< 0: all
    std::uint64_t seed = 0;
};

/// One way from a scene to a picture, prepared for one scene, which must outlive it.
struct Pipeline {
    std::string name;       ///< "raster" or "raytrace"
    RenderFunction picture; ///< the full picture
    RenderFunction hits; ///< Rendering::hit of one ray a pixel: through its centre and the lens's, as the shutter opens
    double prepare_seconds = 0;
};

Pipeline raster_pipeline(const Scene& scene, const PipelineSettings& settings);
Pipeline raytrace_pipeline(const Scene& scene, const PipelineSettings& settings);

/// The sentences (a rendering's approximations), a space between them.
std::string paragraph(const std::vector<std::string>& sentences);

} // namespace duet::compare
