#include "raster/assemble.h"

#include "raster/clip.h"

#include <algorithm>

namespace duet::raster {
namespace {

/// What becomes of a triangle.
enum Verdict : std::int32_t {
    kOutside,
    kDegenerate,
    kBackface,
    kSubpixel,
    kSmall, ///< its samples are known
    kDraw,
    kClip,
};

/// Boxes below this side, in grid points, have edge functions that fit into 32 bits.
constexpr std::int32_t kNarrow = 1 << 14;

Ints as_ints(const xsimd::batch_bool<std::int32_t>& flags, std::int32_t value) {
    return xsimd::select(flags, Ints(value), Ints(0));
}

/// An edge's function at the first sample of a box of 2 × 2, and its steps to the next.
struct SmallEdge {
    Ints at, step_x, step_y;

    SmallEdge(Ints from_x, Ints from_y, Ints to_x, Ints to_y, Ints sample_x, Ints sample_y) {
        const Ints dx = to_x - from_x, dy = to_y - from_y, zero(0);
        const auto left_or_top = dy < zero || (dy == zero && dx > zero);
        at = dx * (sample_y - from_y) - dy * (sample_x - from_x);
        if (!sabotaged(Guard::kTopLeftRule)) at = at + xsimd::select(left_or_top, zero, Ints(-1));
        step_x = zero - dy * Ints(kSubPixels);
        step_y = dx * Ints(kSubPixels);
    }
};

} // namespace

/// Sixteen triangles side by side.
struct Assembler::Outlines {
    std::uint32_t first = 0, count = 0; ///< triangles of the object
    std::array<StripOf<std::int32_t>, 3> x, y;
    StripOf<std::int32_t> any_outcode, common_outcode;
    StripOf<std::int32_t> verdict;
    StripOf<std::int32_t> sample_x, sample_y; ///< the first pixel of the box
    /// Of kSmall: bit 2·row + column for each sample of the box that is covered, and that is well inside.
    StripOf<std::int32_t> covered, well_inside;
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
    samples_.clear();
    edge_samples_.clear();
    touches_.clear();
    const Shape& shape = triangles.shape(run);
    Outlines outlines;
    for (std::uint32_t i = 0; i < run.count; i += kStrip) {
        gather(shape, run.first + i, std::min<std::uint32_t>(kStrip, run.count - i), outlines);
        judge(outlines);
        sort_out(outlines);
    }
    find_nearness();
    sorter_.sort(batch, touches_, plan.grid.size());
}

namespace {

/// The corners of a triangle among its object's vertices.
std::array<std::uint32_t, 3> corners_of(const Mesh* mesh, std::uint32_t triangle) {
    if (mesh != nullptr) return mesh->triangles[triangle];
    const std::uint32_t quad = triangle / 2 * 4, half = triangle % 2;
    return {quad, quad + 1 + half, quad + 2 + half};
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
    // The next sixteen's vertices, while these are worked on.
    const std::uint32_t end = std::min(first + 2 * static_cast<std::uint32_t>(kStrip), run_.first + run_.count);
    for (std::uint32_t i = first + kStrip; i < end; ++i)
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
        Ints bx = load(out.x[1], i), by = load(out.y[1], i), cx = load(out.x[2], i), cy = load(out.y[2], i);
        const Ints x0 = min(min(ax, bx), cx), x1 = max(max(ax, bx), cx);
        const Ints y0 = min(min(ay, by), cy), y1 = max(max(ay, by), cy);
        const Ints width = x1 - x0, height = y1 - y0;
        const auto narrow = width < Ints(kNarrow) && height < Ints(kNarrow);
        const Ints area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax); // of narrow ones
        const auto negative = area < zero;
        const auto front = object_->mirrored ? area > zero : negative;

        const Ints first_x = (x0 - Ints(most_.x) + round_up) >> kSubPixelBits,
                   last_x = (x1 - Ints(least_.x)) >> kSubPixelBits;
        const Ints first_y = (y0 - Ints(most_.y) + round_up) >> kSubPixelBits,
                   last_y = (y1 - Ints(least_.y)) >> kSubPixelBits;
        const auto between = last_x < first_x || last_y < first_y;
        const auto beside = last_x < Ints(region.x0) || first_x >= Ints(region.x1) || last_y < Ints(region.y0) ||
                            first_y >= Ints(region.y1);
        const auto box_small = last_x - first_x <= Ints(1) && last_y - first_y <= Ints(1);

        // Of positive winding, the samples of a box of 2 × 2 against the three edges.
        const Ints sample_x = (first_x << kSubPixelBits) + Ints(least_.x),
                   sample_y = (first_y << kSubPixelBits) + Ints(least_.y);
        const Ints px = xsimd::select(negative, cx, bx), py = xsimd::select(negative, cy, by);
        cx = xsimd::select(negative, bx, cx), cy = xsimd::select(negative, by, cy);
        const SmallEdge ab(ax, ay, px, py, sample_x, sample_y), bc(px, py, cx, cy, sample_x, sample_y),
            ca(cx, cy, ax, ay, sample_x, sample_y);
        const Ints margin = width + height + Ints(1);
        Ints covered = zero, well_inside = zero;
        for (std::int32_t s = 0; s < 4; ++s) {
            const auto at = [&](const SmallEdge& e) {
                return e.at + (s & 1 ? e.step_x : zero) + (s & 2 ? e.step_y : zero);
            };
            const Ints e0 = at(ab), e1 = at(bc), e2 = at(ca);
            covered = covered | as_ints((e0 | e1 | e2) >= zero, 1 << s);
            well_inside = well_inside | as_ints(min(min(e0, e1), e2) >= margin, 1 << s);
        }

        Ints verdict(kDraw);
        if (one_sample) verdict = xsimd::select(box_small, Ints(kSmall), verdict);
        if (one_sample && skips.subpixel)
            verdict = xsimd::select(box_small && covered == zero, Ints(kSubpixel), verdict);
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
        store(out.covered, i, covered);
        store(out.well_inside, i, well_inside);
    }
}

void Assembler::sort_out(const Outlines& out) {
    std::array<std::int64_t, kClip + 1> counts{};
    std::array<std::uint32_t, kStrip> chosen; // those not culled, without a branch to be guessed wrong
    std::size_t left = 0;
    for (std::uint32_t i = 0; i < out.count; ++i) {
        ++counts[static_cast<std::size_t>(out.verdict[i])];
        chosen[left] = i;
        left += out.verdict[i] >= kSmall;
    }
    CullCounts& culled = batch_->culled;
    culled.outside += counts[kOutside];
    culled.degenerate += counts[kDegenerate];
    culled.backfaces += counts[kBackface];
    culled.subpixel += counts[kSubpixel];
    if (const Mesh* mesh = std::get_if<Mesh>(&triangles_->shape(run_)))
        for (std::size_t k = 0; k < left; ++k)
            for (const std::uint32_t corner : mesh->triangles[out.first + chosen[k]]) prefetch(&mesh->positions[corner]);
    for (std::size_t k = 0; k < left; ++k) {
        const std::uint32_t i = chosen[k], index = out.first + i;
        if (out.verdict[i] == kSmall) {
            const auto covered = static_cast<unsigned>(out.covered[i]);
            for (unsigned s = 0; s < 4; ++s) {
                if (!(covered >> s & 1)) continue;
                const Sample sample{index, out.sample_x[i] + static_cast<std::int32_t>(s & 1),
                                    out.sample_y[i] + static_cast<std::int32_t>(s >> 1)};
                const PixelRect& r = plan_->grid.region;
                if (sample.x < r.x0 || sample.x >= r.x1 || sample.y < r.y0 || sample.y >= r.y1) continue;
                (static_cast<unsigned>(out.well_inside[i]) >> s & 1 ? samples_ : edge_samples_).push_back(sample);
            }
        } else if (out.verdict[i] == kDraw) {
            set_up_outline(index, triangles_->whole(run_, index),
                           {FixedPoint{out.x[0][i], out.y[0][i]}, FixedPoint{out.x[1][i], out.y[1][i]},
                            FixedPoint{out.x[2][i], out.y[2][i]}},
                           false);
        } else {
            clip_and_set_up(index);
        }
    }
}

void Assembler::clip_and_set_up(std::uint32_t index) {
    const WholeTriangle whole = triangles_->whole(run_, index);
    const ClippedPolygon polygon = clip(whole.a, whole.b, whole.c, plan_->viewport);
    if (polygon.count == 0) ++batch_->culled.outside;
    std::array<FixedPoint, 8> p;
    const auto count = static_cast<std::size_t>(polygon.count);
    for (std::size_t i = 0; i < count; ++i) p[i] = snap(polygon.vertices[i]);
    for (std::size_t i = 2; i < count; ++i) set_up_outline(index, whole, {p[0], p[i - 1], p[i]}, true);
}

void Assembler::set_up_outline(std::uint32_t index, const WholeTriangle& whole, std::array<FixedPoint, 3> p,
                               bool clipped) {
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
        batch_->triangles.push_back(
            set_up(whole, p, run_.first_id + index - run_.first, clipped, plan_->viewport));
        plan_->grid.for_each(touched, [&](std::size_t tile) {
            touches_.push_back({static_cast<std::uint32_t>(tile), number});
        });
    }
}

/// Nearness of the small triangles' samples. With the vertices moved so that the sample is the origin, the three edge
/// functions of Interpolation are plain 2 × 2 determinants.
void Assembler::find_nearness() {
    const Viewport& viewport = plan_->viewport;
    const Mat4d& m = object_->to_pixel;
    const double offset_x = static_cast<double>(least_.x) / kSubPixels,
                 offset_y = static_cast<double>(least_.y) / kSubPixels;
    const Shape& shape = triangles_->shape(run_);
    const Mesh* mesh = std::get_if<Mesh>(&shape);
    std::array<std::array<StripOf<double>, 3>, 3> p; // vertex, axis
    StripOf<double> px, py, nearness;
    for (std::size_t first = 0; first < samples_.size(); first += kStrip) {
        const std::size_t count = std::min(kStrip, samples_.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            const Sample& sample = samples_[first + i];
            std::array<Vec3, 3> corners;
            if (mesh != nullptr) {
                const auto& corner = mesh->triangles[sample.index];
                corners = {mesh->positions[corner[0]], mesh->positions[corner[1]], mesh->positions[corner[2]]};
            } else {
                const Corners four = primitive_corners(shape, sample.index / 2);
                const std::size_t half = sample.index % 2;
                corners = {four.p[0], four.p[1 + half], four.p[2 + half]};
            }
            for (std::size_t k = 0; k < 3; ++k) {
                p[k][0][i] = static_cast<double>(corners[k].x);
                p[k][1][i] = static_cast<double>(corners[k].y);
                p[k][2][i] = static_cast<double>(corners[k].z);
            }
            px[i] = sample.x + offset_x;
            py[i] = sample.y + offset_y;
        }
        for (std::size_t i = 0; i < count; i += Doubles::size) {
            std::array<Doubles, 3> x, y, depth;
            const Doubles sx = load(px, i), sy = load(py, i);
            for (std::size_t k = 0; k < 3; ++k) {
                const Doubles vx = load(p[k][0], i), vy = load(p[k][1], i), vz = load(p[k][2], i);
                const auto row = [&](std::size_t r) {
                    return Doubles(m[r][0]) * vx + Doubles(m[r][1]) * vy + Doubles(m[r][2]) * vz + Doubles(m[r][3]);
                };
                depth[k] = row(2);
                const Doubles w = viewport.orthographic ? Doubles(1.0) : depth[k];
                x[k] = row(0) - sx * w;
                y[k] = row(1) - sy * w;
            }
            const Doubles e0 = x[1] * y[2] - y[1] * x[2], e1 = x[2] * y[0] - y[2] * x[0],
                          e2 = x[0] * y[1] - y[0] * x[1];
            const Doubles depth_sum = e0 * depth[0] + e1 * depth[1] + e2 * depth[2];
            store(nearness, i, Doubles(viewport.near) * (e0 + e1 + e2) / depth_sum);
        }
        for (std::size_t i = 0; i < count; ++i) {
            const Sample& sample = samples_[first + i];
            add_fragment(sample.index, sample.x, sample.y, kept_nearness(nearness[i]));
        }
    }
    for (const Sample& sample : edge_samples_) {
        const WholeTriangle whole = triangles_->whole(run_, sample.index);
        const Interpolated here = interpolate(whole, {sample.x + offset_x, sample.y + offset_y});
        add_fragment(sample.index, sample.x, sample.y, kept_nearness(here.nearness(viewport.near)));
    }
}

void Assembler::add_fragment(std::uint32_t index, std::int32_t x, std::int32_t y, float nearness) {
    constexpr std::uint32_t kSize = TileGrid::kTileSize;
    const auto column = static_cast<std::uint32_t>(x - plan_->grid.region.x0),
               row = static_cast<std::uint32_t>(y - plan_->grid.region.y0);
    const std::uint32_t tile = row / kSize * static_cast<std::uint32_t>(plan_->grid.columns()) + column / kSize;
    batch_->fragments.push_back({run_.first_id + index - run_.first, nearness,
                                 static_cast<std::uint16_t>(place_in_tile(column % kSize, row % kSize)),
                                 static_cast<std::uint16_t>(tile)});
}

} // namespace duet::raster
