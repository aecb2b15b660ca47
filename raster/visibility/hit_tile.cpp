#include "raster/visibility/hit_tile.h"

#include "raster/visibility/packet_interpolation.h"

#include <utility>

namespace duet::raster {
namespace {

/// Returns the hit of a sphere that the ray meets, up to rounding.
Hit hit_sphere(const DrawSphere& sphere, const Ray& ray) {
    return {.object = sphere.object, .primitive = 0, .t = sphere.intersect(ray).value_or(sphere.nearest(ray))};
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
    : rect_(tile.rect()), pinhole_(view.pinhole), samples_per_pixel_(view.samples_per_pixel) {
    allocate();
    Filler filler(*this, geometry, view);
    for (int y = rect_.y0; y < rect_.y1; y += DepthTile::kPacketRows)
        for (int x = rect_.x0; x < rect_.x1; x += static_cast<int>(kPacketWidth))
            filler.fill(sample_packet(tile, x, y));
}

HitTile::HitTile(const LayeredTile& tile, std::size_t layer, const Geometry& geometry, const PassView& view)
    : rect_(tile.rect()), pinhole_(view.pinhole), samples_per_pixel_(view.samples_per_pixel) {
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
