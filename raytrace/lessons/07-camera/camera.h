// A camera that can stand anywhere, with a lens.
#pragma once

#include "common/vec/ray.h"
#include "raytrace/lessons/04-antialiasing/sampling.h"

namespace duet::lesson {

/// What the user says of a camera.
struct View {
    Vec3 eye{0, 0, 0}, look_at{0, 0, -1}, up{0, 1, 0};
    float fov_degrees = 90;    ///< the vertical angle of view
    float aperture_radius = 0; ///< of the lens; 0 is a pinhole, and all is sharp
    float focus_distance = 1;  ///< from the eye to the plane that is sharp
};

/// A random point of the disk of radius 1 around (0, 0), all equally likely.
inline Vec2 random_in_disk(Random& random) {
    const float r = std::sqrt(random.next()), angle = 2 * kPi * random.next();
    return {r * std::cos(angle), r * std::sin(angle)};
}

/// Turns points of the picture into rays. (Ray Tracing in One Weekend, §12 and §13)
class Camera {
public:
    Camera(const View& view, int width, int height) : view_(view) {
        back_ = normalize(view.eye - view.look_at); // the camera looks along -back
        right_ = normalize(cross(view.up, back_));
        up_ = cross(back_, right_);
        const float half = std::tan(static_cast<float>(radians(view.fov_degrees)) / 2) * view.focus_distance;
        pixel_ = 2 * half / static_cast<float>(height);
        center_ = {0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height)};
    }

    /// The ray through the point (x, y) of the picture, in pixels from its upper left corner. It starts at a point of
    /// the lens, given in the disk of radius 1. All rays of one (x, y) meet in the plane at the focus distance.
    Ray ray(float x, float y, Vec2 lens) const {
        const Vec3 target = view_.eye - back_ * view_.focus_distance + right_ * ((x - center_.x) * pixel_) +
                            up_ * ((center_.y - y) * pixel_);
        const Vec3 origin = view_.eye + (right_ * lens.x + up_ * lens.y) * view_.aperture_radius;
        return {origin, normalize(target - origin)};
    }
    /// The same from a random point of the lens.
    Ray ray(float x, float y, Random& random) const {
        return ray(x, y, view_.aperture_radius > 0 ? random_in_disk(random) : Vec2(0, 0));
    }

private:
    View view_;
    Vec3 right_, up_, back_; ///< the camera's axes, of unit length
    float pixel_;            ///< the side of a pixel in the plane at the focus distance
    Vec2 center_;            ///< of the picture, in pixels
};

} // namespace duet::lesson
