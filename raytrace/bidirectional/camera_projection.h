// A camera projection connects surface points to the camera: which pixel sees a point, and how densely.
#pragma once

#include "common/camera/camera.h"

#include <optional>

namespace duet::raytrace {

/// Holds how the camera sees a point through one point of its lens.
struct SeenPoint {
    Vec2d pixel;          ///< position in the image, see Pinhole
    Vec3d to_camera;      ///< unit direction from the point to the lens
    double distance;      ///< distance to where camera rays start: on the near plane
    double pixel_density; ///< pixels per square meter of a surface at the point that faces the camera
};

/// Returns how the pinhole sees p, wherever it is in the image or beside it. Returns nothing where p lies before the
/// near plane.
std::optional<SeenPoint> seen_through(const Pinhole& pinhole, Vec3d p);

} // namespace duet::raytrace
