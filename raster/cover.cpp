#include "raster/cover.h"

#include <algorithm>

namespace duet::raster {
namespace {

/// The largest value of an edge function over the samples of a rectangle: at one of its corners.
std::int64_t largest(const EdgeFunction& edge, const PixelRect& r, SampleOffset offset) {
    const int x = edge.a > 0 ? r.x1 - 1 : r.x0, y = edge.b > 0 ? r.y1 - 1 : r.y0;
    return edge.at(std::int64_t{x} * kSubPixels + offset.x, std::int64_t{y} * kSubPixels + offset.y);
}

Hit make_hit(const SetupTriangle& triangle, const Interpolated& at, double distance) {
    Hit hit{.object = triangle.object, .primitive = triangle.primitive, .t = static_cast<float>(distance)};
    const double b1 = at.b1 / at.sum, b2 = at.b2 / at.sum;
    switch (triangle.piece) {
    case Piece::kTriangle:
        hit.u = static_cast<float>(b1), hit.v = static_cast<float>(b2);
        break;
    case Piece::kQuadFirst:
        hit.u = static_cast<float>(min(b1 + b2, 1.0)), hit.v = static_cast<float>(b2);
        break;
    case Piece::kQuadSecond:
        hit.u = static_cast<float>(b1), hit.v = static_cast<float>(min(b1 + b2, 1.0));
        break;
    }
    return hit;
}

} // namespace

HitTile::HitTile(const PixelRect& rect, const Pinhole& pinhole, SampleOffset offset, float time)
    : rect_(rect), near_(pinhole.near), offset_(offset) {
    const auto count = static_cast<std::size_t>(rect.x1 - rect.x0) * static_cast<std::size_t>(rect.y1 - rect.y0);
    rays_.reserve(count);
    distance_per_depth_.reserve(count);
    nearness_.assign(count, 0.0f);
    hits_.assign(count, Hit{});
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x) {
            const Rayd exact = pinhole.ray(offset.position(x, y));
            rays_.push_back({.origin = Vec3(exact.origin),
                             .direction = Vec3(exact.direction),
                             .t_min = static_cast<float>(exact.t_min),
                             .time = time});
            distance_per_depth_.push_back(exact.t_min / pinhole.near);
        }
}

bool HitTile::wins(std::size_t i, float nearness, std::uint32_t object, std::uint32_t primitive) const {
    if (nearness != nearness_[i] || sabotaged(Guard::kDrawOrder)) return nearness > nearness_[i];
    const Hit& other = hits_[i];
    return object != other.object ? object < other.object : primitive < other.primitive;
}

/// Walks the rows of the triangle's bounding box with the three edge functions at hand: a step is three additions, and
/// a sample is inside where none of the three is negative.
void HitTile::draw(const SetupTriangle& triangle) {
    const auto& p = triangle.corners;
    const PixelRect r = intersect(rect_, pixels_within(p, offset_));
    if (r.empty()) return;
    const std::array<EdgeFunction, 3> edges{EdgeFunction(p[0], p[1]), EdgeFunction(p[1], p[2]),
                                            EdgeFunction(p[2], p[0])};
    for (const EdgeFunction& edge : edges)
        if (largest(edge, r, offset_) < 0) return;

    const std::int64_t first_x = std::int64_t{r.x0} * kSubPixels + offset_.x;
    for (int y = r.y0; y < r.y1; ++y) {
        const std::int64_t sample_y = std::int64_t{y} * kSubPixels + offset_.y;
        std::int64_t e0 = edges[0].at(first_x, sample_y), e1 = edges[1].at(first_x, sample_y),
                     e2 = edges[2].at(first_x, sample_y);
        bool entered = false;
        for (int x = r.x0; x < r.x1; ++x) {
            if ((e0 | e1 | e2) >= 0) {
                cover(triangle, x, y);
                entered = true;
            } else if (entered) {
                break; // a row meets a triangle in one span
            }
            e0 += edges[0].a * kSubPixels;
            e1 += edges[1].a * kSubPixels;
            e2 += edges[2].a * kSubPixels;
        }
    }
}

void HitTile::cover(const SetupTriangle& triangle, int x, int y) {
    const std::size_t i = index(x, y);
    const Interpolated at = triangle.interpolation.at(offset_.position(x, y), triangle.piece);
    // Clamped to the triangle's border, a point may come to lie before the near plane at which the outline was cut.
    const bool beyond_near = at.depth_sum > near_ * at.sum;
    float nearness = beyond_near ? static_cast<float>(near_ * at.sum / at.depth_sum) : 1.0f;
    if (sabotaged(Guard::kReversedDepth)) nearness = 1 - (1 - nearness); // kept as the books': 0 near, 1 far
    if (!wins(i, nearness, triangle.object, triangle.primitive)) return;
    nearness_[i] = nearness;
    const double depth = beyond_near ? at.depth_sum / at.sum : near_;
    hits_[i] = make_hit(triangle, at, depth * distance_per_depth_[i]);
}

void HitTile::draw(const DrawSphere& sphere) {
    const PixelRect r = intersect(rect_, sphere.bounds);
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) {
            const std::size_t i = index(x, y);
            const std::optional<float> t = sphere.intersect(rays_[i]);
            if (!t) continue;
            const auto nearness = static_cast<float>(near_ * distance_per_depth_[i] / static_cast<double>(*t));
            if (!wins(i, nearness, sphere.object, 0)) continue;
            nearness_[i] = nearness;
            hits_[i] = {.object = sphere.object, .primitive = 0, .u = 0, .v = 0, .t = *t};
        }
}

HitTile cover(const PixelRect& rect, const PassView& view, SampleOffset offset, const Geometry& geometry,
              std::size_t index) {
    HitTile tile(rect, view.pinhole, offset, view.time);
    for (const std::uint32_t i : geometry.triangle_bins.tile(index)) tile.draw(geometry.list.triangles[i]);
    for (const std::uint32_t i : geometry.sphere_bins.tile(index)) tile.draw(geometry.spheres[i]);
    return tile;
}

} // namespace duet::raster
