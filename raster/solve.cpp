#include "raster/solve.h"

#include "raster/planes.h"

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
    bool same = before != 0;
    std::int32_t low = kNoTriangle, high = 0;
    for (std::size_t i = 0; i < kStrip; i += Ints::size) {
        const Ints read = Ints::load_aligned(ids + i), filled = xsimd::select(read == none, first, read);
        same = same && xsimd::all(filled == raster::load(ids_, i));
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
    few_ = 0;
    each_ = false;
    for (std::uint32_t left = (1u << kStrip) - 1; left != 0 && !each_; left &= ~few_lanes_[few_ - 1]) {
        each_ = few_ == kFew;
        if (each_) break;
        const Ints id(ids_[static_cast<std::size_t>(std::countr_zero(left))]);
        std::uint32_t lanes = 0;
        for (std::size_t i = 0; i < kStrip; i += Ints::size) lanes |= lane_bits(raster::load(ids_, i) == id) << i;
        few_lanes_[few_++] = lanes;
    }
    if (each_) set_up_each();
}

namespace {

template <typename F> std::array<F, 3> minus(const std::array<F, 3>& a, const std::array<F, 3>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <typename F> std::array<F, 3> cross(const std::array<F, 3>& a, const std::array<F, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::array<float, 3> array(Vec3 v) { return {v.x, v.y, v.z}; }

} // namespace

const StripSolver::CachedSetUp& StripSolver::set_up_of(std::size_t i) {
    CachedSetUp& entry = cache_[id(i) % kCached];
    if (entry.id == id(i)) return entry;
    entry.id = id(i);
    const auto& vertices = (*triangles_.vertices)[triangles_.scene->objects[one_object_->object].shape];
    const auto& corners = one_mesh_->triangles[index(i)];
    std::array<double, 3> x, y, w, d;
    for (std::size_t k = 0; k < 3; ++k) {
        const PixelVertex v = pixel_vertex(*one_object_, vertices[corners[k]].p);
        x[k] = v.xw - origin_x_ * v.w;
        y[k] = v.yw - origin_y_ * v.w;
        w[k] = v.w;
        d[k] = v.depth;
    }
    const TrianglePlanes<double> planes = triangle_planes(x, y, w, d);
    entry.e1 = planes.e1;
    entry.e2 = planes.e2;
    entry.sum = planes.sum;
    entry.depth_sum = planes.depth_sum;
    const PackedVertex &a = vertices[corners[0]], &b = vertices[corners[1]], &c = vertices[corners[2]];
    entry.n = array(a.n);
    entry.n1 = array(b.n - a.n);
    entry.n2 = array(c.n - a.n);
    // Counter-clockwise in the picture, whose y points down, is the front, of an object that is not mirrored.
    const bool front = (planes.determinant < 0) != one_object_->mirrored;
    entry.ng = array(duet::cross(b.p - a.p, c.p - a.p) * (front ? 1.0f : -1.0f));
    return entry;
}

void StripSolver::set_up_each() {
    const auto& vertices = (*triangles_.vertices)[triangles_.scene->objects[one_object_->object].shape];
    std::array<std::array<std::uint32_t, 3>, kStrip> triangles;
    for (std::size_t i = 0; i < kStrip; ++i) { // all the waiting for memory at once
        triangles[i] = one_mesh_->triangles[index(i)];
        for (const std::uint32_t corner : triangles[i]) prefetch(&vertices[corner]);
    }
    std::array<std::array<StripOf<float>, 3>, 3> p, n; // corner, axis
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
            take(0, p[k]);
            take(4, n[k]);
        }
    const Mat4d& m = one_object_->to_pixel;
    const auto spread = [&](std::size_t r, std::size_t c) { return Doubles(m[r][c]); };
    const Doubles left(static_cast<double>(origin_x_)), top(static_cast<double>(origin_y_));
    std::uint32_t front = 0;
    for (std::size_t i = 0; i < kStrip; i += Doubles::size) {
        std::array<Doubles, 3> x, y, w, d;
        for (std::size_t k = 0; k < 3; ++k) {
            const Doubles px = widened(p[k][0].at(i)), py = widened(p[k][1].at(i)), pz = widened(p[k][2].at(i));
            const auto row = [&](std::size_t r) {
                return spread(r, 0) * px + spread(r, 1) * py + spread(r, 2) * pz + spread(r, 3);
            };
            d[k] = row(2);
            w[k] = view_.viewport.orthographic ? Doubles(1.0) : d[k];
            x[k] = row(0) - left * w[k];
            y[k] = row(1) - top * w[k];
        }
        const TrianglePlanes<Doubles> planes = triangle_planes(x, y, w, d);
        for (std::size_t c = 0; c < 3; ++c) {
            store(lanes_.e1[c], i, planes.e1[c]);
            store(lanes_.e2[c], i, planes.e2[c]);
            store(lanes_.sum[c], i, planes.sum[c]);
            store(lanes_.depth_sum[c], i, planes.depth_sum[c]);
        }
        front |= lane_bits(planes.determinant < Doubles(0.0)) << i;
    }
    if (one_object_->mirrored) front = ~front;
    StripOf<float> side;
    for (std::size_t i = 0; i < kStrip; ++i) side[i] = front >> i & 1 ? 1.0f : -1.0f;
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        using Axes = std::array<Floats, 3>;
        const auto at = [&](const std::array<StripOf<float>, 3>& v) {
            return Axes{raster::load(v[0], i), raster::load(v[1], i), raster::load(v[2], i)};
        };
        const Axes a = at(p[0]), na = at(n[0]), n1 = minus(at(n[1]), na), n2 = minus(at(n[2]), na);
        const Axes ng_here = cross(minus(at(p[1]), a), minus(at(p[2]), a));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            store(lanes_.n[axis], i, na[axis]);
            store(lanes_.n1[axis], i, n1[axis]);
            store(lanes_.n2[axis], i, n2[axis]);
            store(lanes_.ng[axis], i, ng_here[axis] * raster::load(side, i));
        }
    }
}

namespace {

Doubles lanes_of(double value, std::size_t) { return Doubles(value); }
Doubles lanes_of(const StripOf<double>& value, std::size_t i) { return load(value, i); }
Floats lanes_of(float value, std::size_t) { return Floats(value); }
Floats lanes_of(const StripOf<float>& value, std::size_t i) { return load(value, i); }

} // namespace

/// Barycentrics are bᵢ = eᵢ / Σe, depth is Σ(e·depth) / Σe: see Interpolation. For the lanes given; `only`: the others
/// need not be kept.
template <typename Planes>
void StripSolver::solve_lanes(const Planes& planes, Vec2d first, std::uint32_t lanes, bool only) {
    std::uint32_t inside = 0;
    StripOf<std::int32_t> chosen;
    if (!only)
        for (std::size_t i = 0; i < kStrip; i += Ints::size)
            store(chosen, i, (Ints(static_cast<std::int32_t>(lanes)) >> raster::load(kLanes, i)) & Ints(1));
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        std::array<Doubles, 2> first_b, second_b;
        for (std::size_t half = 0; half < 2; ++half) {
            const std::size_t k = i + half * Doubles::size;
            const Doubles x = Doubles(first.x) + raster::load(kColumns<double>, k),
                          y = Doubles(first.y) + raster::load(kRows<double>, k), zero(0.0);
            const auto at = [&](const auto& plane) {
                return xsimd::fma(lanes_of(plane[0], k), x, xsimd::fma(lanes_of(plane[1], k), y, lanes_of(plane[2], k)));
            };
            const Doubles e1 = at(planes.e1), e2 = at(planes.e2), sum = at(planes.sum), inverse = Doubles(1.0) / sum;
            inside |= lane_bits(e1 >= zero && e2 >= zero && sum - e1 - e2 >= zero && sum > zero) << k;
            // Under perspective Σ(e·depth) is the same everywhere, and its coefficients of x and y are noise.
            const Doubles depth_sum =
                view_.viewport.orthographic ? at(planes.depth_sum) : lanes_of(planes.depth_sum[2], k);
            first_b[half] = e1 * inverse;
            second_b[half] = e2 * inverse;
            const Doubles depth_here = depth_sum * inverse;
            if (only) {
                store(b1, k, first_b[half]);
                store(b2, k, second_b[half]);
                store(depth, k, depth_here);
            } else {
                const auto mask = widened(chosen.at(k)) > zero;
                store(b1, k, xsimd::select(mask, first_b[half], raster::load(b1, k)));
                store(b2, k, xsimd::select(mask, second_b[half], raster::load(b2, k)));
                store(depth, k, xsimd::select(mask, depth_here, raster::load(depth, k)));
            }
        }
        const Floats u = narrowed(first_b[0], first_b[1]), v = narrowed(second_b[0], second_b[1]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Floats n = xsimd::fma(lanes_of(planes.n1[axis], i), u,
                                        xsimd::fma(lanes_of(planes.n2[axis], i), v, lanes_of(planes.n[axis], i)));
            const Floats g = lanes_of(planes.ng[axis], i);
            if (only) {
                store(normal[axis], i, n);
                store(ng[axis], i, g);
            } else {
                const auto mask = xsimd::bool_cast(raster::load(chosen, i) != Ints(0));
                store(normal[axis], i, xsimd::select(mask, n, raster::load(normal[axis], i)));
                store(ng[axis], i, xsimd::select(mask, g, raster::load(ng[axis], i)));
            }
        }
    }
    inside_ |= inside & lanes;
}

void StripSolver::solve(int x, int y, SampleOffset offset) {
    inside_ = 0;
    if (on_mesh_ == 0) return;
    const Vec2d first = offset.position(x - origin_x_, y - origin_y_);
    if (each_)
        solve_lanes(lanes_, first, ~0u, true);
    else
        for (std::size_t k = 0; k < few_; ++k)
            solve_lanes(set_up_of(static_cast<std::size_t>(std::countr_zero(few_lanes_[k]))), first, few_lanes_[k],
                        k == 0);
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
