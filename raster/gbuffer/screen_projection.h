// Maps pixels with depths to points and back, for one sample per pixel of a view. All positions are relative to the
// camera's eye, so that floats keep their precision far from the origin.
#pragma once

#include "common/camera/camera.h"
#include "raster/geometry/packet.h"
#include "raster/geometry/sample_positions.h"

#include <array>

namespace duet::raster {

/// Represents the projection of a view whose samples lie at the same offset in every pixel. Its functions take a
/// single number or a batch of lanes.
class ScreenProjection {
public:
    ScreenProjection(const Pinhole& view, SampleOffset offset);

    Vec3 relative(Vec3d p) const { return Vec3(p - eye_); }
    Vec3d absolute(Vec3 relative) const { return Vec3d(relative) + eye_; }
    Vec3d eye() const { return eye_; }

    /// Returns the point visible in column x and row y, both whole numbers, at the reversed depth near / depth. The
    /// reversed depth must not be 0.
    template <typename T> Vec3T<T> point(T x, T y, T reversed_depth) const {
        const T depth = T(near_) / reversed_depth;
        const auto axis = [&](float Vec3::*c) {
            return T(origin_.*c) + T(origin_dx_.*c) * x + T(origin_dy_.*c) * y +
                   (T(direction_.*c) + T(direction_dx_.*c) * x + T(direction_dy_.*c) * y) * depth;
        };
        return {axis(&Vec3::x), axis(&Vec3::y), axis(&Vec3::z)};
    }
    /// Returns the unit direction from a point to the viewer.
    template <typename T> Vec3T<T> to_viewer(Vec3T<T> p) const {
        const Vec3T<T> v = perspective_ ? p : Vec3T<T>{T(direction_.x), T(direction_.y), T(direction_.z)};
        return v * -inverse_sqrt(dot(v, v));
    }
    /// Returns the distance of a point from the origin of its camera ray: the eye, or a point on the camera's plane.
    template <typename T> T distance(Vec3T<T> p) const {
        if (perspective_) return sqrt(dot(p, p));
        return (p.x - T(origin_.x)) * T(direction_.x) + (p.y - T(origin_.y)) * T(direction_.y) +
               (p.z - T(origin_.z)) * T(direction_.z); // the direction is unit
    }
    /// Returns (x·w, y·w, depth, w) of a point; (x, y) is in pixels, and whole numbers are sample positions.
    template <typename T> std::array<T, 4> homogeneous(Vec3T<T> p) const {
        const auto row = [&](std::size_t r) {
            const Vec4& m = to_pixel_[r];
            return T(m.x) * p.x + T(m.y) * p.y + T(m.z) * p.z + T(m.w);
        };
        return {row(0), row(1), row(2), row(3)};
    }
    /// Returns the change of homogeneous() along a displacement.
    template <typename T> std::array<T, 4> homogeneous_change(Vec3T<T> d) const {
        const auto row = [&](std::size_t r) {
            const Vec4& m = to_pixel_[r];
            return T(m.x) * d.x + T(m.y) * d.y + T(m.z) * d.z;
        };
        return {row(0), row(1), row(2), row(3)};
    }
    /// Returns the width of a pixel at a depth, in meters.
    template <typename T> T pixel_size(T depth) const {
        return perspective_ ? T(length(direction_dx_)) * depth : T(length(origin_dx_));
    }
    /// right() and down() return the world-space unit directions in which x and y of the pixels increase.
    Vec3 right() const { return normalize(perspective_ ? direction_dx_ : origin_dx_); }
    Vec3 down() const { return normalize(perspective_ ? direction_dy_ : origin_dy_); }
    float near() const { return near_; }
    bool perspective() const { return perspective_; }

private:
    Vec3d eye_;
    Vec3 origin_, origin_dx_, origin_dy_, direction_, direction_dx_, direction_dy_; ///< as in Pinhole, at pixel (0, 0)
    std::array<Vec4, 4> to_pixel_;
    float near_;
    bool perspective_;
};

} // namespace duet::raster
