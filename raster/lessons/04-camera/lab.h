// Lab 04: camera, perspective, matrices.
#pragma once

#include "common/vec/matrix.h"
#include "tests/grading/lab.h"

#include <optional>

namespace duet::lab {

/// A camera: it stands at eye and looks at target. up says roughly where up is; it is not parallel to the line of
/// sight, and may have any length but 0.
struct View {
    Vec3 eye, target, up;
    float fov = 1;              ///< the vertical field of view in radians, in (0, π)
    float near = 0.1f, far = 1; ///< distances of the near plane and the far plane, 0 < near < far
};

/// The matrix from world space to camera space: it moves eye to the origin and target onto the negative z axis. x
/// points right and y up. The axes have length 1 and are at right angles. Points are columns: p' = M p.
Mat4 look_at(Vec3 eye, Vec3 target, Vec3 up);

/// The matrix from camera space to clip space. w becomes the distance in front of the eye, -z. After the division by w,
/// x and y of what is seen are in [-1, 1]; z is 0 at the distance near and 1 at far. aspect is width / height.
Mat4 perspective(float fov, float aspect, float near, float far);

/// From clip space to an image of width × height pixels: divides by w, and returns x and y in pixels from the upper
/// left corner (y points down), and z, the depth after the division. w > 0.
Vec3 to_image(Vec4 clip, int width, int height);

/// A point of the world in an image of width × height pixels, as to_image returns it. The aspect is that of the image.
/// Nothing where the point is not in front of the eye (w <= 0).
std::optional<Vec3> project(Vec3 p, const View& view, int width, int height);

} // namespace duet::lab

DUET_LAB(look_at, perspective, to_image, project)
