#include "raster/cover.h"

#include "raster/solve.h"

namespace duet::raster {
namespace {

void draw(const DrawSphere& sphere, const PassView& view, DepthTile& tile) {
    const PixelRect r = intersect(tile.rect(), sphere.bounds);
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) {
            const Rayd exact = view.pinhole.ray(tile.offset().position(x, y));
            const std::optional<float> t = sphere.intersect(rounded(exact, view.time));
            if (t) tile.draw(x, y, sphere.id, kept_nearness(exact.t_min / static_cast<double>(*t)));
        }
}

Hit make_hit(std::uint32_t object, std::uint32_t primitive, Piece piece, double b1, double b2, double distance) {
    Hit hit{.object = object, .primitive = primitive, .t = static_cast<float>(distance)};
    switch (piece) {
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

Ray rounded(const Rayd& exact, float time) {
    return {.origin = Vec3(exact.origin),
            .direction = Vec3(exact.direction),
            .t_min = static_cast<float>(exact.t_min),
            .time = time};
}

void cover(const Geometry& geometry, const PassView& view, SampleOffset offset, const PixelRect& rect,
           std::size_t index, DepthTile& tile) {
    tile.reset(rect, offset, view.viewport);
    for (const TileLists::Item& item : geometry.outlines.tile(index)) {
        const Batch& batch = geometry.batches[item.batch];
        constexpr std::uint32_t kAhead = 8;
        for (std::uint32_t k = 0; k < item.count; ++k) {
            if (k + kAhead < item.count) prefetch(&batch.triangles[batch.order[item.first + k + kAhead]]);
            tile.draw(batch.triangles[batch.order[item.first + k]], geometry.triangles);
        }
    }
    for (const TileLists::Item& item : geometry.fragments.tile(index))
        tile.draw(std::span(geometry.batches[item.batch].fragments).subspan(item.first, item.count));
    if (!geometry.spheres.empty())
        for (const std::uint32_t i : geometry.sphere_bins.tile(index)) draw(geometry.spheres[i], view, tile);
}

Hit hit_triangle(const WholeTriangle& whole, std::uint32_t object, std::uint32_t primitive, Vec2d pixel,
                 double distance_per_depth, double near) {
    const Interpolated at = interpolate(whole, pixel);
    const double depth = at.depth_sum > near * at.sum ? at.depth_sum / at.sum : near;
    return make_hit(object, primitive, whole.piece, at.b1 / at.sum, at.b2 / at.sum, depth * distance_per_depth);
}

HitTile::HitTile(const DepthTile& tile, const Geometry& geometry, const PassView& view)
    : rect_(tile.rect()), screen_(view.screen) {
    const auto count = static_cast<std::size_t>(rect_.width()) * static_cast<std::size_t>(rect_.height());
    rays_.reserve(count);
    distance_per_depth_.reserve(count);
    nearness_.reserve(count);
    const Pinhole& pinhole = view.pinhole;
    for (int y = rect_.y0; y < rect_.y1; ++y)
        for (int x = rect_.x0; x < rect_.x1; ++x) {
            const Rayd exact = pinhole.ray(tile.offset().position(x, y));
            rays_.push_back(rounded(exact, view.time));
            distance_per_depth_.push_back(exact.t_min / pinhole.near);
            nearness_.push_back(tile.nearness(x, y));
        }
    hits_.assign(count, Hit{});
    const Triangles& triangles = geometry.triangles;
    StripSolver solver(triangles, view, rect_);
    for (std::size_t place = 0; place < kTileSamples; place += kStrip) {
        const int x0 = rect_.x0 + place_x(place), y0 = rect_.y0 + place_y(place);
        if (!tile.drawn(place / kBlockSamples) || x0 >= rect_.x1 || y0 >= rect_.y1) continue;
        solver.load(tile.ids() + place);
        if (solver.seen() == 0) continue;
        solver.solve(x0, y0, tile.offset());
        for (std::size_t i = 0; i < kStrip; ++i) {
            const int x = x0 + static_cast<int>(i % kStripWidth), y = y0 + static_cast<int>(i / kStripWidth);
            if (!(solver.seen() >> i & 1) || x >= rect_.x1 || y >= rect_.y1) continue;
            const std::size_t at = index(x, y);
            const Run& run = solver.run(i);
            if (run.sphere) {
                const DrawSphere& sphere = geometry.spheres[run.object];
                hits_[at] = {.object = sphere.object, .primitive = 0, .t = *sphere.intersect(rays_[at])};
                continue;
            }
            const std::uint32_t triangle = Triangles::index(run, solver.id(i)),
                                object = triangles.objects[run.object].object;
            if (solver.inside() >> i & 1) {
                const double depth = std::max(solver.depth[i], pinhole.near);
                hits_[at] = make_hit(object, triangle, Piece::kTriangle, solver.b1[i], solver.b2[i],
                                     depth * distance_per_depth_[at]);
                continue;
            }
            const WholeTriangle whole = triangles.whole(run, triangle);
            const std::uint32_t primitive = whole.piece == Piece::kTriangle ? triangle : triangle / 2;
            hits_[at] = hit_triangle(whole, object, primitive, tile.offset().position(x, y), distance_per_depth_[at],
                                     pinhole.near);
        }
    }
}

} // namespace duet::raster
