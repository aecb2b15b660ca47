// Views, and triangles in the world that try projection: their edges aimed through a window of pixels.
#pragma once

#include "compare/stress/drawing.h"
#include "compare/stress/projected_triangle.h"
#include "compare/stress/trials.h"

namespace duet::compare {

/// A view and the pixels of it that a trial draws.
struct TrialView {
    View view;
    Pinhole pinhole; ///< of the view
    Window window;
};

/// A perspective view, 16 to 4096 pixels a side, near plane at 1e-5 to 0.1 (a float). Half of them from the origin
/// along −z, where a corner's depth is a coordinate and may be exactly zero; the others from anywhere within 10 metres.
TrialView random_view(TrialRandom& random, int window_side);
/// With the near plane at `near`.
TrialView random_view(TrialRandom& random, int window_side, double near);

/// The point at a depth on the ray through a pixel, rounded to floats.
Vec3 point_at(const Pinhole& pinhole, Vec2d pixel, double depth);
/// A place in the window, in pixels.
Vec2d pixel_in(TrialRandom& random, const Window& window);

/// Corners before the eye, behind it, on its plane and on the near plane; half of the triangles have an edge, or their
/// inside, aimed at a pixel of the window.
std::array<Vec3, 3> random_straddling(TrialRandom& random, const TrialView& view);
/// One corner about the window, the others 1e4 to 1e7 pixels beyond it.
std::array<Vec3, 3> random_beyond_guard(TrialRandom& random, const TrialView& view);
/// Before the near plane, in and about the window, corners' depths up to 1000 times apart.
std::array<Vec3, 3> random_well_seen(TrialRandom& random, const TrialView& view);
/// So thin in the picture, 1e-5 to 0.1 pixels, that snapping moves its edges over each other; corners' depths up to 10
/// times apart.
std::array<Vec3, 3> random_sliver(TrialRandom& random, const TrialView& view);

inline Mesh one_triangle(const std::array<Vec3, 3>& corners) {
    Mesh mesh;
    mesh.positions.assign(corners.begin(), corners.end());
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

} // namespace duet::compare
