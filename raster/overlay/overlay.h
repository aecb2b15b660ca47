// Implements stage 10, which draws lines and edges over a finished image.
#pragma once

#include "raster/overlay/edges.h"
#include "raster/raster_scene.h"

namespace duet::raster {

/// Returns true if these settings draw edges.
bool draws_edges(const RasterSettings& settings);

/// Accumulates over all passes how much of each pixel lines or edges cover. The references must outlive it.
class Overlay {
public:
    Overlay(const RasterSceneData& data, const RasterSettings& settings, const View& view)
        : data_(data), settings_(settings), sums_(view.width, view.height, 0.0f) {}

    /// Adds the lines of one pass, for each of its samples.
    void add_lines(const PassView& view);
    /// Adds the edges of one pass.
    void add_edges(const EdgeBuffer& edge_buffer);
    /// Draws the result: white lines on black, black edges on white, or black edges over the image.
    void composite(ImageRgb& shown_image) const;

private:
    const RasterSceneData& data_;
    const RasterSettings& settings_;
    ImageFloat sums_;
    int samples_ = 0;
};

} // namespace duet::raster
