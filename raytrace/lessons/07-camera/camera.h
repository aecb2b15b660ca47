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

/// Turns points of the picture into rays. (Ray Tracing in One Weekend, §12 and §13)
class Camera {
public:
    Camera(const View& view, int width, int height) : view_(view) {
        back_ = normalize(view.eye - view.look_at); // the camera looks along -back
        right_ = normalize(cross(view.up, back_));
        up_ = cross(back_, right_);
        const float half = std::tan(static_cast<float>(radians(view.fov_degrees)) / 2) * view.focus_distance;
        pixel_ = 2 * half / static_cast<float>(height);
        center_x_ = 0.5f * static_cast<float>(width);
        center_y_ = 0.5f * static_cast<float>(height);
    }

    /// A ray through the point (x, y) of the picture, in pixels from its upper left corner, from a random point of the
    /// lens. All rays of one point meet in the plane at the focus distance.
    Ray ray(float x, float y, Random& random) const {
        const Vec3 target = view_.eye - back_ * view_.focus_distance + right_ * ((x - center_x_) * pixel_) +
                            up_ * ((center_y_ - y) * pixel_);
        Vec3 origin = view_.eye;
        if (view_.aperture_radius > 0) {
            const float r = view_.aperture_radius * std::sqrt(random.next());
            const float angle = 2 * kPi * random.next();
            origin += right_ * (r * std::cos(angle)) + up_ * (r * std::sin(angle));
        }
        return {origin, normalize(target - origin)};
    }

private:
    View view_;
    Vec3 right_, up_, back_; ///< the camera's axes, of unit length
    float pixel_, center_x_, center_y_;
};

} // namespace duet::lesson
