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

/// The corners of the samples' triangles, by axis, in the object's space.
struct StripSolver::Corners {
    std::array<std::array<StripOf<float>, 3>, 3> p, n;
};

/// All samples see one triangle.
void StripSolver::load_one(const std::vector<PackedVertex>& vertices) {
    Corners corners;
    const auto& triangle = one_mesh_->triangles[index(0)];
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            corners.p[k][axis].fill(vertices[triangle[k]].p[axis]);
            corners.n[k][axis].fill(vertices[triangle[k]].n[axis]);
        }
    set_up(corners);
}

void StripSolver::load_each(const std::vector<PackedVertex>& vertices) {
    std::array<std::array<std::uint32_t, 3>, kStrip> triangles;
    for (std::size_t i = 0; i < kStrip; ++i) { // all the waiting for memory at once
        triangles[i] = one_mesh_->triangles[index(i)];
        for (const std::uint32_t corner : triangles[i]) prefetch(&vertices[corner]);
    }
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < kStrip; i += Quads::size) {
            const auto take = [&](std::size_t first, std::array<StripOf<float>, 3>& to) { // number of four in the vertex
                const auto from = [&](std::size_t lane) {
                    return Quads::load_aligned(&vertices[triangles[i + lane][k]].p.x + first);
                };
                const Transposed four = transposed(from(0), from(1), from(2), from(3));
                four.x.store_aligned(to[0].at(i));
                four.y.store_aligned(to[1].at(i));
                four.z.store_aligned(to[2].at(i));
            };
            take(0, corners.p[k]);
            take(4, corners.n[k]);
        }
    set_up(corners);
}

void StripSolver::set_up(const Corners& corners) {
    const Mat4d& m = one_object_->to_pixel;
    const bool orthographic = view_.viewport.orthographic;
    StripOf<std::int32_t> back;
    for (std::size_t i = 0; i < kStrip; i += Doubles::size) {
        std::array<Doubles, 3> x, y, w, d;
        for (std::size_t k = 0; k < 3; ++k) {
            const Doubles px = widened(corners.p[k][0].at(i)), py = widened(corners.p[k][1].at(i)),
                          pz = widened(corners.p[k][2].at(i));
            const auto row = [&](std::size_t r) {
                return Doubles(m[r][0]) * px + Doubles(m[r][1]) * py + Doubles(m[r][2]) * pz + Doubles(m[r][3]);
            };
            d[k] = row(2);
            w[k] = orthographic ? Doubles(1.0) : d[k];
            x[k] = row(0) - Doubles(static_cast<double>(origin_x_)) * w[k];
            y[k] = row(1) - Doubles(static_cast<double>(origin_y_)) * w[k];
        }
        std::array<std::array<Doubles, 3>, 3> e; // corner; coefficients of x, y and 1: cross products of the others
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
            e[k] = {y[a] * w[b] - w[a] * y[b], w[a] * x[b] - x[a] * w[b], x[a] * y[b] - y[a] * x[b]};
        }
        const Doubles determinant = x[0] * e[0][0] + y[0] * e[0][1] + w[0] * e[0][2], zero(0.0);
        const auto negative = determinant < zero;
        const Doubles sign = xsimd::select(negative, Doubles(-1.0), Doubles(1.0));
        for (std::size_t c = 0; c < 3; ++c) {
            store(e1_[c], i, e[1][c] * sign);
            store(e2_[c], i, e[2][c] * sign);
            store(sum_[c], i, (e[0][c] + e[1][c] + e[2][c]) * sign);
            store(depth_sum_[c], i, (e[0][c] * d[0] + e[1][c] * d[1] + e[2][c] * d[2]) * sign);
        }
        // Counter-clockwise in the picture (its y points down) is the front, of an object that is not mirrored.
        const std::uint32_t front = lane_bits(negative) ^ (one_object_->mirrored ? ~0u : 0u);
        for (std::size_t k = 0; k < Doubles::size; ++k) back[i + k] = front >> k & 1 ? 0 : 1;
    }
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        const auto at = [&](const std::array<StripOf<float>, 3>& v, std::size_t axis) { return raster::load(v[axis], i); };
        std::array<Floats, 3> ab, ac;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Floats p0 = at(corners.p[0], axis), n0 = at(corners.n[0], axis);
            ab[axis] = at(corners.p[1], axis) - p0;
            ac[axis] = at(corners.p[2], axis) - p0;
            store(n[axis], i, n0);
            store(n1[axis], i, at(corners.n[1], axis) - n0);
            store(n2[axis], i, at(corners.n[2], axis) - n0);
        }
        const Floats side = xsimd::select(xsimd::bool_cast(raster::load(back, i) != Ints(0)), Floats(-1.0f), Floats(1.0f));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
            store(ng[axis], i, (ab[a] * ac[b] - ab[b] * ac[a]) * side);
        }
    }
}

// Barycentrics are bᵢ = eᵢ / Σe, depth is Σ(e·depth) / Σe: see Interpolation.
void StripSolver::solve(int x, int y, SampleOffset offset) {
    inside_ = 0;
    if (on_mesh_ == 0) return;
    const Vec2d first = offset.position(x - origin_x_, y - origin_y_);
    for (std::size_t i = 0; i < kStrip; i += Doubles::size) {
        const Doubles sx = Doubles(first.x) + raster::load(kColumns<double>, i),
                      sy = Doubles(first.y) + raster::load(kRows<double>, i), zero(0.0);
        const auto at = [&](const std::array<StripOf<double>, 3>& plane) {
            return (raster::load(plane[2], i) + raster::load(plane[1], i) * sy) + raster::load(plane[0], i) * sx;
        };
        const Doubles e1 = at(e1_), e2 = at(e2_), sum = at(sum_), inverse = Doubles(1.0) / sum;
        store(b1, i, e1 * inverse);
        store(b2, i, e2 * inverse);
        // Under perspective Σ(e·depth) is the same everywhere, and its coefficients of x and y are noise.
        const Doubles depth_sum = view_.viewport.orthographic ? at(depth_sum_) : raster::load(depth_sum_[2], i);
        store(depth, i, depth_sum * inverse);
        inside_ |= lane_bits(e1 >= zero && e2 >= zero && sum - e1 - e2 >= zero && sum > zero) << i;
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
