#include "raster/solve.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace duet::raster {

void StripSolver::load(const std::int32_t* ids) {
    const Ints none(static_cast<std::int32_t>(kNoTriangle));
    std::uint32_t seen = 0;
    for (std::size_t i = 0; i < kStrip; i += Ints::size)
        seen |= lane_bits(Ints::load_aligned(ids + i) != none) << i;
    const std::uint32_t before = seen_;
    seen_ = seen;
    on_mesh_ = one_object_ != nullptr ? seen : 0;
    if (seen == 0) return;
    const Ints first(ids[std::countr_zero(seen)]);
    bool same = before != 0, one = true;
    std::int32_t low = kNoTriangle, high = 0;
    for (std::size_t i = 0; i < kStrip; i += Ints::size) {
        const Ints read = Ints::load_aligned(ids + i), filled = xsimd::select(read == none, first, read);
        same = same && xsimd::all(filled == raster::load(ids_, i));
        one = one && xsimd::all(filled == first);
        store(ids_, i, filled);
    }
    if (same) return;
    for (const std::int32_t id : ids_.v) {
        low = std::min(low, id);
        high = std::max(high, id);
    }
    one_object_ = nullptr;
    one_mesh_ = nullptr;
    on_mesh_ = 0;
    last_run_ = &triangles_.run_of(static_cast<std::uint32_t>(low),
                                   last_run_ != nullptr ? *last_run_ : triangles_.runs.front());
    const Run& last = triangles_.run_of(static_cast<std::uint32_t>(high), *last_run_);
    // Numbers are in the order of objects: between two of one object there is no other's.
    if (last_run_->sphere || last.sphere || last.object != last_run_->object) return;
    one_mesh_ = std::get_if<Mesh>(&triangles_.shape(last));
    if (one_mesh_ == nullptr) return;
    one_object_ = &triangles_.objects[last.object];
    on_mesh_ = seen;
    first_id_ = last.first_id - last.first;
    const auto& vertices = (*triangles_.vertices)[triangles_.scene->objects[one_object_->object].shape];
    if (one)
        load_one(vertices);
    else
        load_each(vertices);
}

/// All samples see one triangle.
void StripSolver::load_one(const std::vector<PackedVertex>& vertices) {
    const auto& corners = one_mesh_->triangles[index(0)];
    for (std::size_t k = 0; k < 3; ++k) {
        const PackedVertex& vertex = vertices[corners[k]];
        const PixelVertex pixel = pixel_vertex(*one_object_, vertex.p);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            position[k][axis].fill(vertex.p[axis]);
            normal[k][axis].fill(vertex.n[axis]);
        }
        x_[k].fill(pixel.xw);
        y_[k].fill(pixel.yw);
        depth_[k].fill(pixel.depth);
    }
}

void StripSolver::load_each(const std::vector<PackedVertex>& vertices) {
    const Mat4d& m = one_object_->to_pixel;
    std::array<std::array<PackedVertex, kStrip>, 3> lanes;
    std::array<std::array<std::uint32_t, 3>, kStrip> corners;
    for (std::size_t i = 0; i < kStrip; ++i) { // all the waiting for memory at once
        corners[i] = one_mesh_->triangles[index(i)];
        for (const std::uint32_t corner : corners[i]) prefetch(&vertices[corner]);
    }
    for (std::size_t i = 0; i < kStrip; ++i)
        for (std::size_t k = 0; k < 3; ++k) lanes[k][i] = vertices[corners[i][k]];
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < kStrip; ++i) {
            position[k][0][i] = lanes[k][i].p.x;
            position[k][1][i] = lanes[k][i].p.y;
            position[k][2][i] = lanes[k][i].p.z;
            normal[k][0][i] = lanes[k][i].n.x;
            normal[k][1][i] = lanes[k][i].n.y;
            normal[k][2][i] = lanes[k][i].n.z;
        }
        for (std::size_t i = 0; i < kStrip; i += Doubles::size) {
            const Doubles x = widened(position[k][0].at(i)), y = widened(position[k][1].at(i)),
                          z = widened(position[k][2].at(i));
            const auto row = [&](std::size_t r) {
                return Doubles(m[r][0]) * x + Doubles(m[r][1]) * y + Doubles(m[r][2]) * z + Doubles(m[r][3]);
            };
            store(x_[k], i, row(0));
            store(y_[k], i, row(1));
            store(depth_[k], i, row(2));
        }
    }
}

// With the vertices moved so that the sample is the origin, the edge functions of Interpolation are plain 2 × 2
// determinants: b_i = e_i / Σe, whatever the triangle's winding, and depth = Σ(e·depth) / Σe.
void StripSolver::solve(int x, int y, SampleOffset offset) {
    inside_ = counter_clockwise_ = 0;
    if (on_mesh_ == 0) return;
    const Vec2d first = offset.position(x, y);
    const bool orthographic = view_.viewport.orthographic;
    for (std::size_t i = 0; i < kStrip; i += Doubles::size) {
        const Doubles sx = Doubles(first.x) + raster::load(kColumns<double>, i),
                      sy = Doubles(first.y) + raster::load(kRows<double>, i), one(1.0), zero(0.0);
        std::array<Doubles, 3> vx, vy, d, w;
        for (std::size_t k = 0; k < 3; ++k) {
            d[k] = raster::load(depth_[k], i);
            w[k] = orthographic ? one : d[k];
            vx[k] = raster::load(x_[k], i) - sx * w[k];
            vy[k] = raster::load(y_[k], i) - sy * w[k];
        }
        const Doubles e0 = vx[1] * vy[2] - vy[1] * vx[2], e1 = vx[2] * vy[0] - vy[2] * vx[0],
                      e2 = vx[0] * vy[1] - vy[0] * vx[1];
        const Doubles determinant = e0 * w[0] + e1 * w[1] + e2 * w[2];
        const Doubles sum = e0 + e1 + e2, depth_sum = e0 * d[0] + e1 * d[1] + e2 * d[2];
        const Doubles inverse = one / sum;
        store(b1, i, e1 * inverse);
        store(b2, i, e2 * inverse);
        store(depth, i, depth_sum * inverse);
        const auto positive = determinant > zero, negative = determinant < zero;
        const Doubles least = min(min(e0, e1), e2), most = max(max(e0, e1), e2);
        inside_ |= lane_bits((positive && least >= zero) || (negative && most <= zero)) << i;
        counter_clockwise_ |= lane_bits(negative) << i;
    }
    inside_ &= sabotaged(Guard::kPerspective) ? 0 : on_mesh_;
}

void StripSolver::solve_all(int x, int y, SampleOffset offset) {
    solve(x, y, offset);
    for (std::uint32_t left = on_mesh_ & ~inside_; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        const Vec2d sample = offset.position(x + static_cast<int>(i % kStripWidth), y + static_cast<int>(i / kStripWidth));
        const WholeTriangle whole = triangles_.whole(run(i), Triangles::index(run(i), id(i)));
        const Interpolated at = interpolate(whole, sample);
        b1[i] = at.b1 / at.sum;
        b2[i] = at.b2 / at.sum;
        depth[i] = at.depth_sum / at.sum;
    }
}

} // namespace duet::raster
