#include "compare/hits/hit_agreement.h"

#include "common/system/parallel.h"
#include "common/vec/robust.h"
#include "compare/hits/edge_search.h"

#include <cmath>

namespace duet::compare {

namespace {

/// Returns the factor between the relative rounding error of a triangle's or quad's corners and the displacement of its
/// plane, in meters: the distance of the farthest corner from the eye times the primitive's aspect ratio. A float
/// ray-triangle test has this error; it is not proportional to the distance of the hit (Pharr, Jakob and Humphreys
/// 2023, §6.8.7). Returns 0 for a sphere, which has no corners.
double plane_reach(const std::vector<Vec3d>& corners, Vec3d eye) {
    if (corners.empty()) return 0;
    double reach = 0, longest_squared = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        reach = max(reach, length(corners[i] - eye));
        longest_squared = max(longest_squared, length_squared(corners[i] - corners[(i + 1) % corners.size()]));
    }
    const double doubled_area = length(cross(corners[1] - corners[0], corners[2] - corners[0]));
    return reach * max(1.0, longest_squared / doubled_area);
}

struct HitClassifier {
    const ReferenceTracer& tracer;
    Pinhole pinhole;

    Rayd ray(int x, int y) const { return pinhole.ray(center(x, y)); }
    static Vec2d center(int x, int y) { return {x + 0.5, y + 0.5}; }

    /// Returns a bound on the error of a hit's position due to rounding, in meters. The path tracer rounds the ray to
    /// float, and the rasterizer computes the primitive's plane in double. The second error matters for primitives that
    /// are 1e10 times as large as their distance, and for needles.
    double rounding(const Rayd& r, const Hit& hit) const {
        const double reach = plane_reach(tracer.corners(hit.object, hit.primitive), r.origin);
        return tracer.ray_rounding(r, hit.object, hit.t) + gamma_bound<double>(16) * reach;
    }

    /// Returns the largest displacement of rays, in pixels, that is tried to find both hits.
    double radius(int x, int y, const Hit& a, const Hit& b) const {
        constexpr double kLargest = 1e4; // in pixels; the plane of a triangle without area may be anywhere
        double result = kEdgeRadius;
        for (const Hit& hit : {a, b})
            if (hit.valid() && hit.t > 0) {
                const double pixel = pixel_width(pinhole, center(x, y), hit.t);
                result = max(result, kEdgeRadius + rounding(ray(x, y), hit) / pixel);
            }
        return min(result, kLargest);
    }

    /// Returns whether rounding decides on which side of a primitive the eye is.
    bool passes_eye(const Rayd& r, const Hit& hit) const {
        if (!hit.valid()) return false;
        const double cosine = tracer.cosine(r, hit.object, hit.primitive, hit.t), bound = rounding(r, hit);
        return cosine > 0 && hit.t * cosine <= bound &&
               plane_distance(tracer.corners(hit.object, hit.primitive), r.origin) <= bound;
    }

    /// Returns whether the ray hits both primitives at the same distance, or one of them at the eye.
    bool depth_tie(const Rayd& r, const Hit& a, const Hit& b) const {
        if (passes_eye(r, a) || passes_eye(r, b)) return true;
        if (!a.valid() || !b.valid()) return false;
        const ReferenceHit ea = tracer.intersect(r, a.object, a.primitive),
                           eb = tracer.intersect(r, b.object, b.primitive);
        if (!ea.valid() || !eb.valid()) return false;
        const double rounded = max(rounding(r, a), rounding(r, b)) / min(ea.t, eb.t);
        return relative_distance(tracer, r, ea, eb) <= kDepthTolerance + rounded;
    }

    HitVerdict verdict(int x, int y, const Hit& a, const Hit& b, ReferenceHit& exact) const {
        const EdgeSearch search = search_edge(tracer, pinhole, center(x, y), radius(x, y, a, b), a, b);
        exact = search.center;
        if (search.both()) return HitVerdict::kEdge;
        const bool tie = depth_tie(ray(x, y), a, b) || search.both_or_tied();
        return tie ? HitVerdict::kDepthTie : HitVerdict::kUnexplained;
    }

    /// Returns (|Δt|·|cos θ| − rounding) / max(t, reach) of two hits of one primitive, at least 0; or infinity unless
    /// both distances are finite and positive.
    double distance_error(int x, int y, const Hit& a, const Hit& b) const {
        const double ta = a.t, tb = b.t;
        if (!(std::isfinite(ta) && std::isfinite(tb) && ta > 0 && tb > 0))
            return std::numeric_limits<double>::infinity();
        const Rayd r = ray(x, y);
        const double reach = plane_reach(tracer.corners(a.object, a.primitive), r.origin);
        const double apart = std::abs(ta - tb) * tracer.cosine(r, a.object, a.primitive, tb);
        return max(apart - rounding(r, b), 0.0) / max(tb, reach);
    }
};

/// Holds the results of one row, so that rows can be judged in parallel and merged in order.
struct RowResult {
    HitAgreement counts;
    std::vector<UnexplainedPixel> listed;
};

void classify_pixel_hits(const HitClassifier& classifier, int x, int y, const Hit& a, const Hit& b, HitVerdict& verdict,
                         RowResult& row) {
    HitAgreement& counts = row.counts;
    if (a.object == b.object && (!a.valid() || a.primitive == b.primitive)) {
        verdict = HitVerdict::kSame;
        ++counts.same;
        if (!a.valid()) return;
        const double error = classifier.distance_error(x, y, a, b);
        if (!(error <= kDepthTolerance)) ++counts.distance_violations;
        if (error > counts.worst_distance) {
            counts.worst_distance = error;
            counts.worst_x = x;
            counts.worst_y = y;
        }
        return;
    }
    ReferenceHit exact;
    verdict = classifier.verdict(x, y, a, b, exact);
    if (verdict == HitVerdict::kEdge) ++counts.edge;
    if (verdict == HitVerdict::kDepthTie) ++counts.depth_tie;
    if (verdict == HitVerdict::kUnexplained) {
        ++counts.unexplained;
        row.listed.push_back({x, y, a, b, exact});
    }
}

void add(HitAgreement& total, const RowResult& row) {
    total.same += row.counts.same;
    total.edge += row.counts.edge;
    total.depth_tie += row.counts.depth_tie;
    total.unexplained += row.counts.unexplained;
    total.distance_violations += row.counts.distance_violations;
    if (row.counts.worst_distance > total.worst_distance) {
        total.worst_distance = row.counts.worst_distance;
        total.worst_x = row.counts.worst_x;
        total.worst_y = row.counts.worst_y;
    }
    for (const UnexplainedPixel& pixel : row.listed)
        if (total.listed.size() < kMaxListed) total.listed.push_back(pixel);
}

void check_hits(const Scene& scene, const View& view, const Image<Hit>& hits, const char* name) {
    if (hits.width() != view.width || hits.height() != view.height)
        throw Error(message(name, " hits are ", hits.width(), "x", hits.height(), " pixels, the view ", view.width, "x",
                            view.height));
    for (const Hit& hit : hits)
        if (hit.valid() && (hit.object >= scene.objects.size() ||
                            hit.primitive >= primitive_count(scene.shapes[scene.objects[hit.object].shape])))
            throw Error(message(name, " hits name object ", hit.object, ", primitive ", hit.primitive,
                                ", which the scene doesn't have"));
}

} // namespace

std::string UnexplainedPixel::describe() const {
    const auto text = [](const auto& hit) {
        return hit.valid() ? message("object ", hit.object, " primitive ", hit.primitive, " t ", hit.t)
                           : std::string("nothing");
    };
    return message("pixel (", x, ", ", y, "): raster sees ", text(raster), ", raytrace ", text(raytrace),
                   ", double precision ", text(exact));
}

HitAgreement compare_hits(const Scene& scene, const View& view, const Image<Hit>& raster, const Image<Hit>& raytrace,
                          int threads) {
    check_hits(scene, view, raster, "raster");
    check_hits(scene, view, raytrace, "raytrace");
    const CameraModel camera(view);
    const ReferenceTracer tracer(scene, camera.time(0));
    const HitClassifier classifier{tracer, camera.pinhole()};

    HitAgreement result;
    result.pixels = static_cast<std::int64_t>(raster.size());
    result.verdicts = Image<HitVerdict>(view.width, view.height);
    std::vector<RowResult> rows(static_cast<std::size_t>(view.height));
    parallel_for(rows.size(), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < view.width; ++x)
            classify_pixel_hits(classifier, x, y, raster(x, y), raytrace(x, y), result.verdicts(x, y), rows[row]);
    });
    for (const RowResult& row : rows) add(result, row);
    return result;
}

} // namespace duet::compare
