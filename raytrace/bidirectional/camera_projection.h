// Projects surface points to the camera: which pixel sees a point, and with which density.
#pragma once

#include "common/camera/camera.h"

#include <optional>

namespace duet::raytrace {

/// Describes how the camera sees a point through one point of its lens.
struct SeenPoint {
    Vec2d pixel;          ///< position in the image, see Pinhole
    Vec3d to_camera;      ///< unit direction from the point to the lens
    double distance;      ///< distance to the start of the camera ray on the near plane
    double pixel_density; ///< pixels per square meter of a surface at the point that faces the camera
};

/// Returns how the pinhole sees p, inside or outside the image. Returns nothing if p lies in front of the near plane.
std::optional<SeenPoint> seen_through(const Pinhole& pinhole, Vec3d p);

} // namespace duet::raytrace
