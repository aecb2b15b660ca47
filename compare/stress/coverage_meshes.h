// Triangles and meshes of the sub-pixel grid that try the rules of coverage.
#pragma once

#include "compare/stress/drawing.h"
#include "compare/stress/trials.h"

#include <vector>

namespace duet::compare {

/// Pixels anywhere in a picture of up to kMaxPictureSide a side, their sample at any place of the pixel, one in four
/// at its centre.
Window random_window(TrialRandom& random, int side);

/// A point of the grid in the window; every other one lies on a sample.
raster::FixedPoint point_in(TrialRandom& random, const Window& window);

/// A triangle whose corners or edges pass near or through samples of the window: `kind` in [0, kTriangleKinds).
inline constexpr std::uint32_t kTriangleKinds = 8;
GridTriangle random_triangle(TrialRandom& random, const Window& window, std::uint32_t kind);

/// Meshes with the form of a disk whose border runs once around the window. So, whatever their inner vertices do, the
/// triangles that cover a sample and run clockwise are one more than those that run the other way.
std::vector<GridTriangle> random_fan(TrialRandom& random, const Window& window);   ///< 4 to 64 around one vertex
std::vector<GridTriangle> random_strip(TrialRandom& random, const Window& window); ///< slivers, side by side
std::vector<GridTriangle> random_grid(TrialRandom& random, const Window& window);  ///< jittered or wildly folded

} // namespace duet::compare
