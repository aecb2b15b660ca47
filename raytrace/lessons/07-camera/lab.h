// Lab 07: a camera.
#pragma once

#include "common/vec/ray.h"
#include "tests/grading/lab.h"

namespace duet::lab {

/// The directions of a camera, each of length 1 and at right angles to the others.
struct Axes {
    Vec3 right, up;
    Vec3 back; ///< away from what the camera looks at
};

/// The axes of a camera at `eye` that looks at the point look_at, another than eye. The upper edge of its picture is on
/// the side of `up`, which may have any length but 0, and need not be at right angles to the view. Where `up` is
/// parallel to the view, any axes with the right `back`; they have right = cross(up, back), as always.
Axes camera_axes(Vec3 eye, Vec3 look_at, Vec3 up);

/// The direction, of length 1, from the eye through the point (x, y) of the picture. x and y are in pixels from the
/// upper left corner: the center of the first pixel is (0.5, 0.5). The picture is width × height pixels, and
/// fov_degrees, between 0 and 180, is the angle between the directions through the middles of its upper and lower edge.
Vec3 pixel_direction(const Axes& axes, float fov_degrees, int width, int height, float x, float y);

/// A point of the disk of radius 1 around (0, 0), from two random numbers in [0, 1). If all pairs of numbers are
/// equally likely, all points of the disk are.
Vec2 lens_point(Vec2 random);

/// The ray from a point of the lens. direction, of length 1, is what pixel_direction returns. The lens is a disk of
/// radius aperture_radius around the eye, along the axes right and up; `lens` is the point on it as a multiple of that
/// radius. All rays of one direction meet in the plane that is sharp. It is at right angles to the view, and the eye is
/// focus_distance > 0 away from it. The ray's direction has length 1, and its t_min and t_max are those of Ray.
Ray lens_ray(Vec3 eye, const Axes& axes, Vec3 direction, float aperture_radius, float focus_distance, Vec2 lens);

} // namespace duet::lab

DUET_LAB(camera_axes, pixel_direction, lens_point, lens_ray)
