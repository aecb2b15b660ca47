#include "compare/view/camera_control.h"

#include "common/vec/scalar.h"

#include <algorithm>
#include <cmath>

namespace duet::compare {

namespace {

/// The eye stays at least this far from the look-at point, as a fraction of that point's distance from the origin:
/// positions are rounded to float, and nearer eyes would jump.
constexpr double kLeastDistance = 1e-5;

double distance(const Camera& camera) { return length(camera.look_at - camera.eye); }

/// Holds the axes of the camera: to the right, upward and along its view.
struct Axes {
    explicit Axes(const Camera& camera)
        : forward(normalize(camera.look_at - camera.eye)), right(normalize(cross(forward, camera.up))),
          up(cross(right, forward)) {}
    Vec3d forward, right, up;
};

/// Rounds to a number of decimals; −2 rounds to hundreds.
double rounded(double x, int decimals) {
    const double scale = std::pow(10, std::abs(decimals));
    return decimals >= 0 ? std::round(x * scale) / scale : std::round(x / scale) * scale;
}
Vec3d rounded(Vec3d v, int decimals) {
    return {rounded(v.x, decimals), rounded(v.y, decimals), rounded(v.z, decimals)};
}

int decimals_of_millionth(double x) { return 6 - static_cast<int>(std::floor(std::log10(x))); }

Camera rounded(Camera camera) {
    const int decimals = decimals_of_millionth(distance(camera));
    camera.eye = rounded(camera.eye, decimals);
    camera.look_at = rounded(camera.look_at, decimals);
    camera.height = rounded(camera.height, decimals_of_millionth(camera.height));
    return camera;
}

Camera moved(Camera camera, Vec3d by) {
    camera.eye = camera.eye + by;
    camera.look_at = camera.look_at + by;
    return rounded(camera);
}

/// Returns the view vector turned around the up vector and then toward it, but no closer to it than one degree.
Vec3d turned(const Camera& camera, Vec3d view, double right, double up) {
    const Vec3d axis = normalize(camera.up);
    const double angle = std::acos(std::clamp(dot(normalize(view), axis), -1.0, 1.0)); // angle from the up vector
    const double limit = radians(1.0);
    const double wanted = std::clamp(angle - up, std::min(limit, angle), std::max(kPiDouble - limit, angle));
    const Vec3d side = cross(view, axis);
    const Vec3d raised = length(side) > 0 ? transform_vector(rotation(normalize(side), angle - wanted), view) : view;
    return transform_vector(rotation(axis, -right), raised);
}

} // namespace

double shown_height(const Camera& camera, double depth) {
    if (camera.projection == Camera::Projection::kOrthographic) return camera.height;
    return 2 * depth * std::tan(radians(camera.fov_degrees) / 2);
}

Camera orbit(Camera camera, double right, double up) {
    camera.eye = camera.look_at - turned(camera, camera.look_at - camera.eye, -right, -up);
    return rounded(camera);
}

Camera look_around(Camera camera, double right, double up) {
    camera.look_at = camera.eye + turned(camera, camera.look_at - camera.eye, right, up);
    return rounded(camera);
}

Camera pan(const Camera& camera, double right, double up) {
    const Axes axes(camera);
    return moved(camera, shown_height(camera, distance(camera)) * (right * axes.right + up * axes.up));
}

Camera dolly(Camera camera, double factor) {
    const double least = kLeastDistance * length(camera.look_at);
    if (camera.projection == Camera::Projection::kOrthographic)
        camera.height *= factor;
    else if (factor * distance(camera) > least)
        camera.eye = camera.look_at + factor * (camera.eye - camera.look_at);
    return rounded(camera);
}

Camera fly(const Camera& camera, double forward, double right, double up) {
    const Axes axes(camera);
    return moved(camera, distance(camera) * (forward * axes.forward + right * axes.right + up * axes.up));
}

Camera look_at_point(Camera camera, Vec3d point) {
    if (!(length(point - camera.eye) > 0)) return camera;
    camera.look_at = point;
    camera.focus_distance = 0; // 0 focuses on the look-at point
    return rounded(camera);
}

Camera frame_box(Camera camera, const Box3& box, double aspect) {
    if (box.empty()) return camera;
    const Vec3d low(box.low), high(box.high), forward = Axes(camera).forward;
    const double radius = std::max(length(high - low) / 2, kLeastDistance * length(high + low));
    camera.look_at = (low + high) / 2.0;
    if (camera.projection == Camera::Projection::kOrthographic) camera.height = 2 * radius / std::min(aspect, 1.0);
    const double half_height = std::tan(radians(camera.fov_degrees) / 2);
    const double half_angle = std::atan(half_height * std::min(aspect, 1.0));
    camera.eye = camera.look_at - forward * (radius / std::sin(half_angle));
    camera.focus_distance = 0;
    return rounded(camera);
}

} // namespace duet::compare
