#include "raster/screen_reflection.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

constexpr float kSlack = 2e-3f; ///< of the distance between two points: lower is no step over a plane, but rounding

/// The part of a line over which it stays within [0, size), given where it begins and how it goes on.
float part_within(float at, float way, float size) {
    if (way > 0) return (size - at) / way;
    return way < 0 ? at / -way : kInfinity;
}

} // namespace

std::optional<ScreenHit> trace_screen(const Screen& screen, Vec3 p, Vec3 n, Vec3 way) {
    const Vec3 from = screen.project(p);
    if (!(from.z > 0)) return std::nullopt;
    // Half way to the eye's plane, or a good deal farther than anything that moves a pixel.
    const float closing = from.z - screen.project(p + way * from.z).z; // depth lost over that length
    const float reach = closing > 0 ? 0.5f * from.z * from.z / closing : 1e3f * from.z;
    const Vec3 to = screen.project(p + way * std::min(reach, 1e3f * from.z));
    const float dx = to.x - from.x, dy = to.y - from.y;
    const float pixels = std::max(std::abs(dx), std::abs(dy));
    if (!(pixels > 1)) return std::nullopt;
    const float part = std::min({1.0f, part_within(from.x, dx, static_cast<float>(screen.width())),
                                 part_within(from.y, dy, static_cast<float>(screen.height()))});
    const int steps = static_cast<int>(std::floor(part * pixels));
    // Along the line in the picture 1/depth is linear (under perspective; a parallel view's depth is itself).
    const bool perspective = screen.perspective();
    const auto depth_at = [&](float t) {
        return perspective ? 1 / lerp(1 / from.z, 1 / to.z, t) : lerp(from.z, to.z, t);
    };
    float before = from.z;
    for (int i = 1; i <= steps; ++i) {
        const float t = static_cast<float>(i) / pixels, depth = depth_at(t);
        const auto x = static_cast<int>(from.x + dx * t), y = static_cast<int>(from.y + dy * t);
        if (!screen.contains(from.x + dx * t, from.y + dy * t)) break;
        const float seen_depth = screen.depth(x, y);
        const float far = std::max(before, depth), near = std::min(before, depth);
        const float thickness = std::max(2 * (far - near), kThickness * seen_depth);
        before = depth;
        if (i < 2 || far < seen_depth || near > seen_depth + thickness) continue;
        const std::optional<Vec3> seen = screen.seen(x, y);
        if (!seen) continue;
        const Vec3 step = *seen - p;
        if (dot(n, step) > kSlack * length(step)) return ScreenHit{x, y};
    }
    return std::nullopt;
}

} // namespace duet::raster
