#include "compare/stress/projected_triangle.h"

#include <algorithm>
#include <limits>

namespace duet::compare {

ProjectedTriangle::ProjectedTriangle(const Pinhole& pinhole, const std::array<Vec3, 3>& corners)
    : direction_(pinhole.direction), direction_dx_(pinhole.direction_dx), direction_dy_(pinhole.direction_dy),
      near_distance_(pinhole.near) {
    std::array<Vec3x, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = Vec3x(corners[i]) - Vec3x(pinhole.origin);
    volume_ = dot(p[0], cross(p[1], p[2]));
    const auto reach = [&](std::size_t i) { return length(Vec3x(corners[i])) + length(Vec3x(pinhole.origin)); };
    near_ = {0, 0, 1 / Extended{pinhole.near}};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3x normal = cross(p[(i + 1) % 3], p[(i + 2) % 3]) / volume_;
        edges_[i] = {dot(Vec3x(pinhole.direction_dx), normal), dot(Vec3x(pinhole.direction_dy), normal),
                     dot(Vec3x(pinhole.direction), normal)};
        size_ += reach((i + 1) % 3) * reach((i + 2) % 3);
        near_ = {near_.x - edges_[i].x, near_.y - edges_[i].y, near_.constant - edges_[i].constant};
    }
}

double ProjectedTriangle::inside(Vec2d pixel) const {
    Extended least = std::numeric_limits<Extended>::infinity();
    const auto consider = [&](const Line& line) {
        least = std::min(least, line.at(pixel) / std::hypot(line.x, line.y));
    };
    for (const Line& edge : edges_) consider(edge);
    // For a triangle parallel to the near plane this line has no direction, so the condition holds everywhere or
    // nowhere. The threshold is between the rounding error of extended precision and the least tilt that floats can
    // represent.
    const Extended kNothing = 0x1p-50L / near_distance_;
    if (std::hypot(near_.x, near_.y) > kNothing)
        consider(near_);
    else if (near_.at(pixel) < -kNothing)
        least = -std::numeric_limits<Extended>::infinity();
    return static_cast<double>(least);
}

double ProjectedTriangle::condition(Vec2d pixel) const {
    const Vec3d d = direction_ + direction_dx_ * pixel.x + direction_dy_ * pixel.y;
    Extended inverse_depth = 0;
    for (const Line& edge : edges_) inverse_depth += edge.at(pixel);
    return static_cast<double>(length(Vec3x(d)) * size_ / std::abs(volume_ * inverse_depth));
}

ProjectedPoint ProjectedTriangle::at(Vec2d pixel) const {
    const Extended a = edges_[0].at(pixel), b = edges_[1].at(pixel), c = edges_[2].at(pixel), sum = a + b + c;
    return {static_cast<double>(b / sum), static_cast<double>(c / sum), static_cast<double>(1 / sum)};
}

double displacement(const ProjectedTriangle& triangle, Vec2d pixel, bool covered) {
    const double inside = triangle.inside(pixel);
    return covered ? max(0.0, -inside) : max(0.0, inside);
}

} // namespace duet::compare
