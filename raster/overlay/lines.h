// Lines of single pixels: every edge of triangles and quads, through whatever is before it.
#pragma once

#include "raster/geometry/geometry.h"

#include "common/image/image.h"

namespace duet::raster {

/// Marks the pixels of the line between two points of the sub-pixel grid, for samples of one place in their pixels. Of a
/// line that runs along x rather than along y (or as much): in each column of samples from its left end on and before its
/// right end, the pixel whose sample is nearest to it; of two the one with the lower number. So a line that goes on as
/// another marks no column twice. The midpoint algorithm (Bresenham 1965, «Algorithm for Computer Control of a Digital Plotter»;
/// tinyrenderer, lesson 1) with ends that need not be pixels' centres, exact in integers for coordinates below 2^25.
void draw_line(FixedPoint a, FixedPoint b, SampleOffset offset, Image<std::uint8_t>& marks);

/// The part of a line before the near plane and within a pixel of the picture, snapped; false where there is none.
bool clip_line(const PixelVertex& a, const PixelVertex& b, const Viewport& viewport, FixedPoint& from, FixedPoint& to);

/// Marks all edges of the scene's triangles and quads (whose diagonals are none) for a sample's place. Spheres have none.
/// The same for any number of threads.
void draw_lines(const PreparedData& data, const PassView& view, SampleOffset offset, int threads, Image<std::uint8_t>& marks);

} // namespace duet::raster
