#include "raster/screen_reflection.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace duet::raster {
namespace {

constexpr float kSlack = 2e-3f; ///< of the distance between two points: lower is no step over a plane, but rounding
constexpr float kSameSurface = 0.05f; ///< of the depth: how far neighbouring pixels of one surface may be apart
constexpr float kFlat = 0.01f;        ///< radians from pixel to pixel: what turns less goes on as its plane does
constexpr int kBlock = 16;            ///< pixels: blocks of the picture before which a ray is are passed at once
constexpr float kSmallTurn = 0.5f;    ///< radians: a sharper edge is not a curve

/// The part of a line over which it stays within [0, size), given where it begins and how it goes on.
float part_within(float at, float way, float size) {
    if (way > 0) return (size - at) / way;
    return way < 0 ? at / -way : kInfinity;
}

/// The distance at which a ray comes through the plane of what a pixel sees, from its front; infinity where it does not.
float meets_plane(const Screen& screen, Vec3 p, Vec3 way, int x, int y) {
    const std::optional<Vec3> seen = screen.seen(x, y);
    if (!seen) return kInfinity;
    const Vec3 n = screen.normal(x, y);
    const float towards = -dot(n, way), height = dot(n, p - *seen);
    return towards > 1e-3f && height > 0 ? height / towards : kInfinity;
}

/// How many of at most `most` steps (sx, sy) from a place stay in its block of kBlock × kBlock pixels, or fewer.
int steps_in_block(float x, float y, float sx, float sy, int most) {
    const auto along = [](float at, float step) {
        const float from_edge = at - kBlock * std::floor(at / kBlock);
        return step > 0 ? (kBlock - from_edge) / step : step < 0 ? from_edge / -step : 1e6f;
    };
    return std::min(most, static_cast<int>(std::min(along(x, sx), along(y, sy)) - 0.01f));
}

/// Whether all of a place's block lies farther than a depth.
bool block_is_beyond(const Screen& screen, float x, float y, float depth) {
    const int x0 = static_cast<int>(x) / kBlock * kBlock, y0 = static_cast<int>(y) / kBlock * kBlock;
    return depth < screen.least_depth(x0, y0, std::min(x0 + kBlock, screen.width()) - 1, std::min(y0 + kBlock, screen.height()) - 1);
}

/// What pixel (x, y) shows stands for what is met at a distance.
ScreenHit guess(const Screen& screen, Vec3 p, Vec3 way, float x, float y, float distance) {
    const std::optional<Vec3> seen = screen.seen(static_cast<int>(x), static_cast<int>(y));
    return {x, y, distance, seen ? length(*seen - p - way * distance) : 0.0f};
}

} // namespace

std::optional<ScreenHit> trace_screen(const Screen& screen, const Box3& scene, Vec3 p, Vec3 n, Vec3 way, bool from_picture) {
    const Vec3 from = screen.project(p);
    if (!(from.z > 0)) return std::nullopt;
    const auto h = screen.homogeneous_change(way);
    const float deeper = h[2]; // depth gained a metre
    // Half way to the eye's plane, or a good deal farther than anything that moves a pixel.
    const float reach = deeper < 0 ? 0.5f * from.z / -deeper : 1e3f * from.z;
    const Vec3 to = screen.project(p + way * std::min(reach, 1e3f * from.z));
    const float dx = to.x - from.x, dy = to.y - from.y;
    const float pixels = std::max(std::abs(dx), std::abs(dy));
    if (!(pixels > 1)) { // all the way in one pixel
        const float beyond = screen.contains(from.x, from.y) ? screen.depth(static_cast<int>(from.x), static_cast<int>(from.y)) - from.z : 0;
        return !from_picture && deeper > 0 && beyond > 0 && beyond < kInfinity ? std::optional(ScreenHit{from.x, from.y, beyond / deeper}) : std::nullopt;
    }
    const float part = std::min({1.0f, part_within(from.x, dx, static_cast<float>(screen.width())),
                                 part_within(from.y, dy, static_cast<float>(screen.height()))});
    const int steps = static_cast<int>(std::floor(part * pixels));
    // Along the line in the picture 1/depth is linear (under perspective; a parallel view's depth is itself).
    const bool perspective = screen.perspective();
    const auto depth_at = [&](float t) {
        return perspective ? 1 / lerp(1 / from.z, 1 / to.z, t) : lerp(from.z, to.z, t);
    };
    const auto part_at = [&](float depth) { // the other way round; t's end where it keeps its depth
        const float gained = perspective ? 1 / to.z - 1 / from.z : to.z - from.z;
        return gained != 0 ? (perspective ? 1 / depth - 1 / from.z : depth - from.z) / gained : 1;
    };
    const float length_of_all = std::min(reach, 1e3f * from.z);
    const auto distance_at = [&](float t, float depth) { // a ray across the view keeps its depth
        return std::abs(to.z - from.z) > 1e-3f * from.z ? length_of_all * (depth - from.z) / (to.z - from.z) : length_of_all * t;
    };
    float before = from.z, in_front = 0; // the last distance at which it was before what is seen
    float hidden_from = -1;              // and that at which it went behind it; negative: it is not
    int last_x = -1, last_y = -1, front_x = -1, front_y = -1;
    for (int i = 1; i <= steps; ++i) {
        float t = static_cast<float>(i) / pixels, depth = depth_at(t), fx = from.x + dx * t, fy = from.y + dy * t;
        if (i > 2 && screen.contains(fx, fy)) { // to the last place in a block before which it stays: the same as step by step
            const int more = steps_in_block(fx, fy, dx / pixels, dy / pixels, steps - i);
            const float last_t = static_cast<float>(i + more) / pixels, last_depth = depth_at(last_t);
            if (more > 0 && block_is_beyond(screen, fx, fy, std::max({before, depth, last_depth})))
                i += more, t = last_t, before = depth = last_depth, fx = from.x + dx * t, fy = from.y + dy * t;
        }
        if (!screen.contains(fx, fy)) break;
        const auto x = static_cast<int>(fx), y = static_cast<int>(fy);
        last_x = x, last_y = y;
        const float seen_depth = screen.depth(x, y);
        const float far = std::max(before, depth), near = std::min(before, depth);
        const float thickness = std::max(2 * (far - near), kThickness * seen_depth);
        before = depth;
        if (from_picture && i < 2) continue;
        const float distance = distance_at(t, depth);
        if (far < seen_depth) {
            hidden_from = -1, in_front = distance, front_x = x, front_y = y;
            continue;
        }
        if (near > seen_depth + thickness) {
            if (hidden_from < 0) hidden_from = in_front;
            const float crossed = meets_plane(screen, p, way, x, y);
            if (crossed > hidden_from && crossed <= distance && normal_turn(screen, x, y) < kFlat) return guess(screen, p, way, fx, fy, crossed);
            continue;
        }
        const std::optional<Vec3> seen = screen.seen(x, y);
        if (!seen) continue;
        const Vec3 step = *seen - p;
        if (!(dot(n, step) > kSlack * length(step))) continue;
        const float met = clamp(part_at(seen_depth), static_cast<float>(i - 1) / pixels, t);
        return ScreenHit{from.x + dx * met, from.y + dy * met, length(step)};
    }
    if (last_x < 0) std::tie(last_x, last_y) = screen.pixel_at(from);
    const float last_fx = static_cast<float>(last_x) + 0.5f, last_fy = static_cast<float>(last_y) + 0.5f;
    if (hidden_from >= 0 && front_x >= 0 && normal_turn(screen, front_x, front_y) < kFlat) {
        const float crossed = meets_plane(screen, p, way, front_x, front_y);
        if (crossed > hidden_from && scene.contains(p + way * crossed))
            return guess(screen, p, way, static_cast<float>(front_x) + 0.5f, static_cast<float>(front_y) + 0.5f, crossed);
    }
    if (hidden_from >= 0) return guess(screen, p, way, last_fx, last_fy, hidden_from);
    const float beyond = meets_plane(screen, p, way, last_x, last_y);
    const std::optional<Vec3> edge = screen.seen(last_x, last_y);
    if (beyond == kInfinity || !scene.contains(p + way * beyond) || !edge || dot(n, *edge - p) <= kSlack * length(*edge - p)) return std::nullopt;
    return guess(screen, p, way, last_fx, last_fy, beyond);
}

float normal_turn(const Screen& screen, int x, int y) {
    const Vec3 n = screen.normal(x, y);
    const float depth = screen.depth(x, y);
    if (!(depth < kInfinity)) return 0; // nothing is seen
    float most = 0;
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
        const int i = x + dx, k = y + dy;
        if (i < 0 || k < 0 || i >= screen.width() || k >= screen.height()) continue;
        if (!(std::abs(screen.depth(i, k) - depth) <= kSameSurface * depth)) continue;
        const float turn = length(screen.normal(i, k) - n);
        if (turn < kSmallTurn) most = std::max(most, turn);
    }
    return most;
}

} // namespace duet::raster
