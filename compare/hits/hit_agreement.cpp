#include "compare/hits/hit_agreement.h"

#include "common/system/parallel.h"
#include "compare/hits/edge_search.h"

#include <cmath>

namespace duet::compare {

namespace {

struct Judge {
    const ExactTracer& tracer;
    Pinhole pinhole;

    Rayd ray(int x, int y) const { return pinhole.ray(center(x, y)); }
    static Vec2d center(int x, int y) { return {x + 0.5, y + 0.5}; }

    /// Returns whether the ray hits both primitives at the same distance.
    bool depth_tie(const Rayd& r, const Hit& a, const Hit& b) const {
        if (!a.valid() || !b.valid()) return false;
        const ExactHit ea = tracer.intersect(r, a.object, a.primitive), eb = tracer.intersect(r, b.object, b.primitive);
        return ea.valid() && eb.valid() && distance_apart(tracer, r, ea, eb) <= kDepthTolerance;
    }

    Verdict verdict(int x, int y, const Hit& a, const Hit& b, ExactHit& exact) const {
        const EdgeSearch search = search_edge(tracer, pinhole, center(x, y), a, b);
        exact = search.center;
        if (search.both()) return Verdict::kEdge;
        const bool tie = depth_tie(ray(x, y), a, b) || search.both_or_tied();
        return tie ? Verdict::kDepthTie : Verdict::kUnexplained;
    }

    /// Returns |Δt|·|cos θ| / t of two hits of one primitive, or infinity unless both distances are finite and
    /// positive.
    double distance_error(int x, int y, const Hit& a, const Hit& b) const {
        const double ta = a.t, tb = b.t;
        if (!(std::isfinite(ta) && std::isfinite(tb) && ta > 0 && tb > 0))
            return std::numeric_limits<double>::infinity();
        return std::abs(ta - tb) * tracer.cosine(ray(x, y), a.object, a.primitive, tb) / tb;
    }
};

/// The results of one row, so that rows can be judged in parallel and merged in order.
struct RowResult {
    HitAgreement counts;
    std::vector<UnexplainedPixel> listed;
};

void judge_pixel(const Judge& judge, int x, int y, const Hit& a, const Hit& b, Verdict& verdict, RowResult& row) {
    HitAgreement& counts = row.counts;
    if (a.object == b.object && (!a.valid() || a.primitive == b.primitive)) {
        verdict = Verdict::kSame;
        ++counts.same;
        if (!a.valid()) return;
        const double error = judge.distance_error(x, y, a, b);
        if (!(error <= kDepthTolerance)) ++counts.distance_violations;
        if (error > counts.worst_distance) {
            counts.worst_distance = error;
            counts.worst_x = x;
            counts.worst_y = y;
        }
        return;
    }
    ExactHit exact;
    verdict = judge.verdict(x, y, a, b, exact);
    if (verdict == Verdict::kEdge) ++counts.edge;
    if (verdict == Verdict::kDepthTie) ++counts.depth_tie;
    if (verdict == Verdict::kUnexplained) {
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
        if (total.listed.size() < kListed) total.listed.push_back(pixel);
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

HitAgreement compare_hits(const Scene& scene, const View& view, const Image<Hit>& raster, const Image<Hit>& raytrace,
                          int threads) {
    check_hits(scene, view, raster, "raster");
    check_hits(scene, view, raytrace, "raytrace");
    const CameraModel camera(view);
    const ExactTracer tracer(scene, camera.time(0));
    const Judge judge{tracer, camera.through()};

    HitAgreement result;
    result.pixels = static_cast<std::int64_t>(raster.size());
    result.verdicts = Image<Verdict>(view.width, view.height);
    std::vector<RowResult> rows(static_cast<std::size_t>(view.height));
    parallel_for(rows.size(), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < view.width; ++x)
            judge_pixel(judge, x, y, raster(x, y), raytrace(x, y), result.verdicts(x, y), rows[row]);
    });
    for (const RowResult& row : rows) add(result, row);
    return result;
}

} // namespace duet::compare
