#include "raster/visibility/cover.h"

#include "raster/shader/solve.h"

#include <utility>

namespace duet::raster {
namespace {

void draw(const DrawSphere& sphere, const PassView& view, DepthTile& tile) {
    constexpr int kLanes = static_cast<int>(Doubles::size);
    const PixelRect r = intersect(tile.rect(), sphere.bounds);
    alignas(64) std::array<double, Doubles::size> nearness;
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; x += kLanes) {
            const Vec2d first = tile.offset().position(x, y);
            const CameraRays rays(view.pinhole, Doubles(first.x) + kLanesAsDoubles, Doubles(first.y));
            const Doubles t = sphere.intersect(rays);
            (rays.t_min / t).store_aligned(nearness.data()); // 0 on a miss
            for (int i = 0; i < std::min(kLanes, r.x1 - x); ++i)
                if (const double n = nearness[static_cast<std::size_t>(i)]; n > 0)
                    tile.draw(x + i, y, sphere.id, kept_nearness(n));
        }
}

/// Returns the hit of a sphere that the ray meets, up to rounding.
Hit hit_sphere(const DrawSphere& sphere, const Ray& ray) {
    return {.object = sphere.object, .primitive = 0, .t = sphere.intersect(ray).value_or(sphere.nearest(ray))};
}

/// Draws a tile's items of all batches in order, and prefetches the next ones.
template <typename Item, typename Draw>
void draw_all(const Geometry& geometry, std::span<const TileLists::Item> lists, std::vector<Item> Batch::*items,
              std::vector<std::uint32_t> Batch::*order, const Draw& draw_one) {
    constexpr std::uint32_t kAhead = 8;
    const auto item = [&](const TileLists::Item& list, std::uint32_t k) -> const Item& {
        const Batch& batch = geometry.batches[list.batch];
        return (batch.*items)[(batch.*order)[list.first + k]];
    };
    for (std::size_t i = 0; i < lists.size(); ++i) {
        if (i == 0)
            for (std::uint32_t k = 0; k < std::min(kAhead, lists[i].count); ++k) prefetch(&item(lists[i], k));
        if (i + 1 < lists.size())
            for (std::uint32_t k = 0; k < std::min(kAhead, lists[i + 1].count); ++k) prefetch(&item(lists[i + 1], k));
        for (std::uint32_t k = 0; k < lists[i].count; ++k) {
            if (k + kAhead < lists[i].count) prefetch(&item(lists[i], k + kAhead));
            draw_one(item(lists[i], k));
        }
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

void draw_tile(const Geometry& geometry, const PassView& view, SampleOffset offset, const PixelRect& rect,
               std::size_t index, DepthTile& tile) {
    tile.reset(rect, offset, view.viewport);
    draw_all(geometry, geometry.outlines.tile(index), &Batch::triangles, &Batch::order,
             [&](const DrawTriangle& triangle) { tile.draw(triangle, geometry.triangles); });
    draw_all(geometry, geometry.patches.tile(index), &Batch::patches, &Batch::patch_order,
             [&](const Patch& patch) { tile.draw(patch); });
    const auto fragments = [&](const TileLists::Item& item) {
        return std::span(geometry.batches[item.batch].fragments).subspan(item.first, item.count);
    };
    const std::span<const TileLists::Item> lists = geometry.fragments.tile(index);
    for (std::size_t i = 0; i < lists.size(); ++i) {
        if (i + 1 < lists.size()) prefetch(fragments(lists[i + 1]).data());
        tile.draw(fragments(lists[i]));
    }
    if (!geometry.spheres.empty())
        for (const std::uint32_t i : geometry.sphere_bins.tile(index)) draw(geometry.spheres[i], view, tile);
}

void cover(const Geometry& geometry, const PassView& view, SampleOffset offset, const PixelRect& rect,
           std::size_t index, DepthTile& tile) {
    draw_tile(geometry, view, offset, rect, index, tile);
    tile.empty_undrawn();
}

Hit hit_triangle(const WholeTriangle& whole, std::uint32_t object, std::uint32_t primitive, Vec2d pixel,
                 double distance_per_depth, double near) {
    const Interpolated at = interpolate(whole, pixel);
    const double depth = at.depth_sum > near * at.sum ? at.depth_sum / at.sum : near;
    return make_hit(object, primitive, whole.piece, at.b1 / at.sum, at.b2 / at.sum, depth * distance_per_depth);
}

Hit HitTile::exchange(int x, int y, const Hit& hit) {
    const std::size_t i = index(x, y);
    nearness_[i] =
        hit.valid() ? static_cast<float>(pinhole_.near * distance_per_depth_[i] / static_cast<double>(hit.t)) : 0;
    return std::exchange(hits_[i], hit);
}

Hit find_hit(const Geometry& geometry, const PassView& view, std::uint32_t id, Vec2d pixel) {
    const Triangles& triangles = geometry.triangles;
    const Run& run = triangles.run_of(id);
    const Rayd exact = view.pinhole.ray(pixel);
    if (run.sphere) return hit_sphere(geometry.spheres[run.object], rounded(exact, view.time));
    const std::uint32_t index = Triangles::index(run, id);
    const WholeTriangle whole = triangles.whole(run, index);
    return hit_triangle(whole, triangles.objects[run.object].object,
                        whole.piece == Piece::kTriangle ? index : index / 2, pixel, exact.t_min / view.pinhole.near,
                        view.pinhole.near);
}

/// Computes the rays and hits of packets.
class HitTile::Filler {
public:
    Filler(HitTile& tile, const Geometry& geometry, const PassView& view)
        : tile_(tile), geometry_(geometry), view_(view),
          solver_(geometry.triangles, view, tile.rect_, nothing_, false) {}

    void fill(const StripPlace& place) {
        solver_.solve(std::span(&place, 1), false,
                      [&](std::size_t, const auto& strips) { fill(place, strips.front()); });
    }

private:
    void fill(const StripPlace& place, const SolvedStrip<NoVaryings, double>& strip) {
        StripOf<double> xs, ys;
        for (std::size_t i = 0; i < kStrip; ++i) {
            const Vec2d p = place.position(i);
            xs[i] = p.x, ys[i] = p.y;
        }
        const double near = view_.pinhole.near;
        for (std::size_t first = 0; first < kStrip; first += Doubles::size) {
            const CameraRays rays(view_.pinhole, load(xs, first), load(ys, first));
            for (std::size_t lane = 0; lane < Doubles::size; ++lane) {
                const std::size_t i = first + lane;
                const int x = place.x + static_cast<int>(i % kStripWidth),
                          y = place.y + static_cast<int>(i / kStripWidth);
                if (x >= tile_.rect_.x1 || y >= tile_.rect_.y1) continue;
                const std::size_t at = tile_.index(x, y);
                const double t_min = rays.t_min.get(lane);
                tile_.rays_[at] = rays.at(lane, view_.time);
                tile_.distance_per_depth_[at] = t_min / near;
                if (!(strip.samples->seen >> i & 1)) continue;
                tile_.hits_[at] = hit(i, place, strip, at);
                tile_.nearness_[at] =
                    place.nearness != nullptr
                        ? place.nearness[i]
                        : static_cast<float>(min(t_min / static_cast<double>(tile_.hits_[at].t), 1.0));
            }
        }
    }

    Hit hit(std::size_t i, const StripPlace& place, const SolvedStrip<NoVaryings, double>& strip,
            std::size_t at) const {
        const Triangles& triangles = geometry_.triangles;
        const std::uint32_t id = strip.samples->id(i);
        const Run& run = solver_.run_of(id);
        if (run.sphere) return hit_sphere(geometry_.spheres[run.object], tile_.rays_[at]);
        if (!(strip.samples->on_mesh & strip.inside & 1u << i))
            return find_hit(geometry_, view_, id, place.position(i));
        const double depth = std::max(strip.depth[i], view_.pinhole.near);
        const std::uint32_t index = Triangles::index(run, id);
        const PackedShape& shape = *strip.samples->shape;
        return make_hit(triangles.objects[run.object].object, static_cast<std::uint32_t>(shape.primitive(index)),
                        shape.piece(index), static_cast<double>(strip.b1[i]), static_cast<double>(strip.b2[i]),
                        depth * tile_.distance_per_depth_[at]);
    }

    HitTile& tile_;
    const Geometry& geometry_;
    const PassView& view_;
    NoVaryings nothing_;
    StripSolver<NoVaryings, double> solver_;
};

void HitTile::make_room() {
    const auto count = static_cast<std::size_t>(rect_.width()) * static_cast<std::size_t>(rect_.height());
    rays_.resize(count);
    distance_per_depth_.resize(count);
    nearness_.resize(count);
    hits_.resize(count);
}

HitTile::HitTile(const DepthTile& tile, const Geometry& geometry, const PassView& view)
    : rect_(tile.rect()), pinhole_(view.pinhole), screen_(view.screen),
      quadrant_((tile.offset().x < kSubPixels / 2 ? 0 : 1) + (tile.offset().y < kSubPixels / 2 ? 0 : 2)) {
    make_room();
    Filler filler(*this, geometry, view);
    for (int y = rect_.y0; y < rect_.y1; y += DepthTile::kStripRows)
        for (int x = rect_.x0; x < rect_.x1; x += static_cast<int>(kStripWidth)) filler.fill(strip_place(tile, x, y));
}

HitTile::HitTile(const LayeredTile& tile, std::size_t layer, const Geometry& geometry, const PassView& view)
    : rect_(tile.rect()), pinhole_(view.pinhole), screen_(view.screen) {
    make_room();
    Filler filler(*this, geometry, view);
    LayeredTile::Strip strip;
    for (int y = rect_.y0; y < rect_.y1; y += DepthTile::kStripRows)
        for (int x = rect_.x0; x < rect_.x1; x += static_cast<int>(kStripWidth)) {
            tile.strip(layer, x, y, strip);
            if (strip.place.ids != nullptr) filler.fill(strip.place);
        }
}

} // namespace duet::raster
