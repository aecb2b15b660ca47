#include "raster/geometry/assemble.h"

#include "raster/geometry/clip.h"

#include <algorithm>
#include <bit>

namespace duet::raster {
namespace {

/// Encodes the result of the culling tests for one triangle.
enum CullResult : std::int32_t {
    kOutside,
    kDegenerate,
    kBackface,
    kSubpixel,
    kSmall,
    kDraw,
    kClip,
};

/// Edge functions fit into 32 bits if the bounding box is narrower than this many grid points.
constexpr std::int32_t kNarrow = 1 << 14;

} // namespace

/// Stores sixteen snapped triangles in structure-of-arrays layout.
struct Assembler::TrianglePacket {
    std::uint32_t first = 0, count = 0; ///< index of the first triangle in the object, and number of used lanes
    std::array<PacketOf<std::int32_t>, 3> x, y;
    PacketOf<std::int32_t> any_outcode, common_outcode;
    PacketOf<std::int32_t> cull_result;
    PacketOf<std::int32_t> sample_x, sample_y; ///< first pixel of the bounding box
};

void Assembler::assemble(const AssemblyPlan& plan, const Triangles& triangles, const Run& run, bool cull_back_faces,
                         Batch& batch) {
    plan_ = &plan;
    object_ = &triangles.objects[run.object];
    run_ = run;
    cull_back_faces_ = cull_back_faces;
    batch_ = &batch;
    min_offset_ = max_offset_ = plan.samples.front();
    for (const SampleOffset offset : plan.samples) {
        min_offset_ = {std::min(min_offset_.x, offset.x), std::min(min_offset_.y, offset.y)};
        max_offset_ = {std::max(max_offset_.x, offset.x), std::max(max_offset_.y, offset.y)};
    }
    small_triangles_.clear();
    pending_.clear();
    overlaps_.clear();
    mask_overlaps_.clear();
    shape_ = ShapeTriangles(triangles.shape(run));
    TrianglePacket triangle_packet;
    for (std::uint32_t i = 0; i < run.count; i += kPacketSize) {
        gather(run.first + i, std::min<std::uint32_t>(kPacketSize, run.count - i), triangle_packet);
        classify(triangle_packet);
        dispatch(triangle_packet);
    }
    set_up_pending();
    cover_candidates();
    compute_small_depths();
    sorter_.sort(batch, overlaps_, mask_overlaps_, plan.grid.size());
}

void Assembler::gather(std::uint32_t first, std::uint32_t count, TrianglePacket& out) const {
    out.first = first;
    out.count = count;
    const ShapeTriangles shape = shape_;
    const SnappedVertex* vertices = object_->vertices.data();
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::array<std::uint32_t, 3> corner = shape.vertices(first + i);
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
    // Prefetch the vertices of the packet after the next while this one is processed.
    constexpr std::uint32_t kAhead = 2 * kPacketSize;
    const std::uint32_t end = std::min<std::uint32_t>(first + kAhead + kPacketSize, run_.first + run_.count);
    for (std::uint32_t i = first + kAhead; i < end; ++i)
        for (const std::uint32_t corner : shape.vertices(i)) prefetch(&vertices[corner]);
}

/// Runs all culling tests for sixteen triangles with SIMD.
void Assembler::classify(TrianglePacket& out) const {
    const bool one_sample = plan_->samples.size() == 1;
    const PixelRect& region = plan_->grid.region;
    const SkipFlags& skips = plan_->skips;
    const Ints zero(0), round_up(kSubpixels - 1);
    for (std::size_t i = 0; i < kPacketSize; i += Ints::size) {
        const Ints ax = load(out.x[0], i), ay = load(out.y[0], i);
        const Ints bx = load(out.x[1], i), by = load(out.y[1], i), cx = load(out.x[2], i), cy = load(out.y[2], i);
        const Ints x0 = min(min(ax, bx), cx), x1 = max(max(ax, bx), cx);
        const Ints y0 = min(min(ay, by), cy), y1 = max(max(ay, by), cy);
        const Ints width = x1 - x0, height = y1 - y0;
        const auto narrow = width < Ints(kNarrow) && height < Ints(kNarrow);
        const Ints area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax); // valid only where `narrow`
        const auto front = object_->mirrored ? area > zero : area < zero;

        const Ints first_x = (x0 - Ints(max_offset_.x) + round_up) >> kSubpixelBits,
                   last_x = (x1 - Ints(min_offset_.x)) >> kSubpixelBits;
        const Ints first_y = (y0 - Ints(max_offset_.y) + round_up) >> kSubpixelBits,
                   last_y = (y1 - Ints(min_offset_.y)) >> kSubpixelBits;
        const auto between = last_x < first_x || last_y < first_y;
        const auto beside = last_x < Ints(region.x0) || first_x >= Ints(region.x1) || last_y < Ints(region.y0) ||
                            first_y >= Ints(region.y1);
        const auto box_small = last_x - first_x < Ints(kSmallSide) && last_y - first_y < Ints(kSmallRows);

        Ints cull_result(kDraw);
        if (one_sample) cull_result = xsimd::select(box_small, Ints(kSmall), cull_result);
        if (skips.frustum) cull_result = xsimd::select(beside, Ints(kOutside), cull_result);
        if (skips.subpixel) cull_result = xsimd::select(between, Ints(kSubpixel), cull_result);
        if (cull_back_faces_) cull_result = xsimd::select(front, cull_result, Ints(kBackface));
        cull_result = xsimd::select(area == zero, Ints(skips.degenerate ? kDegenerate : kDraw), cull_result);
        cull_result = xsimd::select(narrow, cull_result, Ints(kDraw)); // wider boxes are tested in 64 bits
        cull_result = xsimd::select((load(out.any_outcode, i) & Ints(kMustClip)) != zero, Ints(kClip), cull_result);
        if (skips.frustum)
            cull_result =
                xsimd::select((load(out.common_outcode, i) & Ints(kFrustum)) != zero, Ints(kOutside), cull_result);
        store(out.cull_result, i, cull_result);
        store(out.sample_x, i, first_x);
        store(out.sample_y, i, first_y);
    }
}

void Assembler::dispatch(const TrianglePacket& out) {
    std::uint32_t surviving = (1u << out.count) - 1; // one bit per lane: triangles that are not culled
    const auto remove = [&](CullResult cull_result) {
        const std::uint32_t these = surviving & lanes_equal(out.cull_result, cull_result);
        surviving &= ~these;
        return std::popcount(these);
    };
    CullCounts& culled = batch_->culled;
    culled.outside += remove(kOutside);
    culled.degenerate += remove(kDegenerate);
    culled.backfaces += remove(kBackface);
    culled.subpixel += remove(kSubpixel);
    if (const Mesh* mesh = shape_.mesh())
        for (const std::size_t lane : SetBits(surviving))
            for (const std::uint32_t corner : mesh->triangles[out.first + lane]) prefetch(&mesh->positions[corner]);
    for (const std::size_t lane : SetBits(surviving)) {
        const auto i = static_cast<std::uint32_t>(lane), index = out.first + i;
        if (out.cull_result[i] == kSmall) {
            add_candidate(out, i);
        } else if (out.cull_result[i] == kDraw) {
            const auto corner = [&](std::size_t k) { return FixedPoint{out.x[k][i], out.y[k][i]}; };
            if (add_triangle(index, {corner(0), corner(1), corner(2)}) != nullptr)
                pending_.push_back({index, static_cast<std::uint32_t>(batch_->triangles.size() - 1)});
        } else {
            clip_and_set_up(index);
        }
    }
}

void Assembler::clip_and_set_up(std::uint32_t index) {
    const UnclippedTriangle whole = shape_.unclipped(*object_, index);
    const ClippedPolygon polygon = clip(whole.a, whole.b, whole.c, plan_->viewport);
    if (polygon.count == 0) ++batch_->culled.outside;
    std::array<FixedPoint, 8> p;
    const auto count = static_cast<std::size_t>(polygon.count);
    for (std::size_t i = 0; i < count; ++i) p[i] = snap(polygon.vertices[i]);
    for (std::size_t i = 2; i < count; ++i)
        if (DrawTriangle* triangle = add_triangle(index, {p[0], p[i - 1], p[i]}))
            *triangle = set_up(whole, triangle->corners, triangle->id, true, plan_->viewport);
}

/// Appends a triangle with its corners and id only. Returns null if the triangle is culled.
DrawTriangle* Assembler::add_triangle(std::uint32_t index, std::array<FixedPoint, 3> p) {
    const std::int64_t area = doubled_area(p[0], p[1], p[2]);
    const PixelRect first = pixels_within(p, min_offset_), last = pixels_within(p, max_offset_);
    const PixelRect touched{last.x0, last.y0, first.x1, first.y1}; // union over all samples
    if (area == 0 && plan_->skips.degenerate) {
        ++batch_->culled.degenerate;
    } else if (cull_back_faces_ && is_backface(area, object_->mirrored)) {
        ++batch_->culled.backfaces;
    } else if (plan_->skips.subpixel && touched.empty()) {
        ++batch_->culled.subpixel;
    } else {
        if (area < 0) std::swap(p[1], p[2]);
        const auto number = static_cast<std::uint32_t>(batch_->triangles.size());
        plan_->grid.for_each(touched, [&](std::size_t tile) {
            overlaps_.push_back({static_cast<std::uint32_t>(tile), number});
        });
        return &batch_->triangles.emplace_back(DrawTriangle{.corners = p, .id = run_.first_id + index - run_.first});
    }
    return nullptr;
}

void Assembler::add_candidate(const TrianglePacket& out, std::uint32_t i) {
    Candidates& c = candidates_;
    c.index[c.count] = out.first + i;
    for (std::size_t k = 0; k < 3; ++k) {
        c.x[k][c.count] = out.x[k][i];
        c.y[k][c.count] = out.y[k][i];
    }
    c.sample_x[c.count] = out.sample_x[i];
    c.sample_y[c.count] = out.sample_y[i];
    if (++c.count == kPacketSize) cover_candidates();
}

} // namespace duet::raster
