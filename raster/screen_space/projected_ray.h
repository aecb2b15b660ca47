// This header declares the projection of a ray to image pixels.
#pragma once

#include "raster/gbuffer/screen_gbuffer.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {

/// This is a ray projected to the image, with a parameter from 0 at its origin to 1, marched in steps of one pixel.
/// Along it 1/depth is linear in a perspective view; in an orthographic view depth is linear.
class ProjectedRay {
public:
    ProjectedRay(const ScreenGBuffer& gbuffer, Vec3 p, Vec3 direction)
        : from_(gbuffer.project(p)), perspective_(gbuffer.perspective()) {
        if (!(from_.z > 0)) return;
        const float deeper = gbuffer.homogeneous_change(direction)[2]; // depth gained per meter
        // The ray ends at the near plane, or at a depth beyond which its projection spans hardly a pixel.
        const float nearest = std::min(from_.z, std::max(gbuffer.near(), 1e-4f * from_.z));
        const float to_nearest = deeper < 0 ? (from_.z - nearest) / -deeper : kInfinity, farthest = 1e3f * from_.z;
        reach_ = std::min(to_nearest, farthest);
        to_ = gbuffer.project(p + direction * reach_);
        pixels_ = std::max(std::abs(to_.x - from_.x), std::abs(to_.y - from_.y));
        if (!spans_pixels()) return;
        over_pixels_ = 1 / pixels_, near_ = gbuffer.near(), reversed_depth_from_ = near_ / from_.z,
        reversed_depth_to_ = near_ / to_.z;
        float in = 0, out = 1, out_at_side = 1;
        clip(from_.x, to_.x - from_.x, static_cast<float>(gbuffer.width()), in, out_at_side);
        out = out_at_side;
        clip(from_.y, to_.y - from_.y, static_cast<float>(gbuffer.height()), in, out);
        leaves_image_ = out < 1, leaves_at_side_ = leaves_image_ && out_at_side <= out;
        if (!(in <= out)) return;
        // A ray origin far outside the image may be any number of pixels away.
        const auto whole = [](float steps) { return static_cast<int>(std::min(1e9f, steps)); };
        first_ = std::max(1, whole(std::ceil(in * pixels_))), last_ = whole(std::floor(out * pixels_));
    }

    Vec3 from() const { return from_; }
    bool spans_pixels() const { return pixels_ > 1; }
    int first() const { return first_; } ///< first step inside the image; a ray may start outside it
    int last() const { return last_; }
    float parameter(int step) const { return static_cast<float>(step) * over_pixels_; }
    float x(float t) const { return lerp(from_.x, to_.x, t); }
    float y(float t) const { return lerp(from_.y, to_.y, t); }
    float step_x() const { return (to_.x - from_.x) * over_pixels_; }
    float step_y() const { return (to_.y - from_.y) * over_pixels_; }
    float depth(float t) const { return perspective_ ? 1 / lerp(1 / from_.z, 1 / to_.z, t) : lerp(from_.z, to_.z, t); }
    /// Returns the reversed depth, near / depth, as in ScreenGBuffer::reversed_depth().
    float reversed_depth(float t) const {
        return perspective_ ? lerp(reversed_depth_from_, reversed_depth_to_, t) : near_ / lerp(from_.z, to_.z, t);
    }
    bool leaves_image() const { return leaves_image_; }     ///< whether an edge of the image clips the ray
    bool leaves_at_side() const { return leaves_at_side_; } ///< at the left or right edge
    bool approaches_viewer() const { return to_.z < from_.z; }
    /// Inverts depth(); returns the end if the depth is constant.
    float parameter_at(float depth) const {
        const float gained = perspective_ ? 1 / to_.z - 1 / from_.z : to_.z - from_.z;
        return gained != 0 ? (perspective_ ? 1 / depth - 1 / from_.z : depth - from_.z) / gained : 1;
    }
    /// Returns the distance in meters at t, where the ray has this depth. A ray perpendicular to the view has
    /// constant depth, so t is used then.
    float distance(float t, float depth) const {
        return std::abs(to_.z - from_.z) > 1e-3f * from_.z ? reach_ * (depth - from_.z) / (to_.z - from_.z)
                                                          : reach_ * t;
    }

private:
    /// Clips one axis: the line from `at` must be within [0, size).
    static void clip(float at, float direction, float size, float& in, float& out) {
        if (direction == 0) {
            if (!(at >= 0 && at < size)) out = -1;
            return;
        }
        const float a = -at / direction, b = (size - at) / direction;
        in = std::max(in, std::min(a, b)), out = std::min(out, std::max(a, b));
    }

    Vec3 from_, to_; ///< in pixels, with depth
    bool perspective_, leaves_image_ = false, leaves_at_side_ = false;
    float reach_ = 0, pixels_ = 0, over_pixels_ = 0, near_ = 0, reversed_depth_from_ = 0, reversed_depth_to_ = 0;
    int first_ = 1, last_ = 0;
};

} // namespace duet::raster
