// This file moves a camera as a mouse and keys do in a window.
#pragma once

#include "common/camera/camera.h"
#include "common/vec/box.h"

namespace duet::compare {

// Each function returns the moved camera. Its numbers are rounded to a millionth of its distance from the look-at
// point, so that a saved scene file holds exactly the camera that was shown, in few digits.

/// Orbits around the look-at point: `right` and `up` are in radians. The camera stops just before it looks along its up
/// vector.
Camera orbit(Camera camera, double right, double up);
/// Turns the look-at point around the eye: `right` and `up` are in radians.
Camera look_around(Camera camera, double right, double up);
/// Moves the camera sideways. (1, 0) moves it to the right by the height of the visible region around the look-at
/// point, and (0, 1) upward.
Camera pan(const Camera& camera, double right, double up);
/// Moves the eye to `factor` (> 0) times its distance from the look-at point. An orthographic camera shows `factor`
/// times the height.
Camera dolly(Camera camera, double factor);
/// Moves the camera by a fraction of its distance: along its view, to the right and upward.
Camera fly(const Camera& camera, double forward, double right, double up);
/// Looks at a point, and sets the plane of focus there.
Camera look_at_point(Camera camera, Vec3d point);
/// Moves the eye along its view, so that the whole box is in an image of this aspect ratio (width / height). An empty
/// box changes nothing.
Camera frame_box(Camera camera, const Box3& box, double aspect);
/// Returns the height of the visible region at a depth along the view, both in meters.
double shown_height(const Camera& camera, double depth);

} // namespace duet::compare
