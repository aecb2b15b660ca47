#include "raster/geometry/setup.h"

#include "raster/geometry/planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace duet::raster {
// The determinant's error comes from the vertices relative to the local origin. Their subtractions round at the
// magnitude of the vertices in the image, and each error is multiplied by a coefficient of e.
double Interpolation::rounding_error(const std::array<const PixelVertex*, 3>& corners) const {
    constexpr double kRoundoffs = 4 * std::numeric_limits<double>::epsilon();
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const PixelVertex& v = *corners[i];
        const Vec3d terms(std::abs(v.xw) + std::abs(origin_x * v.w), std::abs(v.yw) + std::abs(origin_y * v.w),
                          std::abs(v.w));
        sum += dot(terms, abs(e[i]));
    }
    return kRoundoffs * sum;
}

Interpolation::Interpolation(const PixelVertex& a, const PixelVertex& b, const PixelVertex& c, FixedPoint beside)
    : origin_x(floor_pixel(beside.x)), origin_y(floor_pixel(beside.y)), depth(a.depth, b.depth, c.depth) {
    const auto local = [&](const PixelVertex& v) { return Vec3d(v.xw - origin_x * v.w, v.yw - origin_y * v.w, v.w); };
    vertices = {local(a), local(b), local(c)};
    e = {cross(vertices[1], vertices[2]), cross(vertices[2], vertices[0]), cross(vertices[0], vertices[1])};
    const double determinant = dot(vertices[0], e[0]);
    is_edge_on = std::abs(determinant) <= rounding_error({&a, &b, &c});
    if (determinant < 0) e = {-e[0], -e[1], -e[2]};
}

// A sample that only the snapped triangle covers may lie outside, by less than 1/256 pixel. It is mirrored at the
// edge to a point equally far inside, not just moved onto the edge: two faces that meet at a silhouette edge have
// equal depths on it, but at a common point inside both, the depths show which one is in front.
Vec2d Interpolation::mirrored_inside(Vec2d p) const {
    for (const Vec3d& edge : e) {
        const double value = edge.x * p.x + edge.y * p.y + edge.z, steepness = edge.x * edge.x + edge.y * edge.y;
        constexpr double kReach = 1.0 / 128; // exceeded only in slivers, where mirroring is meaningless
        if (value < 0 && value * value < kReach * kReach / 4 * steepness)
            p = p - Vec2d(edge.x, edge.y) * (2 * value / steepness);
    }
    return p;
}

// This handles samples that mirroring moves across another edge, because they lie at a corner or because the
// triangle is thinner than the displacement by snapping. Clamping negative barycentrics to zero would be wrong: in
// a sliver, it moves the point from one end to the other.
Vec2d Interpolation::nearest_on_boundary(Vec2d p) const {
    const auto value = [](const Vec3d& edge, Vec2d q) { return edge.x * q.x + edge.y * q.y + edge.z; };
    Vec2d nearest = p;
    double least = std::numeric_limits<double>::infinity();
    const auto offer = [&](Vec2d q) {
        const double distance = dot(q - p, q - p);
        if (!(distance < least)) return;
        least = distance;
        nearest = q;
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d &edge = e[i], &next = e[(i + 1) % 3], &last = e[(i + 2) % 3];
        const Vec2d foot = p - Vec2d(edge.x, edge.y) * (value(edge, p) / (edge.x * edge.x + edge.y * edge.y));
        if (value(next, foot) >= 0 && value(last, foot) >= 0) offer(foot);
        const Vec3d meeting = cross(edge, next);
        const Vec2d corner(meeting.x / meeting.z, meeting.y / meeting.z);
        if (value(last, corner) > 0) offer(corner); // else the corner lies behind the eye
    }
    return nearest;
}

// A triangle seen edge-on is a segment in the image, with two points of its edges at each position along it. A sample
// beside the segment shows the nearer of the two points, and a sample beyond its ends the nearest corner.
Interpolated Interpolation::edge_on(Vec2d p) const {
    const auto steepness = [](const Vec3d& edge) { return edge.x * edge.x + edge.y * edge.y; };
    const Vec3d line = *std::ranges::max_element(e, {}, steepness);
    std::array<double, 3> along; // w times the distance from the sample along the segment, up to a factor
    for (std::size_t i = 0; i < 3; ++i)
        along[i] = (vertices[i].y - p.y * vertices[i].z) * line.x - (vertices[i].x - p.x * vertices[i].z) * line.y;
    std::pair least(std::numeric_limits<double>::infinity(), 0.0); // distance along the segment, then depth
    Interpolated nearest{1, 0, 0, 1, depth.x};
    const auto offer = [&](std::size_t i, std::size_t j, double s, double distance) {
        const double its_depth = lerp(depth[i], depth[j], s);
        if (!(std::pair(distance, its_depth) < least)) return;
        least = {distance, its_depth};
        std::array<double, 3> b{};
        b[i] = 1 - s, b[j] += s;
        nearest = {b[0], b[1], b[2], 1, its_depth};
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        if (vertices[i].z > 0) offer(i, j, 0, std::abs(along[i]) / vertices[i].z); // not behind the eye
        if ((along[i] < 0) == (along[j] < 0)) continue; // both ends lie on the same side of the sample
        const double s = along[i] / (along[i] - along[j]);
        if (lerp(vertices[i].z, vertices[j].z, s) > 0) offer(i, j, s, 0);
    }
    return nearest;
}

namespace {

/// Returns true if a sample lies in the other half of the quad, beyond the diagonal, which is not an edge of the
/// quad.
bool in_other_half(const Interpolated& at, TriangleKind triangle_kind) {
    const auto beyond = [](double across, double other1, double other2) {
        return other1 >= 0 && other2 >= 0 && across + other1 >= 0 && across + other2 >= 0;
    };
    switch (triangle_kind) {
    case TriangleKind::kQuadFirst:
        return beyond(at.b1, at.b0, at.b2);
    case TriangleKind::kQuadSecond:
        return beyond(at.b2, at.b0, at.b1);
    default:
        return false;
    }
}

} // namespace

Interpolated Interpolation::at(Vec2d pixel, TriangleKind triangle_kind) const {
    Vec2d p(pixel.x - origin_x, pixel.y - origin_y);
    if (is_edge_on) return edge_on(p);
    const auto value = [&](std::size_t i) { return e[i].x * p.x + e[i].y * p.y + e[i].z; };
    Interpolated result{value(0), value(1), value(2), 0, 0};
    const bool outside = result.b0 < 0 || result.b1 < 0 || result.b2 < 0;
    if (outside && !in_other_half(result, triangle_kind)) {
        const Vec2d sample = p;
        p = mirrored_inside(p);
        const bool still_outside = value(0) < 0 || value(1) < 0 || value(2) < 0;
        if (still_outside) p = nearest_on_boundary(sample);
        result = {std::max(0.0, value(0)), std::max(0.0, value(1)), std::max(0.0, value(2)), 0, 0};
    }
    result.sum = result.b0 + result.b1 + result.b2;
    if (!(result.sum > 0)) return edge_on({pixel.x - origin_x, pixel.y - origin_y});
    result.depth_sum = result.b0 * depth.x + result.b1 * depth.y + result.b2 * depth.z;
    return result;
}

Interpolated interpolate(const UnclippedTriangle& whole, Vec2d pixel) {
    const FixedPoint beside{static_cast<std::int32_t>(pixel.x) * kSubpixels,
                            static_cast<std::int32_t>(pixel.y) * kSubpixels};
    return Interpolation(whole.a, whole.b, whole.c, beside).at(pixel, whole.triangle_kind);
}

Interpolation interpolation(const UnclippedTriangle& whole, const std::array<FixedPoint, 3>& corners,
                            const Viewport& viewport) {
    const Origin from = origin(corners, viewport);
    return {whole.a, whole.b, whole.c, {from.x * kSubpixels, from.y * kSubpixels}};
}

// Σeᵢ / Σ(eᵢ·depthᵢ) is the inverse of the depth. With w = depth (perspective), Σ eᵢ·(xᵢ, yᵢ, wᵢ)
// = det · (x, y, 1), so the divisor is the determinant for every pixel. With w = 1 (orthographic), the dividend is
// the determinant.
DrawTriangle set_up(const UnclippedTriangle& whole, const std::array<FixedPoint, 3>& corners, std::uint32_t id,
                    bool clipped, const Viewport& viewport) {
    const Origin from = origin(corners, viewport);
    const PixelVertex &a = whole.a, &b = whole.b, &c = whole.c;
    const TrianglePlanes<double> all =
        triangle_planes<double>({a.xw - from.x * a.w, b.xw - from.x * b.w, c.xw - from.x * c.w},
                                {a.yw - from.y * a.w, b.yw - from.y * b.w, c.yw - from.y * c.w}, {a.w, b.w, c.w},
                                {a.depth, b.depth, c.depth});
    const auto& sum = viewport.orthographic ? all.depth_sum : all.sum;
    const double scale = (viewport.orthographic ? 1 : viewport.near) / std::abs(all.determinant);
    DrawTriangle result{.corners = corners, .id = id};
    set_plane(result, {sum[0] * scale, sum[1] * scale, sum[2] * scale}, std::min({a.depth, b.depth, c.depth}), clipped,
              viewport.near);
    return result;
}

void set_plane(DrawTriangle& triangle, const DepthPlane& plane, double min_depth, bool clipped, double near) {
    triangle.plane_reliable = std::isfinite(plane.x) && std::isfinite(plane.y) && std::isfinite(plane.constant);
    triangle.clipped = clipped;
    if (!clipped) triangle.nearest = static_cast<float>(near / min_depth) * (1 + 0x1p-22f);
    triangle.depth_plane = plane;
}

} // namespace duet::raster
