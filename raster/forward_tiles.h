// Renders tiles with a shader program (forward shading): it determines coverage, then shades the visible samples.
#pragma once

#include "raster/frame_context.h"
#include "raster/output/framebuffer.h"
#include "raster/visibility/depth_tile.h"

namespace duet::raster {

/// Renders one tile: determines the coverage of each sample, then shades it with the program.
void render_tile(const FrameContext& frame, const PassView& view, std::size_t index, Framebuffer& framebuffer);
/// Renders one tile with multisampling: determines the coverage of all samples, then shades each primitive once.
void render_multisampled_tile(const FrameContext& frame, const PassView& view, std::size_t index,
                              Framebuffer& framebuffer);
/// Visits the samples of a tile one by one. Adds their auxiliary values and, in front of transparent layers, the
/// program's radiance.
void visit_samples(const FrameContext& frame, const PassView& view, std::size_t index, const DepthTile& depths,
                   Framebuffer& framebuffer);

} // namespace duet::raster
