#include "raster/depth_tile.h"

#include <bit>

namespace duet::raster {

/// A triangle's edge functions at the samples of a tile. All samples of a tile have the same place in their pixel, so a
/// function's values differ by multiples of 256: divided by that and rounded down, their signs stay, and the steps from
/// pixel to pixel are a and b themselves. Within a block that an edge passes through they fit into 32 bits, whatever
/// the triangle's size: |a|, |b| < 2^25.2 (kGuardBand), so no sample of the block is as far as 14 · 2^25.2 < 2^30 from
/// one of the other sign.
struct DepthTile::Edges {
    std::array<std::int64_t, 3> at; ///< at the tile's first sample
    std::array<std::int64_t, 3> a, b;
    Origin origin; ///< of the triangle's plane
    std::int64_t margin;
    std::array<StripOf<std::int32_t>, 3> step; ///< from the first sample of a strip

    Edges(const DrawTriangle& triangle, const PixelRect& rect, SampleOffset offset, const Viewport& viewport)
        : origin(raster::origin(triangle.corners, viewport)), margin((inside_margin(triangle) + kSubPixels - 1) >> kSubPixelBits) {
        const auto& p = triangle.corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const EdgeFunction edge(p[k], p[(k + 1) % 3]);
            at[k] = edge.at(std::int64_t{rect.x0} * kSubPixels + offset.x, std::int64_t{rect.y0} * kSubPixels + offset.y) >>
                    kSubPixelBits;
            a[k] = edge.a;
            b[k] = edge.b;
            const Ints right(static_cast<std::int32_t>(a[k])), down(static_cast<std::int32_t>(b[k]));
            for (std::size_t i = 0; i < kStrip; i += Ints::size)
                store(step[k], i, right * load(kColumns<std::int32_t>, i) + down * load(kRows<std::int32_t>, i));
        }
    }

    enum class Cover { kNone, kSome, kAll };
    /// Of the block whose first sample is `x` pixels to the right of the tile's first and `y` below.
    Cover of_block(int x, int y) const {
        bool all = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int64_t first = at[k] + a[k] * x + b[k] * y;
            constexpr std::int64_t kLast = kBlock - 1, kZero = 0;
            if (first + kLast * (std::max(a[k], kZero) + std::max(b[k], kZero)) < 0) return Cover::kNone;
            all = all && first + kLast * (std::min(a[k], kZero) + std::min(b[k], kZero)) >= margin;
        }
        return all ? Cover::kAll : Cover::kSome;
    }
    /// An edge's value at a place, as far as it matters.
    std::int32_t clamped(std::size_t k, int x, int y) const {
        constexpr std::int64_t kFar = 1 << 30;
        return static_cast<std::int32_t>(std::clamp(at[k] + a[k] * x + b[k] * y, -kFar, kFar));
    }
};

void DepthTile::reset(const PixelRect& rect, SampleOffset offset, const Viewport& viewport) {
    rect_ = rect;
    offset_ = offset;
    viewport_ = viewport;
    nearness_.fill(0);
    ids_.fill(static_cast<std::int32_t>(kNoTriangle));
    farthest_.fill(0);
    partial_.fill(0);
    drawn_.fill(false);
}

void DepthTile::draw(const DrawTriangle& triangle, const WholeTriangles& whole) {
    const PixelRect r = intersect(rect_, pixels_within(triangle.corners, offset_));
    if (r.empty()) return;
    const Edges edges(triangle, rect_, offset_, viewport_);
    const bool large = r.width() > kBlock || r.height() > kBlock; // worth to ask for whole blocks
    for (int row = (r.y0 - rect_.y0) / kBlock; row <= (r.y1 - 1 - rect_.y0) / kBlock; ++row)
        for (int column = (r.x0 - rect_.x0) / kBlock; column <= (r.x1 - 1 - rect_.x0) / kBlock; ++column) {
            const auto block = static_cast<std::size_t>(row * kBlocks + column);
            if (triangle.nearest < farthest_[block]) continue;
            const Edges::Cover cover =
                large ? edges.of_block(column * kBlock, row * kBlock) : Edges::Cover::kSome;
            if (cover == Edges::Cover::kNone) continue;
            const bool all = cover == Edges::Cover::kAll && triangle.sound;
            drawn_[block] = true;
            const int top = rect_.y0 + row * kBlock;
            const std::uint64_t edge_samples = draw_block(edges, triangle, column, row, std::max(r.y0 - top, 0),
                                                          std::min(r.y1 - top, kBlock) - 1, all);
            if (edge_samples != 0) draw_edge_samples(triangle, whole, block, edge_samples);
            constexpr std::uint8_t kOften = 16;
            if (all || ++partial_[block] >= kOften) find_farthest(block);
        }
}

/// Nearness over strips.
struct DepthTile::Nearness {
    const NearnessPlane& plane;
    const Viewport& viewport;
    Doubles slope = Doubles(plane.x);

    /// Of the samples from the i-th of a strip on, whose first lies at (x, y) from the plane's origin.
    Floats at(double x, double y, std::size_t i) const {
        const auto half = [&](std::size_t first) {
            const double start = plane.constant + (y + kRows<double>[first]) * plane.y;
            const Doubles value = Doubles(start) + (Doubles(x) + raster::load(kColumns<double>, first)) * slope;
            return viewport.orthographic ? Doubles(viewport.near) / value : value;
        };
        const Floats nearness = narrowed(half(i), half(i + Doubles::size));
        return sabotaged(Guard::kReversedDepth) ? Floats(1.0f) - (Floats(1.0f) - nearness) : nearness;
    }
};

/// Draws those samples of a block that are covered for certain and lie well inside; `all` of them do, or the edges say
/// which. Returns the other covered ones, a bit each. Only the strips of rows y0 to y1 of the block are looked at.
std::uint64_t DepthTile::draw_block(const Edges& edges, const DrawTriangle& triangle, int column, int row, int y0,
                                    int y1, bool all) {
    const auto id = static_cast<std::int32_t>(triangle.id);
    const auto block = static_cast<std::size_t>(row * kBlocks + column);
    const Ints zero(0), margin(static_cast<std::int32_t>(triangle.sound ? edges.margin : std::int64_t{0x7fffffff}));
    const Nearness nearness{triangle.nearness, viewport_};
    const int x = column * kBlock;
    const double from_x = rect_.x0 + x - edges.origin.x + static_cast<double>(offset_.x) / kSubPixels;
    const double from_y = rect_.y0 - edges.origin.y + static_cast<double>(offset_.y) / kSubPixels;
    std::uint64_t edge_samples = 0;
    for (int strip = y0 / kStripRows; strip <= y1 / kStripRows; ++strip) {
        const int y = row * kBlock + strip * kStripRows;
        const auto first = static_cast<std::size_t>(strip) * kStrip;
        const std::array<Ints, 3> value{Ints(edges.clamped(0, x, y)), Ints(edges.clamped(1, x, y)),
                                        Ints(edges.clamped(2, x, y))};
        for (std::size_t i = 0; i < kStrip; i += Ints::size) {
            xsimd::batch_bool<float> inside(true);
            if (!all) {
                const Ints e0 = value[0] + load(edges.step[0], i), e1 = value[1] + load(edges.step[1], i),
                           e2 = value[2] + load(edges.step[2], i);
                const Ints least = min(min(e0, e1), e2);
                const auto covered = least >= zero, well_inside = least >= margin;
                if (!xsimd::any(covered)) continue;
                const auto at_edge = covered && !well_inside;
                edge_samples |= std::uint64_t{lane_bits(at_edge)} << (first + i);
                inside = xsimd::bool_cast(well_inside);
            }
            const std::size_t place = block * kBlock * kBlock + first + i;
            const Floats before = Floats::load_aligned(&nearness_[place]), here = nearness.at(from_x, from_y + y, i);
            const Ints id_before = Ints::load_aligned(&ids_[place]);
            auto wins = here > before;
            if (!sabotaged(Guard::kDrawOrder))
                wins = wins || (here == before && xsimd::bool_cast(Ints(id) < id_before));
            wins = wins && inside;
            xsimd::select(wins, here, before).store_aligned(&nearness_[place]);
            xsimd::select(xsimd::bool_cast(wins), Ints(id), id_before).store_aligned(&ids_[place]);
        }
    }
    return edge_samples;
}

void DepthTile::draw_edge_samples(const DrawTriangle& triangle, const WholeTriangles& whole, std::size_t block,
                                  std::uint64_t samples) {
    const WholeTriangle all = whole.whole(triangle.id);
    const Interpolation at = interpolation(all, triangle.corners, viewport_);
    const int x0 = rect_.x0 + static_cast<int>(block % kBlocks) * kBlock,
              y0 = rect_.y0 + static_cast<int>(block / kBlocks) * kBlock;
    for (; samples != 0; samples &= samples - 1) {
        const int bit = std::countr_zero(samples), x = x0 + bit % kBlock, y = y0 + bit / kBlock;
        const Interpolated here = at.at(offset_.position(x, y), all.piece);
        keep_nearest(static_cast<std::uint32_t>(block * kBlock * kBlock) + static_cast<std::uint32_t>(bit), triangle.id,
                     kept_nearness(here.nearness(viewport_.near)));
    }
}

void DepthTile::draw(std::span<const Fragment> fragments) {
    for (const Fragment& f : fragments) keep_nearest(f.place, f.id, f.nearness);
}

void DepthTile::keep_nearest(std::size_t place, std::uint32_t id, float nearness) {
    const auto number = static_cast<std::int32_t>(id);
    const bool tie_won = nearness == nearness_[place] && number < ids_[place] && !sabotaged(Guard::kDrawOrder);
    drawn_[place / (kBlock * kBlock)] = true;
    if (!(nearness > nearness_[place] || tie_won)) return;
    nearness_[place] = nearness;
    ids_[place] = number;
}

void DepthTile::find_farthest(std::size_t block) {
    Floats least(1.0f);
    for (std::size_t i = 0; i < kBlock * kBlock; i += Floats::size)
        least = min(least, Floats::load_aligned(&nearness_[block * kBlock * kBlock + i]));
    alignas(64) std::array<float, Floats::size> lanes;
    least.store_aligned(lanes.data());
    farthest_[block] = *std::min_element(lanes.begin(), lanes.end());
    partial_[block] = 0;
}

} // namespace duet::raster
