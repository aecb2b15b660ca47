#include "common/light/spherical_rectangle.h"

#include <algorithm>
#include <cmath>

namespace duet {

SphericalRectangle::SphericalRectangle(Vec3d corner, Vec3d u, Vec3d v) {
    const double width = length(u), height = length(v);
    x_ = u / width;
    y_ = v / height;
    z_ = cross(x_, y_);
    z0_ = dot(corner, z_);
    if (z0_ > 0) {
        z0_ = -z0_;
        z_ = -z_;
    }
    x0_ = dot(corner, x_);
    y0_ = dot(corner, y_);
    x1_ = x0_ + width;
    y1_ = y0_ + height;

    // n0 to n3 are the z of the unit normals of the planes through the origin and the edges at y0, x1, y1 and x0.
    // Each normal has only two non-zero components, so the cosine of an inner angle is a product of two numbers.
    const auto z_of_normal = [this](double to_edge) { return to_edge / std::sqrt(to_edge * to_edge + z0_ * z0_); };
    const double n0 = z_of_normal(-y0_), n1 = z_of_normal(x1_), n2 = z_of_normal(y1_), n3 = z_of_normal(-x0_);
    const auto inner_angle = [](double a, double b) { return std::acos(std::clamp(-a * b, -1.0, 1.0)); };
    beyond_left_ = 2 * kPiDouble - inner_angle(n2, n3) - inner_angle(n3, n0);
    solid_angle_ = inner_angle(n0, n1) + inner_angle(n1, n2) - beyond_left_;
    b0_ = n0;
    b1_ = n2;
}

Vec3d SphericalRectangle::sample(Vec2d u) const {
    // Find the plane through the y axis that cuts off the fraction u.x of the solid angle (eq. 22 to 24 of the
    // paper).
    const double phi = u.x * solid_angle_ + beyond_left_;
    const double f = (std::cos(phi) * b0_ - b1_) / std::sin(phi);
    const double c = std::clamp(std::copysign(1 / std::sqrt(f * f + b0_ * b0_), f), -1.0, 1.0);
    const double x = std::clamp(-c * z0_ / safe_sqrt(1 - c * c), x0_, x1_);
    // Within that plane, heights above the x axis are uniform on the sphere (eq. 25 to 28 of the paper).
    const double d2 = x * x + z0_ * z0_;
    const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_), h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
    const double h = lerp(h0, h1, u.y), rest = 1 - h * h;
    const double y = rest > 0 ? std::clamp(h * std::sqrt(d2 / rest), y0_, y1_) : y1_;
    return x_ * x + y_ * y + z_ * z0_;
}

} // namespace duet
