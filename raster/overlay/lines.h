// Draws one-pixel lines along all edges of triangles and quads, without hidden-line removal.
#pragma once

#include "raster/geometry/geometry.h"

#include "common/image/image.h"

namespace duet::raster {

/// Marks the pixels of the line between two points on the sub-pixel grid, for samples at `offset` in their pixels.
/// For a line that runs mainly along x (or at 45°), it marks in each column of samples from the left end
/// (inclusive) to the right end (exclusive) the pixel whose sample is nearest to the line; of two equally near
/// ones, the one with the lower index. Consecutive segments thus mark no column twice. It is the midpoint algorithm
/// (Bresenham 1965, "Algorithm for Computer Control of a Digital Plotter"; tinyrenderer, lesson 1) for end points
/// that need not be pixel centers. It is exact in integers for coordinates below 2^25.
void draw_line(FixedPoint a, FixedPoint b, SampleOffset offset, Image<std::uint8_t>& marks);

/// Clips a line to the near plane and to the image with a border of one pixel, and snaps its ends. Returns false if
/// nothing is left.
bool clip_line(const PixelVertex& a, const PixelVertex& b, const Viewport& viewport, FixedPoint& from, FixedPoint& to);

/// Marks all edges of the scene's triangles and quads for samples at `offset`. Quads' diagonals are not edges, and
/// spheres have none. The result is the same for any number of threads.
void draw_lines(const RasterSceneData& data, const PassView& view, SampleOffset offset, int threads,
                Image<std::uint8_t>& marks);

} // namespace duet::raster
