// Decides which samples small triangles cover, many triangles at a time. Those of large ones are decided by
// DepthTile::BlockCoverage (raster/visibility/depth_tile.cpp). The top-left rule is that of EdgeFunction (setup.h).
#include "raster/geometry/assemble.h"

#include "raster/geometry/setup.h"

namespace duet::raster {
namespace {

/// Stores an edge function at the first sample of a small box, and its increments to the next column and row.
struct SmallEdge {
    Ints at, step_x, step_y;
    Ints length; ///< |dx| + |dy|

    SmallEdge(Ints from_x, Ints from_y, Ints to_x, Ints to_y, Ints sample_x, Ints sample_y) {
        const Ints dx = to_x - from_x, dy = to_y - from_y, zero(0);
        const auto left_or_top = dy < zero || (dy == zero && dx > zero);
        at = dx * (sample_y - from_y) - dy * (sample_x - from_x);
        at = at + xsimd::select(left_or_top, zero, Ints(-1));
        length = abs(dx) + abs(dy);
        step_x = zero - dy * Ints(kSubpixels);
        step_y = dx * Ints(kSubpixels);
    }
};

/// Returns the maximum over the lanes of the number of samples from the first one to the end of the triangle along
/// one axis. Arguments are in grid points.
std::int32_t samples_across(const Ints& a, const Ints& b, const Ints& c, const Ints& first) {
    const Ints widths = max(max(a, b), c) - first; // small, so exact as floats
    return (static_cast<std::int32_t>(reduce_max(xsimd::to_float(widths))) >> kSubpixelBits) + 1;
}

} // namespace

/// Tests the samples of small boxes against the edges of sixteen triangles with SIMD. The loops cover as many rows
/// and columns of samples as the largest box has.
void Assembler::cover_candidates() {
    Candidates& c = candidates_;
    constexpr std::int32_t kWordRows = 32 / kSmallSide, kWords = kSmallRows / kWordRows;
    std::array<PacketOf<std::int32_t>, kWords> covered, well_inside;
    const Ints zero(0);
    for (std::size_t i = 0; i < c.count; i += Ints::size) {
        const Ints ax = load(c.x[0], i), ay = load(c.y[0], i);
        Ints bx = load(c.x[1], i), by = load(c.y[1], i), cx = load(c.x[2], i), cy = load(c.y[2], i);
        const Ints area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
        const auto negative = area < zero; // lanes with reversed winding
        const Ints sx = (load(c.sample_x, i) << kSubpixelBits) + Ints(min_offset_.x),
                   sy = (load(c.sample_y, i) << kSubpixelBits) + Ints(min_offset_.y);
        const Ints px = xsimd::select(negative, cx, bx), py = xsimd::select(negative, cy, by);
        cx = xsimd::select(negative, bx, cx), cy = xsimd::select(negative, by, cy);
        const SmallEdge ab(ax, ay, px, py, sx, sy), bc(px, py, cx, cy, sx, sy), ca(cx, cy, ax, ay, sx, sy);
        const std::array<Ints, 3> margin = edge_margins({ab.length, bc.length, ca.length}, Ints(abs(area)));
        std::array<Ints, 3> row{ab.at, bc.at, ca.at};
        const std::int32_t columns = samples_across(ax, px, cx, sx), rows = samples_across(ay, py, cy, sy);
        for (std::int32_t word = 0; word < kWords; ++word) {
            Ints some = zero, sure = zero;
            for (std::int32_t y = word * kWordRows; y < std::min((word + 1) * kWordRows, rows); ++y) {
                std::array<Ints, 3> e = row;
                Ints bit(static_cast<std::int32_t>(1u << y % kWordRows * kSmallSide));
                for (std::int32_t x = 0; x < columns; ++x) {
                    const Ints least = min(min(e[0], e[1]), e[2]);
                    some = some | xsimd::select(least >= zero, bit, zero);
                    sure = sure | xsimd::select(e[0] >= margin[0] && e[1] >= margin[1] && e[2] >= margin[2], bit, zero);
                    e = {e[0] + ab.step_x, e[1] + bc.step_x, e[2] + ca.step_x};
                    bit = bit + bit;
                }
                row = {row[0] + ab.step_y, row[1] + bc.step_y, row[2] + ca.step_y};
            }
            store(covered[static_cast<std::size_t>(word)], i, some);
            store(well_inside[static_cast<std::size_t>(word)], i, sure);
        }
    }
    for (std::size_t i = 0; i < c.count; ++i) {
        std::uint64_t any = 0;
        for (std::size_t box = 0; box < 2; ++box) {
            const auto bits = [&](const std::array<PacketOf<std::int32_t>, kWords>& words) {
                return std::uint64_t{static_cast<std::uint32_t>(words[2 * box][i])} |
                       std::uint64_t{static_cast<std::uint32_t>(words[2 * box + 1][i])} << 32;
            };
            any |= bits(covered);
            add_small_triangle(i, c.sample_y[i] + static_cast<std::int32_t>(box) * kSmallSide, bits(covered),
                               bits(well_inside));
        }
        if (any == 0) batch_->culled.subpixel += plan_->skips.subpixel;
    }
    c.count = 0;
}

/// Appends the samples of the i-th candidate in the box whose first row is `top`, clipped to the region.
void Assembler::add_small_triangle(std::size_t i, std::int32_t top, std::uint64_t covered, std::uint64_t well_inside) {
    if (covered == 0) return;
    const Candidates& c = candidates_;
    SmallTriangle small{c.index[i], c.sample_x[i], top, covered, well_inside};
    const PixelRect& r = plan_->grid.region;
    if (small.x < r.x0 || small.x + kSmallSide > r.x1 || small.y < r.y0 || small.y + kSmallSide > r.y1)
        for (int bit = 0; bit < kSmallSide * kSmallSide; ++bit) {
            const int x = small.x + bit % kSmallSide, y = small.y + bit / kSmallSide;
            if (x < r.x0 || x >= r.x1 || y < r.y0 || y >= r.y1) small.covered &= ~(std::uint64_t{1} << bit);
        }
    if (small.covered != 0) small_triangles_.push_back(small);
}

} // namespace duet::raster
