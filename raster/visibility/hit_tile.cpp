#include "raster/visibility/hit_tile.h"

#include "raster/visibility/packet_interpolation.h"

#include <utility>

namespace duet::raster {
namespace {

void draw(const DrawSphere& sphere, const PassView& view, DepthTile& tile) {
    constexpr int kLanes = static_cast<int>(Doubles::size);
    const PixelRect r = intersect(tile.rect(), sphere.bounds);
    alignas(64) std::array<double, Doubles::size> reversed_depth;
    for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; x += kLanes) {
            const Vec2d first = tile.offset().position(x, y);
            const CameraRays rays(view.pinhole, Doubles(first.x) + kLanesAsDoubles, Doubles(first.y));
            const Doubles t = sphere.intersect(rays);
            (rays.t_min / t).store_aligned(reversed_depth.data()); // 0 on a miss
            for (int i = 0; i < std::min(kLanes, r.x1 - x); ++i)
                if (const double n = reversed_depth[static_cast<std::size_t>(i)]; n > 0)
                    tile.draw(x + i, y, sphere.id, to_stored_depth(n));
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

Hit make_hit(Geometry::Primitive of, TriangleKind triangle_kind, double b1, double b2, double distance) {
    Hit hit{.object = of.object, .primitive = of.primitive, .t = static_cast<float>(distance)};
    switch (triangle_kind) {
    case TriangleKind::kTriangle:
        hit.u = static_cast<float>(b1), hit.v = static_cast<float>(b2);
        break;
    case TriangleKind::kQuadFirst:
        hit.u = static_cast<float>(min(b1 + b2, 1.0)), hit.v = static_cast<float>(b2);
        break;
    case TriangleKind::kQuadSecond:
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

void rasterize_drawn_blocks(const Geometry& geometry, const PassView& view, SampleOffset offset, const PixelRect& rect,
                            std::size_t index, DepthTile& tile) {
    tile.reset(rect, offset, view.viewport);
    draw_all(geometry, geometry.triangle_lists.tile(index), &Batch::triangles, &Batch::order,
             [&](const DrawTriangle& triangle) { tile.draw(triangle, geometry.triangles); });
    draw_all(geometry, geometry.mask_lists.tile(index), &Batch::coverage_masks, &Batch::mask_order,
             [&](const CoverageMask& mask) { tile.draw(mask); });
    const auto fragments = [&](const TileLists::Item& item) {
        return std::span(geometry.batches[item.batch].fragments).subspan(item.first, item.count);
    };
    const std::span<const TileLists::Item> lists = geometry.fragment_lists.tile(index);
    for (std::size_t i = 0; i < lists.size(); ++i) {
        if (i + 1 < lists.size()) prefetch(fragments(lists[i + 1]).data());
        tile.draw(fragments(lists[i]));
    }
    for (const std::uint32_t i : geometry.sphere_bins.tile(index)) draw(geometry.spheres[i], view, tile);
}

void rasterize_tile(const Geometry& geometry, const PassView& view, SampleOffset offset, const PixelRect& rect,
                    std::size_t index, DepthTile& tile) {
    rasterize_drawn_blocks(geometry, view, offset, rect, index, tile);
    tile.clear_undrawn();
}

Hit hit_triangle(const UnclippedTriangle& whole, Geometry::Primitive primitive, Vec2d pixel, double distance_per_depth,
                 double near) {
    const Interpolated at = interpolate(whole, pixel);
    const double depth = at.depth_sum > near * at.sum ? at.depth_sum / at.sum : near;
    return make_hit(primitive, whole.triangle_kind, at.b1 / at.sum, at.b2 / at.sum, depth * distance_per_depth);
}

Hit HitTile::exchange(int x, int y, const Hit& hit) {
    const std::size_t i = index(x, y);
    reversed_depth_[i] =
        hit.valid() ? static_cast<float>(pinhole_.near * distance_per_depth_[i] / static_cast<double>(hit.t)) : 0;
    return std::exchange(hits_[i], hit);
}

Hit find_hit(const Geometry& geometry, const PassView& view, std::uint32_t id, Vec2d pixel) {
    const Triangles& triangles = geometry.triangles;
    const Run& run = triangles.run_of(id);
    const Rayd exact = view.pinhole.ray(pixel);
    if (run.sphere) return hit_sphere(geometry.spheres[run.object], rounded(exact, view.time));
    return hit_triangle(triangles.unclipped(run, Triangles::index(run, id)), geometry.primitive(run, id), pixel,
                        exact.t_min / view.pinhole.near, view.pinhole.near);
}

/// Computes the rays and hits of packets.
class HitTile::Filler {
public:
    Filler(HitTile& tile, const Geometry& geometry, const PassView& view)
        : tile_(tile), geometry_(geometry), view_(view),
          interpolator_(geometry.triangles, view, tile.rect_, nothing_, false) {}

    void fill(const SamplePacket& packet) {
        interpolator_.interpolate_packets(std::span(&packet, 1), false,
                                          [&](std::size_t, const auto& results) { fill(packet, results.front()); });
    }

private:
    void fill(const SamplePacket& packet, const InterpolatedPacket<NoVaryings, double>& result) {
        PacketOf<double> xs, ys;
        for (std::size_t i = 0; i < kPacketSize; ++i) {
            const Vec2d p = packet.position(i);
            xs[i] = p.x, ys[i] = p.y;
        }
        const double near = view_.pinhole.near;
        for (std::size_t first = 0; first < kPacketSize; first += Doubles::size) {
            const CameraRays rays(view_.pinhole, load(xs, first), load(ys, first));
            for (std::size_t lane = 0; lane < Doubles::size; ++lane) {
                const std::size_t i = first + lane;
                const int x = packet.x + static_cast<int>(i % kPacketWidth),
                          y = packet.y + static_cast<int>(i / kPacketWidth);
                if (x >= tile_.rect_.x1 || y >= tile_.rect_.y1) continue;
                const std::size_t at = tile_.index(x, y);
                const double t_min = rays.t_min.get(lane);
                tile_.rays_[at] = rays.at(lane, view_.time);
                tile_.distance_per_depth_[at] = t_min / near;
                if (!(result.samples->visible >> i & 1)) continue;
                tile_.hits_[at] = hit(i, packet, result, at);
                tile_.reversed_depth_[at] =
                    packet.reversed_depth != nullptr
                        ? packet.reversed_depth[i]
                        : static_cast<float>(min(t_min / static_cast<double>(tile_.hits_[at].t), 1.0));
            }
        }
    }

    Hit hit(std::size_t i, const SamplePacket& packet, const InterpolatedPacket<NoVaryings, double>& result,
            std::size_t at) const {
        const std::uint32_t id = result.samples->id(i);
        const Run& run = interpolator_.run_of(id);
        if (run.sphere) return hit_sphere(geometry_.spheres[run.object], tile_.rays_[at]);
        if (!(result.samples->on_mesh & result.inside & 1u << i))
            return find_hit(geometry_, view_, id, packet.position(i));
        const double depth = std::max(result.depth[i], view_.pinhole.near);
        return make_hit(geometry_.primitive(run, id), result.samples->shape->triangle_kind(Triangles::index(run, id)),
                        static_cast<double>(result.b1[i]), static_cast<double>(result.b2[i]),
                        depth * tile_.distance_per_depth_[at]);
    }

    HitTile& tile_;
    const Geometry& geometry_;
    const PassView& view_;
    NoVaryings nothing_;
    PacketInterpolator<NoVaryings, double> interpolator_;
};

void HitTile::allocate() {
    const auto count = static_cast<std::size_t>(rect_.width()) * static_cast<std::size_t>(rect_.height());
    rays_.resize(count);
    distance_per_depth_.resize(count);
    reversed_depth_.resize(count);
    hits_.resize(count);
}

HitTile::HitTile(const DepthTile& tile, const Geometry& geometry, const PassView& view)
    : rect_(tile.rect()), pinhole_(view.pinhole) {
    allocate();
    Filler filler(*this, geometry, view);
    for (int y = rect_.y0; y < rect_.y1; y += DepthTile::kPacketRows)
        for (int x = rect_.x0; x < rect_.x1; x += static_cast<int>(kPacketWidth))
            filler.fill(sample_packet(tile, x, y));
}

HitTile::HitTile(const LayeredTile& tile, std::size_t layer, const Geometry& geometry, const PassView& view)
    : rect_(tile.rect()), pinhole_(view.pinhole) {
    allocate();
    Filler filler(*this, geometry, view);
    LayeredTile::LayerPacket layer_packet;
    for (int y = rect_.y0; y < rect_.y1; y += DepthTile::kPacketRows)
        for (int x = rect_.x0; x < rect_.x1; x += static_cast<int>(kPacketWidth)) {
            tile.layer_packet(layer, x, y, layer_packet);
            if (layer_packet.packet.ids != nullptr) filler.fill(layer_packet.packet);
        }
}

} // namespace duet::raster
