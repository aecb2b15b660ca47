#include "raster/assemble.h"

#include "raster/clip.h"
#include "raster/planes.h"

#include <algorithm>
#include <bit>
#include <optional>

namespace duet::raster {
namespace {

/// What becomes of a triangle.
enum Verdict : std::int32_t {
    kOutside,
    kDegenerate,
    kBackface,
    kSubpixel,
    kSmall,
    kDraw,
    kClip,
};

/// Boxes below this side, in grid points, have edge functions that fit into 32 bits.
constexpr std::int32_t kNarrow = 1 << 14;

/// Boxes of at most so many samples along a side are small.
constexpr std::int32_t kSmallSide = 8;

/// An edge's function at the first sample of a small box, and its steps to the next.
struct SmallEdge {
    Ints at, step_x, step_y;
    Ints length; ///< |x| + |y|

    SmallEdge(Ints from_x, Ints from_y, Ints to_x, Ints to_y, Ints sample_x, Ints sample_y) {
        const Ints dx = to_x - from_x, dy = to_y - from_y, zero(0);
        const auto left_or_top = dy < zero || (dy == zero && dx > zero);
        at = dx * (sample_y - from_y) - dy * (sample_x - from_x);
        if (!sabotaged(Guard::kTopLeftRule)) at = at + xsimd::select(left_or_top, zero, Ints(-1));
        length = abs(dx) + abs(dy);
        step_x = zero - dy * Ints(kSubPixels);
        step_y = dx * Ints(kSubPixels);
    }
};

/// Samples along one axis from the first on, of the triangle that has most; corners and first samples in grid points.
std::int32_t samples_across(const Ints& a, const Ints& b, const Ints& c, const Ints& first) {
    const Ints widths = max(max(a, b), c) - first; // of small boxes: exact as floats
    return (static_cast<std::int32_t>(highest(xsimd::to_float(widths))) >> kSubPixelBits) + 1;
}

} // namespace

/// Sixteen triangles side by side.
struct Assembler::Outlines {
    std::uint32_t first = 0, count = 0; ///< triangles of the object
    std::array<StripOf<std::int32_t>, 3> x, y;
    StripOf<std::int32_t> any_outcode, common_outcode;
    StripOf<std::int32_t> verdict;
    StripOf<std::int32_t> sample_x, sample_y; ///< the first pixel of the box
};

void Assembler::assemble(const AssemblyPlan& plan, const Triangles& triangles, const Run& run, bool culls_back_faces,
                         Batch& batch) {
    plan_ = &plan;
    triangles_ = &triangles;
    object_ = &triangles.objects[run.object];
    run_ = run;
    culls_back_faces_ = culls_back_faces;
    batch_ = &batch;
    least_ = most_ = plan.samples.front();
    for (const SampleOffset offset : plan.samples) {
        least_ = {std::min(least_.x, offset.x), std::min(least_.y, offset.y)};
        most_ = {std::max(most_.x, offset.x), std::max(most_.y, offset.y)};
    }
    small_.clear();
    outlined_.clear();
    touches_.clear();
    patch_touches_.clear();
    const Shape& shape = triangles.shape(run);
    mesh_ = std::get_if<Mesh>(&shape);
    Outlines outlines;
    for (std::uint32_t i = 0; i < run.count; i += kStrip) {
        gather(shape, run.first + i, std::min<std::uint32_t>(kStrip, run.count - i), outlines);
        judge(outlines);
        sort_out(outlines);
    }
    set_up_outlines();
    cover_candidates();
    find_nearness();
    sorter_.sort(batch, touches_, patch_touches_, plan.grid.size());
}

namespace {

/// The corners of a triangle among its object's vertices.
std::array<std::uint32_t, 3> corners_of(const Mesh* mesh, std::uint32_t triangle) {
    if (mesh != nullptr) return mesh->triangles[triangle];
    const std::uint32_t quad = triangle / 2 * 4, half = triangle % 2;
    return {quad, quad + 1 + half, quad + 2 + half};
}

std::array<Vec3, 3> triangle_corners(const Shape& shape, const Mesh* mesh, std::uint32_t triangle) {
    if (mesh != nullptr) {
        const auto& corner = mesh->triangles[triangle];
        return {mesh->positions[corner[0]], mesh->positions[corner[1]], mesh->positions[corner[2]]};
    }
    const Corners four = primitive_corners(shape, triangle / 2);
    const std::size_t half = triangle % 2;
    return {four.p[0], four.p[1 + half], four.p[2 + half]};
}

} // namespace

void Assembler::gather(const Shape& shape, std::uint32_t first, std::uint32_t count, Outlines& out) const {
    out.first = first;
    out.count = count;
    const Mesh* mesh = std::get_if<Mesh>(&shape);
    const SnappedVertex* vertices = object_->vertices.data();
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::array<std::uint32_t, 3> corner = corners_of(mesh, first + i);
        unsigned any = 0, common = ~0u;
        for (std::size_t k = 0; k < 3; ++k) {
            const SnappedVertex& vertex = vertices[corner[k]];
            out.x[k][i] = vertex.p.x;
            out.y[k][i] = vertex.p.y;
            any |= vertex.outcode;
            common &= vertex.outcode;
        }
        out.any_outcode[i] = static_cast<std::int32_t>(any);
        out.common_outcode[i] = static_cast<std::int32_t>(common);
    }
    // Vertices of the sixteen after the next, while these are worked on.
    constexpr std::uint32_t kAhead = 2 * kStrip;
    const std::uint32_t end = std::min<std::uint32_t>(first + kAhead + kStrip, run_.first + run_.count);
    for (std::uint32_t i = first + kAhead; i < end; ++i)
        for (const std::uint32_t corner : corners_of(mesh, i)) prefetch(&vertices[corner]);
}

/// Decides sixteen triangles, all the tests side by side.
void Assembler::judge(Outlines& out) const {
    const bool one_sample = plan_->samples.size() == 1 && !sabotaged(Guard::kPerspective);
    const PixelRect& region = plan_->grid.region;
    const Skips& skips = plan_->skips;
    const Ints zero(0), round_up(kSubPixels - 1);
    for (std::size_t i = 0; i < kStrip; i += Ints::size) {
        const Ints ax = load(out.x[0], i), ay = load(out.y[0], i);
        const Ints bx = load(out.x[1], i), by = load(out.y[1], i), cx = load(out.x[2], i), cy = load(out.y[2], i);
        const Ints x0 = min(min(ax, bx), cx), x1 = max(max(ax, bx), cx);
        const Ints y0 = min(min(ay, by), cy), y1 = max(max(ay, by), cy);
        const Ints width = x1 - x0, height = y1 - y0;
        const auto narrow = width < Ints(kNarrow) && height < Ints(kNarrow);
        const Ints area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax); // of narrow ones
        const auto front = object_->mirrored ? area > zero : area < zero;

        const Ints first_x = (x0 - Ints(most_.x) + round_up) >> kSubPixelBits,
                   last_x = (x1 - Ints(least_.x)) >> kSubPixelBits;
        const Ints first_y = (y0 - Ints(most_.y) + round_up) >> kSubPixelBits,
                   last_y = (y1 - Ints(least_.y)) >> kSubPixelBits;
        const auto between = last_x < first_x || last_y < first_y;
        const auto beside = last_x < Ints(region.x0) || first_x >= Ints(region.x1) || last_y < Ints(region.y0) ||
                            first_y >= Ints(region.y1);
        const auto box_small = last_x - first_x < Ints(kSmallSide) && last_y - first_y < Ints(kSmallSide);

        Ints verdict(kDraw);
        if (one_sample) verdict = xsimd::select(box_small, Ints(kSmall), verdict);
        if (skips.frustum) verdict = xsimd::select(beside, Ints(kOutside), verdict);
        if (skips.subpixel) verdict = xsimd::select(between, Ints(kSubpixel), verdict);
        if (culls_back_faces_) verdict = xsimd::select(front, verdict, Ints(kBackface));
        verdict = xsimd::select(area == zero, Ints(skips.degenerate ? kDegenerate : kDraw), verdict);
        verdict = xsimd::select(narrow, verdict, Ints(kDraw)); // to be judged in 64 bits
        verdict = xsimd::select((load(out.any_outcode, i) & Ints(kMustClip)) != zero, Ints(kClip), verdict);
        if (skips.frustum)
            verdict = xsimd::select((load(out.common_outcode, i) & Ints(kFrustum)) != zero, Ints(kOutside), verdict);
        store(out.verdict, i, verdict);
        store(out.sample_x, i, first_x);
        store(out.sample_y, i, first_y);
    }
}

void Assembler::sort_out(const Outlines& out) {
    std::uint32_t chosen = (1u << out.count) - 1; // a bit each: those not culled
    const auto take_out = [&](Verdict verdict) {
        const std::uint32_t these = chosen & lanes_of_number(out.verdict, verdict);
        chosen &= ~these;
        return std::popcount(these);
    };
    CullCounts& culled = batch_->culled;
    culled.outside += take_out(kOutside);
    culled.degenerate += take_out(kDegenerate);
    culled.backfaces += take_out(kBackface);
    culled.subpixel += take_out(kSubpixel);
    if (mesh_ != nullptr)
        for (std::uint32_t left = chosen; left != 0; left &= left - 1)
            for (const std::uint32_t corner : mesh_->triangles[out.first + static_cast<std::uint32_t>(std::countr_zero(left))])
                prefetch(&mesh_->positions[corner]);
    for (std::uint32_t left = chosen; left != 0; left &= left - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(left)), index = out.first + i;
        if (out.verdict[i] == kSmall) {
            add_candidate(out, i);
        } else if (out.verdict[i] == kDraw) {
            const auto corner = [&](std::size_t k) { return FixedPoint{out.x[k][i], out.y[k][i]}; };
            if (add_outline(index, {corner(0), corner(1), corner(2)}) != nullptr)
                outlined_.push_back({index, static_cast<std::uint32_t>(batch_->triangles.size() - 1)});
        } else {
            clip_and_set_up(index);
        }
    }
}

/// As Triangles::whole, without the way from number to mesh.
WholeTriangle Assembler::whole_triangle(std::uint32_t index) const {
    if (mesh_ == nullptr) return triangles_->whole(run_, index);
    const auto& corner = mesh_->triangles[index];
    const auto vertex = [&](std::size_t k) { return pixel_vertex(*object_, mesh_->positions[corner[k]]); };
    return {vertex(0), vertex(1), vertex(2), Piece::kTriangle};
}

void Assembler::clip_and_set_up(std::uint32_t index) {
    const WholeTriangle whole = whole_triangle(index);
    const ClippedPolygon polygon = clip(whole.a, whole.b, whole.c, plan_->viewport);
    if (polygon.count == 0) ++batch_->culled.outside;
    std::array<FixedPoint, 8> p;
    const auto count = static_cast<std::size_t>(polygon.count);
    for (std::size_t i = 0; i < count; ++i) p[i] = snap(polygon.vertices[i]);
    for (std::size_t i = 2; i < count; ++i)
        if (DrawTriangle* triangle = add_outline(index, {p[0], p[i - 1], p[i]}))
            *triangle = set_up(whole, triangle->corners, triangle->id, true, plan_->viewport);
}

/// Adds a triangle that lacks all but its corners and number; null where it is culled.
DrawTriangle* Assembler::add_outline(std::uint32_t index, std::array<FixedPoint, 3> p) {
    const std::int64_t area = doubled_area(p[0], p[1], p[2]);
    const PixelRect first = pixels_within(p, least_), last = pixels_within(p, most_);
    const PixelRect touched{last.x0, last.y0, first.x1, first.y1}; // over all samples
    if (area == 0 && plan_->skips.degenerate) {
        ++batch_->culled.degenerate;
    } else if (culls_back_faces_ && is_backface(area, object_->mirrored)) {
        ++batch_->culled.backfaces;
    } else if (plan_->skips.subpixel && touched.empty()) {
        ++batch_->culled.subpixel;
    } else {
        if (area < 0) std::swap(p[1], p[2]);
        const auto number = static_cast<std::uint32_t>(batch_->triangles.size());
        plan_->grid.for_each(touched, [&](std::size_t tile) {
            touches_.push_back({static_cast<std::uint32_t>(tile), number});
        });
        return &batch_->triangles.emplace_back(DrawTriangle{.corners = p, .id = run_.first_id + index - run_.first});
    }
    return nullptr;
}

void Assembler::set_up_outlines() {
    PlaneStrip planes;
    for (std::size_t first = 0; first < outlined_.size(); first += kStrip) {
        const std::span<const Outlined> some = std::span(outlined_).subspan(first, std::min(kStrip, outlined_.size() - first));
        const auto triangle = [&](std::size_t i) -> DrawTriangle& { return batch_->triangles[some[i].number]; };
        const auto origin_of = [&](std::size_t i) {
            const Origin from = origin(triangle(i).corners, plan_->viewport);
            return Vec2d(from.x, from.y);
        };
        find_planes(some.size(), [&](std::size_t i) { return some[i].index; }, origin_of, planes);
        for (std::size_t i = 0; i < some.size(); ++i)
            set_plane(triangle(i), {planes.plane[0][i], planes.plane[1][i], planes.plane[2][i]}, planes.least_depth[i], false,
                      plan_->viewport.near);
    }
}

void Assembler::add_candidate(const Outlines& out, std::uint32_t i) {
    Candidates& c = candidates_;
    c.index[c.count] = out.first + i;
    for (std::size_t k = 0; k < 3; ++k) {
        c.x[k][c.count] = out.x[k][i];
        c.y[k][c.count] = out.y[k][i];
    }
    c.sample_x[c.count] = out.sample_x[i];
    c.sample_y[c.count] = out.sample_y[i];
    if (++c.count == kStrip) cover_candidates();
}

/// The samples of small boxes against their triangles' edges, sixteen triangles side by side: as many rows and columns of
/// samples as the largest of their boxes has.
void Assembler::cover_candidates() {
    Candidates& c = candidates_;
    constexpr std::int32_t kWordRows = 32 / kSmallSide, kWords = kSmallSide / kWordRows;
    std::array<StripOf<std::int32_t>, kWords> covered, well_inside;
    const Ints zero(0);
    for (std::size_t i = 0; i < c.count; i += Ints::size) {
        const Ints ax = load(c.x[0], i), ay = load(c.y[0], i);
        Ints bx = load(c.x[1], i), by = load(c.y[1], i), cx = load(c.x[2], i), cy = load(c.y[2], i);
        const Ints area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
        const auto negative = area < zero; // to be wound the other way
        const Ints sx = (load(c.sample_x, i) << kSubPixelBits) + Ints(least_.x),
                   sy = (load(c.sample_y, i) << kSubPixelBits) + Ints(least_.y);
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
        const auto bits = [&](const std::array<StripOf<std::int32_t>, kWords>& words) {
            return std::uint64_t{static_cast<std::uint32_t>(words[0][i])} |
                   std::uint64_t{static_cast<std::uint32_t>(words[1][i])} << 32;
        };
        add_small(i, bits(covered), bits(well_inside));
    }
    c.count = 0;
}

void Assembler::add_small(std::size_t i, std::uint64_t covered, std::uint64_t well_inside) {
    const Candidates& c = candidates_;
    if (covered == 0) {
        batch_->culled.subpixel += plan_->skips.subpixel;
        return;
    }
    Small small{c.index[i], c.sample_x[i], c.sample_y[i], covered, well_inside};
    const PixelRect& r = plan_->grid.region;
    if (small.x < r.x0 || small.x + kSmallSide > r.x1 || small.y < r.y0 || small.y + kSmallSide > r.y1)
        for (int bit = 0; bit < kSmallSide * kSmallSide; ++bit) {
            const int x = small.x + bit % kSmallSide, y = small.y + bit / kSmallSide;
            if (x < r.x0 || x >= r.x1 || y < r.y0 || y >= r.y1) small.covered &= ~(std::uint64_t{1} << bit);
        }
    if (small.covered != 0) small_.push_back(small);
}

void Assembler::find_nearness() {
    PlaneStrip planes;
    for (std::size_t first = 0; first < small_.size(); first += kStrip) {
        const std::span<const Small> some = std::span(small_).subspan(first, std::min(kStrip, small_.size() - first));
        const auto first_sample = [&](std::size_t i) { return least_.position(some[i].x, some[i].y); };
        find_planes(some.size(), [&](std::size_t i) { return some[i].index; }, first_sample, planes);
        for (std::size_t i = 0; i < some.size(); ++i) {
            const Small& small = some[i];
            const NearnessPlane plane{planes.plane[0][i], planes.plane[1][i], planes.plane[2][i]};
            constexpr int kFew = 2; // cheaper one by one
            const bool as_patch = plan_->patches && std::popcount(small.covered & small.well_inside) > kFew;
            if (as_patch) add_patch(small, plane);
            add_fragments(small, as_patch ? small.covered & ~small.well_inside : small.covered, plane);
        }
    }
}

/// What set_up does for one triangle, side by side: the planes of nearness of up to sixteen unclipped triangles of the
/// object, each counted from its own place in the picture.
template <typename IndexOf, typename OriginOf>
void Assembler::find_planes(std::size_t count, const IndexOf& index_of, const OriginOf& origin_of, PlaneStrip& planes) const {
    const Viewport& viewport = plan_->viewport;
    const Mat4d& m = object_->to_pixel;
    const Shape& shape = triangles_->shape(run_);
    const Mesh* mesh = std::get_if<Mesh>(&shape);
    std::array<std::array<StripOf<double>, 3>, 3> p; // corner, axis
    StripOf<double> from_x, from_y;
    for (std::size_t i = 0; i < count; ++i) {
        const std::array<Vec3, 3> corners = triangle_corners(shape, mesh, index_of(i));
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
        store(planes.least_depth, i, min(min(depth[0], depth[1]), depth[2]));
    }
}

void Assembler::add_patch(const Small& small, const NearnessPlane& plane) {
    const auto number = static_cast<std::uint32_t>(batch_->patches.size());
    const std::uint64_t samples = small.covered & small.well_inside;
    batch_->patches.push_back(
        {.samples = samples, .nearness = plane, .id = run_.first_id + small.index - run_.first, .x = small.x, .y = small.y});
    std::uint64_t columns = samples | samples >> 32; // all rows or-ed
    columns |= columns >> 16;
    columns |= columns >> 8;
    const auto length = [](std::uint64_t bits) { return 64 - std::countl_zero(bits); };
    const int width = length(columns & 0xff), height = (length(samples) + kSmallSide - 1) / kSmallSide;
    plan_->grid.for_each({small.x, small.y, small.x + width, small.y + height}, [&](std::size_t tile) {
        patch_touches_.push_back({static_cast<std::uint32_t>(tile), number});
    });
}

/// Covered samples of a small triangle: by the plane of its nearness where they lie well inside, else one by one.
void Assembler::add_fragments(const Small& small, std::uint64_t samples, const NearnessPlane& plane) {
    if (samples == 0) return;
    constexpr std::uint32_t kSize = TileGrid::kTileSize;
    const std::uint32_t id = run_.first_id + small.index - run_.first;
    const auto left = static_cast<std::uint32_t>(small.x - plan_->grid.region.x0),
               top = static_cast<std::uint32_t>(small.y - plan_->grid.region.y0);
    const auto columns = static_cast<std::uint32_t>(plan_->grid.columns());
    std::optional<WholeTriangle> whole; // where it is needed
    for (std::uint64_t bits = samples; bits != 0; bits &= bits - 1) {
        const int bit = std::countr_zero(bits), across = bit % kSmallSide, down = bit / kSmallSide;
        double nearness = (plane.constant + down * plane.y) + across * plane.x;
        if (plan_->viewport.orthographic) nearness = plan_->viewport.near / nearness;
        const bool inside = small.well_inside >> bit & 1;
        if (!inside) {
            if (!whole) whole = whole_triangle(small.index);
            nearness = interpolate(*whole, least_.position(small.x + across, small.y + down)).nearness(plan_->viewport.near);
        }
        const std::uint32_t column = left + static_cast<std::uint32_t>(across), row = top + static_cast<std::uint32_t>(down);
        batch_->fragments.push_back({.id = id,
                                     .nearness = kept_nearness(nearness),
                                     .place = static_cast<std::uint16_t>(place_in_tile(column % kSize, row % kSize) & 0x7fff),
                                     .inside = inside,
                                     .tile = static_cast<std::uint16_t>(row / kSize * columns + column / kSize)});
    }
}

} // namespace duet::raster
