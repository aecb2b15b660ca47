#include "raster/visibility/depth_tile.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace duet::raster {

/// A triangle's edge functions at the samples of a tile. All samples of a tile have the same place in their pixel, so a
/// function's values differ by multiples of 256: divided by that and rounded down, their signs stay, and the steps from
/// pixel to pixel are a and b themselves. Within a block that an edge passes through they fit into 32 bits, whatever the
/// triangle's size: |a|, |b| < 2^25.2 (kGuardBand), so no sample of the block is as far as 14 · 2^25.2 < 2^30 from one of the
/// other sign.
struct DepthTile::Edges {
    using Values = std::array<std::int64_t, 3>;
    Values at; ///< at the tile's first sample
    Values right, down; ///< from block to block
    /// At a block's first sample, as floats have it: none of its samples is inside below the one, all are well inside from the other
    /// on. By an error more than floats have: each of six roundings is of at most half a unit in the last place of what a function
    /// may be in the tile. So a block may be looked at for nothing, but none is missed.
    std::array<float, 3> none, all;
    std::array<std::int32_t, 3> margin; ///< edge_margins
    std::array<StripOf<std::int32_t>, 3> step; ///< from the first sample of a strip
    std::array<std::int32_t, 3> next_strip;    ///< from a strip to the one below

    Edges(const DrawTriangle& triangle, const PixelRect& rect, SampleOffset offset) {
        const auto& p = triangle.corners;
        const Values margins = edge_margins(triangle);
        constexpr std::int64_t kNever = 0x7fffffff, kLast = kBlock - 1, kZero = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const EdgeFunction edge(p[k], p[(k + 1) % 3]);
            at[k] = edge.at(std::int64_t{rect.x0} * kSubPixels + offset.x, std::int64_t{rect.y0} * kSubPixels + offset.y) >> kSubPixelBits;
            right[k] = edge.a * kBlock;
            down[k] = edge.b * kBlock;
            const std::int64_t well = triangle.sound ? (margins[k] + kSubPixels - 1) >> kSubPixelBits : kNever;
            const std::int64_t most = std::abs(at[k]) + TileGrid::kTileSize * (std::abs(edge.a) + std::abs(edge.b)) + well;
            const float error = static_cast<float>(most) * 0x1p-20f;
            none[k] = static_cast<float>(-kLast * (std::max(edge.a, kZero) + std::max(edge.b, kZero))) - error;
            all[k] = static_cast<float>(well - kLast * (std::min(edge.a, kZero) + std::min(edge.b, kZero))) + error;
            margin[k] = static_cast<std::int32_t>(well);
            next_strip[k] = static_cast<std::int32_t>(edge.b * kStripRows);
            const Ints a(static_cast<std::int32_t>(edge.a)), b(static_cast<std::int32_t>(edge.b));
            for (std::size_t i = 0; i < kStrip; i += Ints::size)
                store(step[k], i, a * load(kColumns<std::int32_t>, i) + b * load(kRows<std::int32_t>, i));
        }
    }
    /// At a block's first sample, as far as it matters: exact where the block's edge passes through.
    std::array<std::int32_t, 3> at_block(int column, int row) const {
        constexpr std::int64_t kFar = 1 << 30;
        std::array<std::int32_t, 3> here;
        for (std::size_t k = 0; k < 3; ++k)
            here[k] = static_cast<std::int32_t>(std::clamp(at[k] + right[k] * column + down[k] * row, -kFar, kFar));
        return here;
    }
};

/// A row of blocks of a tile, all of them side by side.
struct DepthTile::BlockRow {
    std::uint32_t some = 0, all = 0; ///< a bit for each block of which the triangle may cover some samples; all for certain, well inside

    BlockRow(const Edges& edges, int row) {
        for (std::size_t i = 0; i < kBlocks; i += Floats::size) {
            const Floats column = Floats::load_aligned(kLanesAsFloats.at(i));
            auto some_inside = column >= Floats(0.0f), all_inside = some_inside;
            for (std::size_t k = 0; k < 3; ++k) {
                const Floats here = fused(Floats(static_cast<float>(edges.right[k])), column,
                                          Floats(static_cast<float>(edges.at[k] + edges.down[k] * row)));
                some_inside = some_inside && here >= Floats(edges.none[k]);
                all_inside = all_inside && here >= Floats(edges.all[k]);
            }
            some |= lane_bits(some_inside) << i;
            all |= lane_bits(all_inside) << i;
        }
    }
};

/// A triangle's samples in a block, a bit each: all, and those that lie well inside.
struct DepthTile::Covered {
    std::uint64_t some = ~std::uint64_t{0}, well_inside = some;

    Covered() = default; ///< all of them
    bool all_well_inside() const { return well_inside == ~std::uint64_t{0}; }
    /// By the edges' values at the block's first sample; in the strips of its rows y0 to y1, the others have none.
    Covered(const Edges& edges, const std::array<std::int32_t, 3>& at, int y0, int y1) : some(0), well_inside(0) {
        const Ints zero(0);
        for (int strip = y0 / kStripRows; strip <= y1 / kStripRows; ++strip)
            for (std::size_t i = 0; i < kStrip; i += Ints::size) {
                const auto value = [&](std::size_t k) { return Ints(at[k] + strip * edges.next_strip[k]) + load(edges.step[k], i); };
                const Ints e0 = value(0), e1 = value(1), e2 = value(2);
                const auto inside = e0 >= Ints(edges.margin[0]) && e1 >= Ints(edges.margin[1]) && e2 >= Ints(edges.margin[2]);
                const std::size_t first = static_cast<std::size_t>(strip) * kStrip + i;
                some |= std::uint64_t{lane_bits(min(min(e0, e1), e2) >= zero)} << first;
                well_inside |= std::uint64_t{lane_bits(inside)} << first;
            }
    }
};

void DepthTile::reset(const PixelRect& rect, SampleOffset offset, const Viewport& viewport) {
    rect_ = rect;
    offset_ = offset;
    viewport_ = viewport;
    farthest_.fill(0);
    partial_.fill(0);
    drawn_.fill(false);
}

void DepthTile::empty(std::size_t block) {
    std::fill_n(nearness_.begin() + static_cast<std::ptrdiff_t>(block * kBlockSamples), kBlockSamples, 0.0f);
    std::fill_n(ids_.begin() + static_cast<std::ptrdiff_t>(block * kBlockSamples), kBlockSamples,
                static_cast<std::int32_t>(kNoTriangle));
    constexpr std::size_t kStrips = kBlockSamples / kStrip;
    std::fill_n(inside_.begin() + static_cast<std::ptrdiff_t>(block * kStrips), kStrips, std::uint16_t{0});
}

void DepthTile::empty_undrawn() {
    for (std::size_t block = 0; block < drawn_.size(); ++block)
        if (!drawn_[block]) empty(block);
}

/// A bit for each block of a row whose farthest sample is farther than `nearest`, or as far.
std::uint32_t DepthTile::not_hidden(int row, float nearest) const {
    std::uint32_t hidden = 0;
    for (std::size_t i = 0; i < kBlocks; i += Floats::size)
        hidden |= lane_bits(Floats(nearest) < Floats::load_aligned(&farthest_[static_cast<std::size_t>(row) * kBlocks + i])) << i;
    return ~hidden;
}

/// Nearness over so many blocks along a side, or its inverse in an orthographic view: the sum of what a sample's column and its row
/// have of it.
template <std::size_t kSide> struct DepthTile::Nearness {
    const Viewport& viewport;
    alignas(64) std::array<double, kSide * kBlock> columns, rows;

    /// The first block's first sample lies at (x, y) from the plane's origin.
    Nearness(const NearnessPlane& plane, const Viewport& viewport_, double x, double y) : viewport(viewport_) {
        for (std::size_t i = 0; i < columns.size(); i += Doubles::size) {
            const Doubles number = Doubles(static_cast<double>(i / kBlock * kBlock)) + load(kColumns<double>, i % kBlock);
            ((Doubles(x) + number) * Doubles(plane.x)).store_aligned(&columns[i]);
            (Doubles(plane.constant) + (Doubles(y) + number) * Doubles(plane.y)).store_aligned(&rows[i]);
        }
    }
    /// Of a block's samples from the i-th on.
    Floats at(std::size_t block, std::size_t i) const {
        const auto half = [&](std::size_t first) {
            const Doubles value = Doubles(rows[block / kSide * kBlock + first / kBlock]) +
                                  Doubles::load_aligned(&columns[block % kSide * kBlock + first % kBlock]);
            return viewport.orthographic ? Doubles(viewport.near) / value : value;
        };
        const Floats nearness = narrowed(half(i), half(i + Doubles::size));
        return sabotaged(Guard::kReversedDepth) ? Floats(1.0f) - (Floats(1.0f) - nearness) : nearness;
    }
};

/// The samples from a place on, as many as there are lanes, of which those given show a triangle, well inside it.
template <typename Lanes>
void DepthTile::keep_nearest(std::size_t place, std::int32_t number, const Floats& nearness, const Lanes& lanes) {
    const Ints id(number), id_before = Ints::load_aligned(&ids_[place]);
    const Floats before = Floats::load_aligned(&nearness_[place]);
    // Floats that are not negative compare as their bits do. A lower number wins if it is nearer than the float before, which is to
    // be at least as near. (Of two conditions joined by «or» the second would wait for the first.)
    const Ints bits = xsimd::bitwise_cast<Ints>(nearness);
    Ints to_beat = xsimd::bitwise_cast<Ints>(before);
    if (!sabotaged(Guard::kDrawOrder)) to_beat = xsimd::select(id < id_before, to_beat - Ints(1), to_beat);
    const auto wins = xsimd::bool_cast(xsimd::select(xsimd::bool_cast(lanes), bits, Ints(-1)) > to_beat);
    xsimd::select(wins, nearness, before).store_aligned(&nearness_[place]);
    xsimd::select(xsimd::bool_cast(wins), id, id_before).store_aligned(&ids_[place]);
    inside_[place / kStrip] |= static_cast<std::uint16_t>(lane_bits(wins) << place % kStrip);
}

/// Draws those samples of a block that lie in its strip from `first` on; nearness_at(i): of the samples from the i-th on. (In line, as
/// draw_block(): calls take a tenth of a frame.)
template <typename NearnessAt>
[[gnu::always_inline]] inline void DepthTile::draw_strip(std::size_t block, std::size_t first, std::uint64_t samples, std::uint32_t id,
                                                         const NearnessAt& nearness_at) {
    for (std::size_t i = first; i < first + kStrip; i += Floats::size) {
        const auto here = static_cast<std::uint32_t>(samples >> i) & ((1u << Floats::size) - 1);
        keep_nearest(block * kBlockSamples + i, static_cast<std::int32_t>(id), nearness_at(i), lanes_from<float>(here));
    }
}

void DepthTile::draw(const DrawTriangle& triangle, const WholeTriangles& whole) {
    const PixelRect r = intersect(rect_, pixels_within(triangle.corners, offset_));
    if (r.empty()) return;
    const Edges edges(triangle, rect_, offset_);
    const int first_column = (r.x0 - rect_.x0) / kBlock, last_column = (r.x1 - 1 - rect_.x0) / kBlock;
    const std::uint32_t touched = (2u << last_column) - (1u << first_column);
    const Origin from = origin(triangle.corners, viewport_);
    const Vec2d first = offset_.position(rect_.x0 - from.x, rect_.y0 - from.y); // the tile's first sample, from the plane's origin
    for (int row = (r.y0 - rect_.y0) / kBlock; row <= (r.y1 - 1 - rect_.y0) / kBlock; ++row) {
        const BlockRow blocks(edges, row);
        const int top = rect_.y0 + row * kBlock;
        const int y0 = std::max(r.y0 - top, 0), y1 = std::min(r.y1 - top, kBlock) - 1;
        for (std::uint32_t left = blocks.some & touched & not_hidden(row, triangle.nearest); left != 0; left &= left - 1) {
            const int column = std::countr_zero(left);
            const bool all = (blocks.all >> column & 1) && triangle.sound;
            const Covered covered = all ? Covered() : Covered(edges, edges.at_block(column, row), y0, y1);
            if (covered.some != 0)
                draw_block(triangle, whole, static_cast<std::size_t>(row * kBlocks + column), covered,
                           first + Vec2d(column, row) * double{kBlock});
        }
    }
}

/// Those samples of a block, whose first lies there from the plane's origin.
[[gnu::always_inline]] inline void DepthTile::draw_block(const DrawTriangle& triangle, const WholeTriangles& whole, std::size_t block,
                                                         const Covered& covered, Vec2d first) {
    open(block);
    const Nearness<1> nearness(triangle.nearness, viewport_, first.x, first.y);
    for (std::size_t strip = 0; strip < kBlockSamples; strip += kStrip) // all: no machine guesses which of them it covers
        draw_strip(block, strip, covered.well_inside, triangle.id, [&](std::size_t i) { return nearness.at(0, i); });
    if (covered.some != covered.well_inside) draw_edge_samples(triangle, whole, block, covered.some & ~covered.well_inside);
    constexpr std::uint8_t kOften = 16;
    if (covered.all_well_inside() || ++partial_[block] >= kOften) find_farthest(block);
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
        keep_one(block * kBlockSamples + static_cast<std::size_t>(bit), triangle.id, kept_nearness(here.nearness(viewport_.near)), false);
    }
}

namespace {

/// A box of 8 × 8 samples lies over up to four blocks, two of them below the others: its samples in each, if its first is `left` to the
/// right and `top` below of the first block's.
std::array<std::uint64_t, 4> over_blocks(std::uint64_t samples, int left, int top) {
    constexpr std::uint64_t kFirstColumn = 0x0101010101010101;
    const std::uint64_t in_left = (samples & kFirstColumn * (0xffu >> left)) << left,
                        in_right = samples >> (8 - left) & kFirstColumn * (0xffu >> (8 - left));
    const auto above = [&](std::uint64_t bits) { return bits << 8 * top; };
    const auto below = [&](std::uint64_t bits) { return bits >> 8 >> (56 - 8 * top); };
    return {above(in_left), above(in_right), below(in_left), below(in_right)};
}

/// A bit for each strip of the blocks that has one of the samples.
std::uint32_t strips_of(const std::array<std::uint64_t, 4>& samples) {
    std::uint32_t strips = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        constexpr std::uint64_t kAllButLast = 0x7fff7fff7fff7fff;
        const std::uint64_t any = (((samples[k] & kAllButLast) + kAllButLast) | samples[k]) & ~kAllButLast;
        strips |= static_cast<std::uint32_t>((any >> 15) * 0x0001000200040008 >> 48 & 0xf) << 4 * k; // bits 15, 31, 47, 63 to four in a row
    }
    return strips;
}

} // namespace

// Strips one after the other, whichever block they are of: so how many there are is all that a machine may guess wrong.
void DepthTile::draw(const Patch& patch) {
    const int x = patch.x - rect_.x0, y = patch.y - rect_.y0, left = x & 7, top = y & 7;
    const int column = x >> 3, row = y >> 3; // of the first block: maybe just before the tile's
    const std::array<std::uint64_t, 4> samples = over_blocks(patch.samples, left, top);
    const std::uint32_t in_tile = ((column >= 0 ? 0x0f0fu : 0) | (column + 1 < kBlocks ? 0xf0f0u : 0)) &
                                  ((row >= 0 ? 0x00ffu : 0) | (row + 1 < kBlocks ? 0xff00u : 0));
    const Nearness<2> nearness(patch.nearness, viewport_, -left, -top);
    for (std::uint32_t strips = strips_of(samples) & in_tile; strips != 0; strips &= strips - 1) {
        const auto strip = static_cast<std::size_t>(std::countr_zero(strips)), part = strip / 4;
        const auto block = static_cast<std::size_t>((row + static_cast<int>(part / 2)) * kBlocks + column + static_cast<int>(part % 2));
        open(block);
        draw_strip(block, strip % 4 * kStrip, samples[part], patch.id, [&](std::size_t i) { return nearness.at(part, i); });
    }
}

void DepthTile::draw(std::span<const Fragment> fragments) {
    for (const Fragment& f : fragments) keep_one(f.place, f.id, f.nearness, f.inside);
}

void DepthTile::keep_one(std::size_t place, std::uint32_t id, float nearness, bool inside) {
    open(place / kBlockSamples);
    const auto number = static_cast<std::int32_t>(id);
    const bool tie_won = nearness == nearness_[place] && number < ids_[place] && !sabotaged(Guard::kDrawOrder);
    if (!(nearness > nearness_[place] || tie_won)) return;
    nearness_[place] = nearness;
    ids_[place] = number;
    const auto bit = static_cast<std::uint16_t>(1u << place % kStrip);
    std::uint16_t& strip = inside_[place / kStrip];
    strip = static_cast<std::uint16_t>(inside ? strip | bit : strip & ~bit);
}

void DepthTile::find_farthest(std::size_t block) {
    Floats least(1.0f);
    for (std::size_t i = 0; i < kBlock * kBlock; i += Floats::size)
        least = min(least, Floats::load_aligned(&nearness_[block * kBlock * kBlock + i]));
    farthest_[block] = lowest(least);
    partial_[block] = 0;
}

} // namespace duet::raster
