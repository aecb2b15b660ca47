#include "raster/visibility/depth_tile.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace duet::raster {

/// Holds the edge functions of a triangle at the samples of a tile. All samples of a tile have the same offset in
/// their pixel, so the values of an edge function differ by multiples of 256. After division by 256, rounded down,
/// the signs are unchanged, and the increments from pixel to pixel are a and b themselves. Within a block that an
/// edge passes through, the values fit into 32 bits for triangles of any size: |a|, |b| < 2^25.2 (kGuardBand), so no
/// sample of the block is farther than 14 · 2^25.2 < 2^30 from a sample of the other sign.
struct DepthTile::TileEdges {
    using Values = std::array<std::int64_t, 3>;
    Values at; ///< edge values at the tile's first sample
    Values right, down; ///< increments from block to block
    /// These are thresholds for the value at a block's first sample. Below `none`, no sample of the block is inside.
    /// From `all` on, all samples are well inside. Both have a margin for float rounding. Each of seven roundings (six
    /// with fused multiply-add) has an error of at most half a unit in the last place of the largest value in the tile,
    /// and the margin has room for sixteen. So a block may be tested unnecessarily, but none is missed.
    std::array<float, 3> none, all;
    std::array<std::int32_t, 3> margin; ///< result of edge_margins()
    std::array<PacketOf<std::int32_t>, 3> step; ///< increments from the first sample of a packet to each sample
    std::array<std::int32_t, 3> next_packet;    ///< increments from a packet to the packet below

    TileEdges(const DrawTriangle& triangle, const PixelRect& rect, SampleOffset offset) {
        const auto& p = triangle.corners;
        const Values margins = edge_margins(triangle);
        constexpr std::int64_t kNever = 0x7fffffff, kLast = kBlock - 1, kZero = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const EdgeFunction edge(p[k], p[(k + 1) % 3]);
            at[k] =
                edge.at(std::int64_t{rect.x0} * kSubpixels + offset.x, std::int64_t{rect.y0} * kSubpixels + offset.y) >>
                kSubpixelBits;
            right[k] = edge.a * kBlock;
            down[k] = edge.b * kBlock;
            const std::int64_t well = triangle.plane_reliable ? (margins[k] + kSubpixels - 1) >> kSubpixelBits : kNever;
            const std::int64_t most =
                std::abs(at[k]) + TileGrid::kTileSize * (std::abs(edge.a) + std::abs(edge.b)) + well;
            const float error = static_cast<float>(most) * 0x1p-20f;
            none[k] = static_cast<float>(-kLast * (std::max(edge.a, kZero) + std::max(edge.b, kZero))) - error;
            all[k] = static_cast<float>(well - kLast * (std::min(edge.a, kZero) + std::min(edge.b, kZero))) + error;
            margin[k] = static_cast<std::int32_t>(well);
            next_packet[k] = static_cast<std::int32_t>(edge.b * kPacketRows);
            const Ints a(static_cast<std::int32_t>(edge.a)), b(static_cast<std::int32_t>(edge.b));
            for (std::size_t i = 0; i < kPacketSize; i += Ints::size)
                store(step[k], i, a * load(kColumns<std::int32_t>, i) + b * load(kRows<std::int32_t>, i));
        }
    }
    /// Returns the values at a block's first sample, clamped to ±2^30. They are exact where an edge passes through
    /// the block.
    std::array<std::int32_t, 3> at_block(int column, int row) const {
        constexpr std::int64_t kFar = 1 << 30;
        std::array<std::int32_t, 3> here;
        for (std::size_t k = 0; k < 3; ++k)
            here[k] = static_cast<std::int32_t>(std::clamp(at[k] + right[k] * column + down[k] * row, -kFar, kFar));
        return here;
    }
};

/// Computes the coverage of a row of blocks of a tile with SIMD.
struct DepthTile::BlockRow {
    /// `some` has a bit for each block in which the triangle may cover samples. `all` has a bit for each block whose
    /// samples it certainly covers, well inside.
    std::uint32_t some = 0, all = 0;

    BlockRow(const TileEdges& edges, int row) {
        for (std::size_t i = 0; i < kBlocks; i += Floats::size) {
            const Floats column = Floats::load_aligned(kLanesAsFloats.at(i));
            auto some_inside = column >= Floats(0.0f), all_inside = some_inside;
            for (std::size_t k = 0; k < 3; ++k) {
                const Floats here = multiply_add(Floats(static_cast<float>(edges.right[k])), column,
                                                 Floats(static_cast<float>(edges.at[k] + edges.down[k] * row)));
                some_inside = some_inside && here >= Floats(edges.none[k]);
                all_inside = all_inside && here >= Floats(edges.all[k]);
            }
            some |= lane_bits(some_inside) << i;
            all |= lane_bits(all_inside) << i;
        }
    }
};

/// Holds the coverage of a block, one bit per sample: all covered samples, and those well inside.
struct DepthTile::BlockCoverage {
    std::uint64_t some = ~std::uint64_t{0}, well_inside = some;

    BlockCoverage() = default; ///< covers all samples
    bool all_well_inside() const { return well_inside == ~std::uint64_t{0}; }
    /// Computes the coverage from the edge values at the block's first sample, for the packets of rows y0 to y1.
    /// The other packets stay empty.
    BlockCoverage(const TileEdges& edges, const std::array<std::int32_t, 3>& at, int y0, int y1)
        : some(0), well_inside(0) {
        const Ints zero(0);
        for (int packet = y0 / kPacketRows; packet <= y1 / kPacketRows; ++packet)
            for (std::size_t i = 0; i < kPacketSize; i += Ints::size) {
                const auto value = [&](std::size_t k) {
                    return Ints(at[k] + packet * edges.next_packet[k]) + load(edges.step[k], i);
                };
                const Ints e0 = value(0), e1 = value(1), e2 = value(2);
                const auto inside =
                    e0 >= Ints(edges.margin[0]) && e1 >= Ints(edges.margin[1]) && e2 >= Ints(edges.margin[2]);
                const std::size_t first = static_cast<std::size_t>(packet) * kPacketSize + i;
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
    draws_since_farthest_.fill(0);
    drawn_.fill(false);
}

void DepthTile::clear_block(std::size_t block) {
    std::fill_n(reversed_depth_.begin() + static_cast<std::ptrdiff_t>(block * kBlockSamples), kBlockSamples, 0.0f);
    std::fill_n(ids_.begin() + static_cast<std::ptrdiff_t>(block * kBlockSamples), kBlockSamples,
                static_cast<std::int32_t>(kNoTriangle));
}

void DepthTile::clear_undrawn() {
    for (std::size_t block = 0; block < drawn_.size(); ++block)
        if (!drawn_[block]) clear_block(block);
}

/// Returns one bit per block of a row whose farthest sample is not nearer than `nearest`.
std::uint32_t DepthTile::unoccluded_blocks(int row, float nearest) const {
    std::uint32_t hidden = 0;
    for (std::size_t i = 0; i < kBlocks; i += Floats::size)
        hidden |=
            lane_bits(Floats(nearest) < Floats::load_aligned(&farthest_[static_cast<std::size_t>(row) * kBlocks + i]))
            << i;
    return ~hidden;
}

/// Evaluates the reversed depth over kSide × kSide blocks; in an orthographic view the plane is its inverse. The
/// value of a sample is the sum of a column term and a row term.
template <std::size_t kSide> struct DepthTile::DepthEvaluator {
    const Viewport& viewport;
    alignas(64) std::array<double, kSide * kBlock> columns, rows;

    /// (x, y) is the position of the first block's first sample relative to the plane's origin.
    DepthEvaluator(const DepthPlane& plane, const Viewport& viewport_, double x, double y) : viewport(viewport_) {
        for (std::size_t i = 0; i < columns.size(); i += Doubles::size) {
            const Doubles number =
                Doubles(static_cast<double>(i / kBlock * kBlock)) + load(kColumns<double>, i % kBlock);
            ((Doubles(x) + number) * Doubles(plane.x)).store_aligned(&columns[i]);
            (Doubles(plane.constant) + (Doubles(y) + number) * Doubles(plane.y)).store_aligned(&rows[i]);
        }
    }
    /// Returns the values of a block's samples from the i-th on.
    Floats at(std::size_t block, std::size_t i) const {
        const auto half = [&](std::size_t first) {
            const Doubles value = Doubles(rows[block / kSide * kBlock + first / kBlock]) +
                                  Doubles::load_aligned(&columns[block % kSide * kBlock + first % kBlock]);
            return viewport.orthographic ? Doubles(viewport.near) / value : value;
        };
        const Floats reversed_depth = narrowed(half(i), half(i + Doubles::size));
        return reversed_depth;
    }
};

/// Depth-tests one batch of samples from `sample_index` on against a triangle. `lanes` selects the samples that the
/// triangle covers, well inside.
template <typename Lanes>
void DepthTile::depth_test_batch(std::size_t sample_index, std::int32_t number, const Floats& reversed_depth,
                                 const Lanes& lanes) {
    const Ints id(number), id_before = Ints::load_aligned(&ids_[sample_index]);
    const Floats before = Floats::load_aligned(&reversed_depth_[sample_index]);
    // Nonnegative floats compare like their bits. A lower id wins a tie, so it is compared with the predecessor of
    // the stored float. (Two comparisons joined by "or" would form a longer dependency chain.)
    const Ints bits = xsimd::bitwise_cast<Ints>(reversed_depth);
    Ints to_beat = xsimd::bitwise_cast<Ints>(before);
    to_beat = xsimd::select(id < id_before, to_beat - Ints(1), to_beat);
    const auto wins = xsimd::bool_cast(xsimd::select(xsimd::bool_cast(lanes), bits, Ints(-1)) > to_beat);
    xsimd::select(wins, reversed_depth, before).store_aligned(&reversed_depth_[sample_index]);
    xsimd::select(xsimd::bool_cast(wins), id, id_before).store_aligned(&ids_[sample_index]);
}

/// Draws the samples of one packet of a block, from `first` on. depth_at(i) returns the reversed depths of the
/// samples from the i-th on. (It is inlined like draw_block(), because calls would cost a tenth of the frame time.)
template <typename DepthAt>
[[gnu::always_inline]] inline void DepthTile::draw_packet(std::size_t block, std::size_t first, std::uint64_t samples,
                                                          std::uint32_t id, const DepthAt& depth_at) {
    for (std::size_t i = first; i < first + kPacketSize; i += Floats::size) {
        const auto here = static_cast<std::uint32_t>(samples >> i) & ((1u << Floats::size) - 1);
        depth_test_batch(block * kBlockSamples + i, static_cast<std::int32_t>(id), depth_at(i),
                         lanes_from<float>(here));
    }
}

void DepthTile::draw(const DrawTriangle& triangle, const UnclippedTriangles& whole) {
    const PixelRect r = intersect(rect_, pixels_within(triangle.corners, offset_));
    if (r.empty()) return;
    const TileEdges edges(triangle, rect_, offset_);
    const int first_column = (r.x0 - rect_.x0) / kBlock, last_column = (r.x1 - 1 - rect_.x0) / kBlock;
    const std::uint32_t touched = (2u << last_column) - (1u << first_column);
    const Origin from = origin(triangle.corners, viewport_);
    // This is the tile's first sample, relative to the plane's origin.
    const Vec2d first = offset_.position(rect_.x0 - from.x, rect_.y0 - from.y);
    for (int row = (r.y0 - rect_.y0) / kBlock; row <= (r.y1 - 1 - rect_.y0) / kBlock; ++row) {
        const BlockRow blocks(edges, row);
        const int top = rect_.y0 + row * kBlock;
        const int y0 = std::max(r.y0 - top, 0), y1 = std::min(r.y1 - top, kBlock) - 1;
        for (const std::size_t block : SetBits(blocks.some & touched & unoccluded_blocks(row, triangle.nearest))) {
            const auto column = static_cast<int>(block);
            const bool all = (blocks.all >> column & 1) && triangle.plane_reliable;
            const BlockCoverage covered =
                all ? BlockCoverage() : BlockCoverage(edges, edges.at_block(column, row), y0, y1);
            if (covered.some != 0)
                draw_block(triangle, whole, static_cast<std::size_t>(row * kBlocks + column), covered,
                           first + Vec2d(column, row) * double{kBlock});
        }
    }
}

/// Draws the covered samples of a block. `first` is its first sample, relative to the plane's origin.
[[gnu::always_inline]] inline void DepthTile::draw_block(const DrawTriangle& triangle, const UnclippedTriangles& whole,
                                                         std::size_t block, const BlockCoverage& covered, Vec2d first) {
    begin_block(block);
    const DepthEvaluator<1> reversed_depth(triangle.depth_plane, viewport_, first.x, first.y);
    // Process all packets, because a branch on their coverage would be mispredicted.
    for (std::size_t packet = 0; packet < kBlockSamples; packet += kPacketSize)
        draw_packet(block, packet, covered.well_inside, triangle.id,
                    [&](std::size_t i) { return reversed_depth.at(0, i); });
    if (covered.some != covered.well_inside)
        draw_edge_samples(triangle, whole, block, covered.some & ~covered.well_inside);
    constexpr std::uint8_t kOften = 16; // draws after which the bound is worth its computation
    if (covered.all_well_inside() || ++draws_since_farthest_[block] >= kOften) update_farthest(block);
}

void DepthTile::draw_edge_samples(const DrawTriangle& triangle, const UnclippedTriangles& whole, std::size_t block,
                                  std::uint64_t samples) {
    const UnclippedTriangle all = whole.unclipped(triangle.id);
    const Interpolation at = interpolation(all, triangle.corners, viewport_);
    const int x0 = rect_.x0 + static_cast<int>(block % kBlocks) * kBlock,
              y0 = rect_.y0 + static_cast<int>(block / kBlocks) * kBlock;
    for (; samples != 0; samples &= samples - 1) {
        const int bit = std::countr_zero(samples), x = x0 + bit % kBlock, y = y0 + bit / kBlock;
        const Interpolated here = at.at(offset_.position(x, y), all.triangle_kind);
        depth_test_sample(block * kBlockSamples + static_cast<std::size_t>(bit), triangle.id,
                          to_stored_depth(here.reversed_depth(viewport_.near)));
    }
}

namespace {

/// Splits a box of 8 × 8 samples, which overlaps up to 2 × 2 blocks, into its samples in each block. The box's
/// first sample is `left` samples to the right of and `top` samples below the first block's.
std::array<std::uint64_t, 4> split_over_blocks(std::uint64_t samples, int left, int top) {
    constexpr std::uint64_t kFirstColumn = 0x0101010101010101;
    const std::uint64_t in_left = (samples & kFirstColumn * (0xffu >> left)) << left,
                        in_right = samples >> (8 - left) & kFirstColumn * (0xffu >> (8 - left));
    const auto above = [&](std::uint64_t bits) { return bits << 8 * top; };
    const auto below = [&](std::uint64_t bits) { return bits >> 8 >> (56 - 8 * top); };
    return {above(in_left), above(in_right), below(in_left), below(in_right)};
}

/// Returns one bit per packet of the blocks that contains any of the samples.
std::uint32_t packets_of(const std::array<std::uint64_t, 4>& samples) {
    std::uint32_t packets = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        constexpr std::uint64_t kAllButLast = 0x7fff7fff7fff7fff;
        const std::uint64_t any = (((samples[k] & kAllButLast) + kAllButLast) | samples[k]) & ~kAllButLast;
        // Move bits 15, 31, 47 and 63 to four adjacent bits.
        packets |= static_cast<std::uint32_t>((any >> 15) * 0x0001000200040008 >> 48 & 0xf) << 4 * k;
    }
    return packets;
}

} // namespace

// The function has one loop over the packets of all blocks, so the CPU can mispredict only its trip count.
void DepthTile::draw(const CoverageMask& mask) {
    const int x = mask.x - rect_.x0, y = mask.y - rect_.y0, left = x & 7, top = y & 7;
    const int column = x >> 3, row = y >> 3; // block of the first sample, perhaps just outside the tile
    const std::array<std::uint64_t, 4> samples = split_over_blocks(mask.samples, left, top);
    const std::uint32_t in_tile = ((column >= 0 ? 0x0f0fu : 0) | (column + 1 < kBlocks ? 0xf0f0u : 0)) &
                                  ((row >= 0 ? 0x00ffu : 0) | (row + 1 < kBlocks ? 0xff00u : 0));
    const DepthEvaluator<2> reversed_depth(mask.depth_plane, viewport_, -left, -top);
    for (const std::size_t packet : SetBits(packets_of(samples) & in_tile)) {
        const std::size_t quarter = packet / 4;
        const auto block = static_cast<std::size_t>((row + static_cast<int>(quarter / 2)) * kBlocks + column +
                                                    static_cast<int>(quarter % 2));
        begin_block(block);
        draw_packet(block, packet % 4 * kPacketSize, samples[quarter], mask.id,
                    [&](std::size_t i) { return reversed_depth.at(quarter, i); });
    }
}

void DepthTile::draw(std::span<const Fragment> fragments) {
    for (const Fragment& f : fragments) depth_test_sample(f.sample_index, f.id, f.reversed_depth);
}

void DepthTile::depth_test_sample(std::size_t sample_index, std::uint32_t id, float reversed_depth) {
    begin_block(sample_index / kBlockSamples);
    const auto number = static_cast<std::int32_t>(id);
    const bool tie_won = reversed_depth == reversed_depth_[sample_index] && number < ids_[sample_index];
    if (!(reversed_depth > reversed_depth_[sample_index] || tie_won)) return;
    reversed_depth_[sample_index] = reversed_depth;
    ids_[sample_index] = number;
}

void DepthTile::update_farthest(std::size_t block) {
    Floats least(1.0f);
    for (std::size_t i = 0; i < kBlock * kBlock; i += Floats::size)
        least = min(least, Floats::load_aligned(&reversed_depth_[block * kBlock * kBlock + i]));
    farthest_[block] = reduce_min(least);
    draws_since_farthest_[block] = 0;
}

} // namespace duet::raster
