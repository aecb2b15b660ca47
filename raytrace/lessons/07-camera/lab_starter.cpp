// Lab 07: a camera. Begin with camera_axes; lens_ray is the last.
#include "raytrace/lessons/07-camera/lab.h"

namespace duet::lab {

Axes camera_axes(Vec3 eye, Vec3 look_at, Vec3 up) {
    not_attempted(); // Remove this line when you start.
    (void)eye, (void)look_at, (void)up;
    // Which direction do you know at once? A cross product gives the second, another one the third.
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; // The camera looks along -z, wherever it stands.
}

Vec3 pixel_direction(const Axes& axes, float fov_degrees, int width, int height, float x, float y) {
    not_attempted(); // Remove this line when you start.
    (void)fov_degrees, (void)width, (void)height, (void)x, (void)y;
    // How high is the picture at distance 1 from the eye? How large is a pixel there?
    return -axes.back;
}

Vec2 lens_point(Vec2 random) {
    not_attempted(); // Remove this line when you start.
    (void)random;
    return {0, 0}; // The center: the camera is a pinhole.
}

Ray lens_ray(Vec3 eye, const Axes& axes, Vec3 direction, float aperture_radius, float focus_distance, Vec2 lens) {
    not_attempted(); // Remove this line when you start.
    (void)axes, (void)aperture_radius, (void)focus_distance, (void)lens;
    // At which point does the ray from the eye meet the plane that is sharp?
    return {eye, direction};
}

} // namespace duet::lab
