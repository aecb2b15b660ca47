// This header declares views and world-space triangles that test projection: their edges are aimed through a window
// of pixels.
#pragma once

#include "compare/stress/projected_triangle.h"
#include "compare/stress/raster_stages.h"
#include "compare/stress/trials.h"

namespace duet::compare {

/// A trial view has a camera view and the window of pixels that a trial renders.
struct TrialView {
    View view;
    Pinhole pinhole; ///< of the view
    Window window;
};

/// Returns a perspective view of 16 to 4096 pixels per side, with the near plane at 1e-5 to 0.1 (a float). Half of
/// the views are from the origin along −z, where a corner's depth is a coordinate and may be exactly zero. The others
/// are from a random position within 10 meters.
TrialView random_view(TrialRandom& random, int window_side);
/// Returns a view as random_view(random, window_side) does, but with the near plane at `near`.
TrialView random_view(TrialRandom& random, int window_side, double near);

/// Returns the point at a depth on the ray through a pixel, rounded to float.
Vec3 point_at(const Pinhole& pinhole, Vec2d pixel, double depth);
/// Returns a random position in the window, in pixels.
Vec2d pixel_in(TrialRandom& random, const Window& window);

/// Returns a triangle with corners in front of the eye, behind it, on its plane and on the near plane. Half of the
/// triangles have an edge or their interior aimed at a pixel of the window.
std::array<Vec3, 3> random_straddling(TrialRandom& random, const TrialView& view);
/// Returns a triangle with one corner near the window and the others 1e4 to 1e7 pixels beyond it.
std::array<Vec3, 3> random_beyond_guard(TrialRandom& random, const TrialView& view);
/// Returns a triangle beyond the near plane, in and near the window, with corner depths up to 1000 times apart.
std::array<Vec3, 3> random_visible(TrialRandom& random, const TrialView& view);
/// Returns a sliver so thin in the image, 1e-5 to 0.1 pixels, that vertex snapping moves its edges across each other.
/// Corner depths are up to 10 times apart.
std::array<Vec3, 3> random_sliver(TrialRandom& random, const TrialView& view);

/// Returns a mesh of one triangle.
inline Mesh one_triangle(const std::array<Vec3, 3>& corners) {
    Mesh mesh;
    mesh.positions.assign(corners.begin(), corners.end());
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

} // namespace duet::compare
