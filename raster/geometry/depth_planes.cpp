#include "raster/geometry/assemble.h"

#include "raster/geometry/planes.h"

#include <bit>
#include <optional>

namespace duet::raster {
/// Computes the planes of reversed depth for up to sixteen unclipped triangles of the object with SIMD, as set_up
/// does for one triangle. Each plane has its own pixel origin, which `origin_of` returns.
template <typename IndexOf, typename OriginOf>
void Assembler::compute_planes(std::size_t count, const IndexOf& index_of, const OriginOf& origin_of,
                               PlanePacket& planes) const {
    const Viewport& viewport = plan_->viewport;
    const Mat4d& m = object_->to_pixel;
    const ShapeTriangles shape = shape_;
    std::array<std::array<PacketOf<double>, 3>, 3> p; // [corner][axis]
    PacketOf<double> from_x, from_y;
    for (std::size_t i = 0; i < count; ++i) {
        const std::array<Vec3, 3> corners = shape.corners(index_of(i));
        for (std::size_t k = 0; k < 3; ++k) {
            p[k][0][i] = static_cast<double>(corners[k].x);
            p[k][1][i] = static_cast<double>(corners[k].y);
            p[k][2][i] = static_cast<double>(corners[k].z);
        }
        const Vec2d from = origin_of(i);
        from_x[i] = from.x, from_y[i] = from.y;
    }
    for (std::size_t i = 0; i < count; i += Doubles::size) {
        std::array<Doubles, 3> x, y, w, depth;
        for (std::size_t k = 0; k < 3; ++k) {
            const Doubles px = load(p[k][0], i), py = load(p[k][1], i), pz = load(p[k][2], i);
            const auto row = [&](std::size_t r) {
                return Doubles(m[r][0]) * px + Doubles(m[r][1]) * py + Doubles(m[r][2]) * pz + Doubles(m[r][3]);
            };
            depth[k] = row(2);
            w[k] = viewport.orthographic ? Doubles(1.0) : depth[k];
            x[k] = row(0) - load(from_x, i) * w[k];
            y[k] = row(1) - load(from_y, i) * w[k];
        }
        const TrianglePlanes<Doubles> all = triangle_planes(x, y, w, depth);
        const Doubles scale = Doubles(viewport.orthographic ? 1.0 : viewport.near) / abs(all.determinant);
        for (std::size_t c = 0; c < 3; ++c)
            store(planes.plane[c], i, (viewport.orthographic ? all.depth_sum[c] : all.sum[c]) * scale);
        store(planes.min_depth, i, min(min(depth[0], depth[1]), depth[2]));
    }
}

void Assembler::set_up_pending() {
    PlanePacket planes;
    for (std::size_t first = 0; first < pending_.size(); first += kPacketSize) {
        const std::span<const PendingTriangle> some =
            std::span(pending_).subspan(first, std::min(kPacketSize, pending_.size() - first));
        const auto triangle = [&](std::size_t i) -> DrawTriangle& { return batch_->triangles[some[i].number]; };
        const auto origin_of = [&](std::size_t i) {
            const Origin from = origin(triangle(i).corners, plan_->viewport);
            return Vec2d(from.x, from.y);
        };
        compute_planes(
            some.size(), [&](std::size_t i) { return some[i].index; }, origin_of, planes);
        for (std::size_t i = 0; i < some.size(); ++i)
            set_plane(triangle(i), {planes.plane[0][i], planes.plane[1][i], planes.plane[2][i]}, planes.min_depth[i],
                      false, plan_->viewport.near);
    }
}

void Assembler::compute_small_depths() {
    PlanePacket planes;
    for (std::size_t first = 0; first < small_triangles_.size(); first += kPacketSize) {
        const std::span<const SmallTriangle> some =
            std::span(small_triangles_).subspan(first, std::min(kPacketSize, small_triangles_.size() - first));
        const auto first_sample = [&](std::size_t i) { return min_offset_.position(some[i].x, some[i].y); };
        compute_planes(
            some.size(), [&](std::size_t i) { return some[i].index; }, first_sample, planes);
        for (std::size_t i = 0; i < some.size(); ++i) {
            const SmallTriangle& small = some[i];
            const DepthPlane plane{planes.plane[0][i], planes.plane[1][i], planes.plane[2][i]};
            constexpr int kFew = 2; // below this, fragments are cheaper than a mask
            const bool as_mask = plan_->coverage_masks && std::popcount(small.covered & small.well_inside) > kFew;
            if (as_mask) add_mask(small, plane);
            add_fragments(small, as_mask ? small.covered & ~small.well_inside : small.covered, plane);
        }
    }
}

void Assembler::add_mask(const SmallTriangle& small, const DepthPlane& plane) {
    const auto number = static_cast<std::uint32_t>(batch_->coverage_masks.size());
    const std::uint64_t samples = small.covered & small.well_inside;
    batch_->coverage_masks.push_back({.samples = samples,
                                      .depth_plane = plane,
                                      .id = run_.first_id + small.index - run_.first,
                                      .x = small.x,
                                      .y = small.y});
    std::uint64_t columns = samples | samples >> 32; // bitwise or of all rows
    columns |= columns >> 16;
    columns |= columns >> 8;
    const auto length = [](std::uint64_t bits) { return 64 - std::countl_zero(bits); };
    const int width = length(columns & 0xff), height = (length(samples) + kSmallSide - 1) / kSmallSide;
    plan_->grid.for_each({small.x, small.y, small.x + width, small.y + height}, [&](std::size_t tile) {
        mask_overlaps_.push_back({static_cast<std::uint32_t>(tile), number});
    });
}

/// Appends the covered samples of a small triangle as fragments. Samples well inside take their depth from the
/// plane; the others are interpolated one by one.
void Assembler::add_fragments(const SmallTriangle& small, std::uint64_t samples, const DepthPlane& plane) {
    if (samples == 0) return;
    constexpr std::uint32_t kSize = TileGrid::kTileSize;
    const std::uint32_t id = run_.first_id + small.index - run_.first;
    const auto left = static_cast<std::uint32_t>(small.x - plan_->grid.region.x0),
               top = static_cast<std::uint32_t>(small.y - plan_->grid.region.y0);
    const auto columns = static_cast<std::uint32_t>(plan_->grid.columns());
    std::optional<UnclippedTriangle> whole; // computed on first use
    for (std::uint64_t bits = samples; bits != 0; bits &= bits - 1) {
        const int bit = std::countr_zero(bits), across = bit % kSmallSide, down = bit / kSmallSide;
        double reversed_depth = (plane.constant + down * plane.y) + across * plane.x;
        if (plan_->viewport.orthographic) reversed_depth = plan_->viewport.near / reversed_depth;
        if (!(small.well_inside >> bit & 1)) {
            if (!whole) whole = shape_.unclipped(*object_, small.index);
            reversed_depth = interpolate(*whole, min_offset_.position(small.x + across, small.y + down))
                                 .reversed_depth(plan_->viewport.near);
        }
        const std::uint32_t column = left + static_cast<std::uint32_t>(across),
                            row = top + static_cast<std::uint32_t>(down);
        batch_->fragments.push_back(
            {.id = id,
             .reversed_depth = to_stored_depth(reversed_depth),
             .sample_index = static_cast<std::uint16_t>(tile_sample_index(column % kSize, row % kSize)),
             .tile = static_cast<std::uint16_t>(row / kSize * columns + column / kSize)});
    }
}

} // namespace duet::raster
