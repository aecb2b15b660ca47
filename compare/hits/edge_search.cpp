#include "compare/hits/edge_search.h"

#include <cmath>

namespace duet::compare {

namespace {

constexpr double kGoldenRatio = 1.6180339887498949;

struct EdgeSearcher {
    const ReferenceTracer& tracer;
    const Pinhole& pinhole;
    Vec2d pixel;
    double radius; ///< in pixels
    const Hit &a, &b;
    EdgeSearch result;
    double farthest = 0; ///< largest t of the closest hits of all rays so far; infinite if a ray misses

    /// Traces one displaced ray. Returns true once both hits have been found.
    bool try_at(Vec2d p) {
        if (dot(p - pixel, p - pixel) <= sqr(radius)) trace(p);
        return result.both();
    }
    ReferenceHit trace(Vec2d p) {
        const Rayd ray = pinhole.ray(p);
        const ReferenceHit nearest = tracer.nearest(ray);
        farthest = max(farthest, nearest.t);
        result.found_a = result.found_a || nearest.same_as(a);
        result.found_b = result.found_b || nearest.same_as(b);
        result.tied_a |= ties_with(ray, nearest, a, result.range_a);
        result.tied_b |= ties_with(ray, nearest, b, result.range_b);
        return nearest;
    }
    /// Returns whether the ray hits the primitive of a pipeline's hit at the same distance as its closest hit. Extends
    /// the range by that primitive's distance.
    bool ties_with(const Rayd& ray, const ReferenceHit& nearest, const Hit& hit, DistanceRange& range) const {
        if (!hit.valid()) return false;
        const ReferenceHit other = tracer.intersect(ray, hit.object, hit.primitive);
        if (!other.valid()) return false;
        range.extend(other.t);
        return nearest.valid() && relative_distance(tracer, ray, nearest, other) <= kTieTolerance;
    }
};

/// Tries displacements on circles whose radii halve toward the center. This resolves most disagreements, which are
/// ordinary edges.
bool try_circles(EdgeSearcher& search) {
    constexpr int kAngles = 16;
    for (double radius = search.radius * (1 - 1e-9); radius > search.radius / 100; radius /= 2)
        for (int i = 0; i < kAngles; ++i) {
            const double angle = (i + 0.5) * 2 * kPiDouble / kAngles;
            if (search.try_at(search.pixel + Vec2d(std::cos(angle), std::sin(angle)) * radius)) return true;
        }
    return false;
}

/// Tries Vogel's sunflower pattern, which covers the disk evenly for any number of points.
bool try_disk(EdgeSearcher& search) {
    constexpr int kPoints = 4096;
    for (int i = 0; i < kPoints; ++i) {
        const double radius = search.radius * std::sqrt((i + 0.5) / kPoints);
        const double angle = 2 * kPiDouble * i / sqr(kGoldenRatio);
        if (search.try_at(search.pixel + Vec2d(std::cos(angle), std::sin(angle)) * radius)) return true;
    }
    return false;
}

/// Returns the part of a homogeneous polygon (x·w, y·w, depth, w) where `plane` · vertex ≥ 0 (Sutherland and
/// Hodgman 1974).
std::vector<Vec4d> clip(const std::vector<Vec4d>& polygon, Vec4d plane) {
    const auto side = [&](Vec4d v) { return plane.x * v.x + plane.y * v.y + plane.z * v.z + plane.w * v.w; };
    std::vector<Vec4d> clipped;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec4d from = polygon[i], to = polygon[(i + 1) % polygon.size()];
        const double d0 = side(from), d1 = side(to);
        if (d0 >= 0) clipped.push_back(from);
        if ((d0 < 0) != (d1 < 0)) clipped.push_back(from + (to + from * -1.0) * (d0 / (d0 - d1)));
    }
    return clipped;
}

constexpr int kSides = 8;

/// Returns the part of a world-space polygon that projects into an octagon around `pixel`, in pixel
/// coordinates. The octagon's sides are `reach` away from `pixel`.
std::vector<Vec2d> clip_to_octagon(const Pinhole& pinhole, Vec2d pixel, const std::vector<Vec3d>& corners,
                                   double reach) {
    std::vector<Vec4d> polygon;
    for (const Vec3d& p : corners) polygon.push_back(pinhole.world_to_pixel * Vec4d(p, 1.0));
    // Depth is affine in world space (and equals w for a perspective camera). Clip to the near plane first.
    for (Vec4d& v : polygon) v.z -= pinhole.near;
    polygon = clip(polygon, {0, 0, 1, 0});
    for (int i = 0; i < kSides && !polygon.empty(); ++i) {
        const double angle = 2 * kPiDouble * i / kSides, x = std::cos(angle), y = std::sin(angle);
        polygon = clip(polygon, {-x, -y, 0, reach + x * pixel.x + y * pixel.y});
    }
    std::vector<Vec2d> points;
    for (const Vec4d& v : polygon)
        if (v.w > 0) points.emplace_back(v.x / v.w, v.y / v.w);
    return points;
}

/// Tries points just inside the border of a polygon from clip_to_octagon(). The border of a hidden face that is nearly
/// edge-on is where it meets the face in front of it.
bool try_border(EdgeSearcher& search, const std::vector<Vec2d>& polygon) {
    Vec2d middle;
    for (const Vec2d p : polygon) middle = middle + p * (1.0 / static_cast<double>(polygon.size()));
    constexpr int kPoints = 16;
    constexpr double kInside = 1e-5; // fraction of the distance to the center
    for (std::size_t i = 0; i < polygon.size(); ++i)
        for (int k = 0; k < kPoints; ++k) {
            const Vec2d p = polygon[i] + (polygon[(i + 1) % polygon.size()] - polygon[i]) * ((k + 0.5) / kPoints);
            if (search.try_at(p + (middle - p) * kInside)) return true;
        }
    return false;
}

/// Tries low-discrepancy points in the part of one primitive that lies within reach, triangle by triangle of
/// its fan. This finds slivers thousands of times thinner than the disk.
bool try_primitive(EdgeSearcher& search, const Hit& hit) {
    if (!hit.valid()) return false;
    const std::vector<Vec2d> polygon = // in the octagon inscribed in the disk
        clip_to_octagon(search.pinhole, search.pixel, search.tracer.corners(hit.object, hit.primitive),
                        search.radius * std::cos(kPiDouble / kSides));
    constexpr int kPoints = 64;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        for (int k = 0; k < kPoints; ++k) {
            // These are points of Roberts' R2 sequence, folded into the triangle.
            double s = std::fmod(0.5 + 0.7548776662466927 * k, 1.0), t = std::fmod(0.5 + 0.5698402909980532 * k, 1.0);
            if (s + t > 1) s = 1 - s, t = 1 - t;
            const Vec2d p = polygon[0] + (polygon[i] - polygon[0]) * s + (polygon[i + 1] - polygon[0]) * t;
            if (search.try_at(p)) return true;
        }
    return try_border(search, polygon);
}

/// Returns whether the rasterizer may show a primitive that no ray hits, because it projects to a line within reach of
/// the pixel: its plane contains the eye, or is parallel to all rays. Snapping may give the line some area. Some
/// displaced ray must reach as far as the hit.
bool edge_on(const EdgeSearcher& search, const Hit& hit) {
    constexpr double kRounding = 1e-12; // bound on the relative rounding error in double
    if (!hit.valid() || hit.t > search.farthest) return false;
    const Rayd ray = search.pinhole.ray(search.pixel);
    const double reach = search.radius * pixel_width(search.pinhole, search.pixel, hit.t);
    const std::vector<Vec3d> corners = search.tracer.corners(hit.object, hit.primitive);
    const bool line = plane_distance(corners, ray.origin) <= kRounding * (length(ray.origin) + hit.t) ||
                      search.tracer.cosine(ray, hit.object, hit.primitive, hit.t) < kRounding;
    return line && plane_distance(corners, ray.at(hit.t)) <= reach;
}

/// Returns whether any displaced ray could hit the primitive. It is false if the whole primitive projects
/// outside of the octagon around the disk, enlarged by a margin for rounding.
bool may_be_hit(const EdgeSearcher& search, const Hit& hit) {
    if (!hit.valid()) return true;
    const std::vector<Vec3d> corners = search.tracer.corners(hit.object, hit.primitive);
    return corners.empty() || !clip_to_octagon(search.pinhole, search.pixel, corners, 1.01 * search.radius).empty();
}

} // namespace

double pixel_width(const Pinhole& pinhole, Vec2d pixel, double t) {
    return length(pinhole.ray(pixel + Vec2d(1, 0)).at(t) - pinhole.ray(pixel).at(t));
}

EdgeSearch search_edge(const ReferenceTracer& tracer, const Pinhole& pinhole, Vec2d pixel, double radius, const Hit& a,
                       const Hit& b) {
    EdgeSearcher search{tracer, pinhole, pixel, radius, a, b, {}, 0};
    search.result.center = search.trace(pixel);
    search.result.center_hits_both = !search.result.range_a.empty() && !search.result.range_b.empty();
    if (!may_be_hit(search, a) || !may_be_hit(search, b)) return search.result;
    (void)(search.result.both() || try_circles(search) || try_primitive(search, a) || try_primitive(search, b) ||
           try_disk(search));
    search.result.found_a = search.result.found_a || edge_on(search, a);
    search.result.found_b = search.result.found_b || edge_on(search, b);
    return search.result;
}

} // namespace duet::compare
