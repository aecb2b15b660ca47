// This header declares random triangles and meshes on the subpixel grid that exercise the coverage rules.
#pragma once

#include "compare/stress/raster_stages.h"
#include "compare/stress/trials.h"

#include <vector>

namespace duet::compare {

/// Returns a window of pixels at a random position in an image of up to kMaxRenderSide per side. The sample is at a
/// random offset in the pixel, and in one of four windows at its center.
Window random_window(TrialRandom& random, int side);

/// Returns a grid point in the window; every second one is on a sample.
raster::FixedPoint point_in(TrialRandom& random, const Window& window);

/// Selects the kind of a random triangle in [0, kTriangleKinds). Its corners or edges pass near or through samples of
/// the window.
inline constexpr std::uint32_t kTriangleKinds = 8;
/// Returns a triangle of a kind in [0, kTriangleKinds), of either orientation.
GridTriangle random_triangle(TrialRandom& random, const Window& window, std::uint32_t kind);

/// Returns a mesh of 4 to 64 triangles around one vertex. As for the next two meshes, it is a topological disk whose
/// border surrounds the window once. Whatever its inner vertices are, each sample is covered by one more clockwise than
/// counter-clockwise triangle.
std::vector<GridTriangle> random_fan(TrialRandom& random, const Window& window);
std::vector<GridTriangle> random_strip(TrialRandom& random, const Window& window); ///< adjacent slivers
std::vector<GridTriangle> random_grid(TrialRandom& random, const Window& window); ///< jittered or heavily folded

} // namespace duet::compare
