// A camera that stands anywhere, with a thin lens.
#include "raytrace/lessons/07-camera/lab.h"

namespace duet::lab {

Axes camera_axes(Vec3 eye, Vec3 look_at, Vec3 up) {
    Axes axes;
    axes.back = normalize(eye - look_at);
    Vec3 side = cross(normalize(up), axes.back);
    if (length(side) < 1e-5f) {
        const Vec3 other = std::abs(axes.back.x) < 0.5f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
        side = cross(other, axes.back);
    }
    axes.right = normalize(side);
    axes.up = cross(axes.back, axes.right);
    return axes;
}

Vec3 pixel_direction(const Axes& axes, float fov_degrees, int width, int height, float x, float y) {
    const float half_angle = static_cast<float>(radians(fov_degrees)) / 2;
    const float half = std::tan(half_angle);
    const float w = static_cast<float>(width), h = static_cast<float>(height);
    const float pixel = 2 * half / h;
    const float right = (x - w / 2) * pixel;
    const float up = (h / 2 - y) * pixel;
    return normalize(axes.right * right + axes.up * up - axes.back);
}

Vec2 lens_point(Vec2 random) {
    const float r = std::sqrt(random.x);
    const float angle = 2 * kPi * random.y;
    return {r * std::cos(angle), r * std::sin(angle)};
}

Ray lens_ray(Vec3 eye, const Axes& axes, Vec3 direction, float aperture_radius, float focus_distance, Vec2 lens) {
    const float t = focus_distance / -dot(direction, axes.back);
    const Vec3 sharp = eye + direction * t;
    const Vec3 origin = eye + (axes.right * lens.x + axes.up * lens.y) * aperture_radius;
    return {origin, normalize(sharp - origin)};
}

} // namespace duet::lab
