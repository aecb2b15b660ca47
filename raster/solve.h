// Where on its triangle each of sixteen samples lies, side by side: barycentrics, depth, and a shader's varyings.
#pragma once

#include "raster/planes.h"
#include "raster/shader.h"
#include "raster/strip_samples.h"

#include <bit>
#include <optional>

namespace duet::raster {

/// Solves for the samples that see a mesh's triangle; S's vertex function is asked for what is interpolated.
template <VertexShader S> class StripSolver : public StripSamples {
public:
    /// Pixels are counted from the tile's corner.
    StripSolver(const Triangles& triangles, const PassView& view, const PixelRect& tile, const S& shader)
        : StripSamples(triangles), view_(view), shader_(shader), origin_x_(tile.x0), origin_y_(tile.y0) {}

    /// Finds the numbers below for the samples loaded, which are those of `place`.
    void solve(const StripPlace& place);
    /// The same, with those solutions mended that do not hold as they are: see inside().
    void solve_all(const StripPlace& place);

    /// After solve(): a bit for each sample that lies in the unsnapped triangle, where the solution holds as it is.
    std::uint32_t inside() const { return inside_; }
    const ObjectView& object() const { return *object_; }

    static constexpr std::size_t kCount = kVaryings<S>;
    static constexpr bool kDerivatives = wants_derivatives<S>();
    std::array<StripOf<float>, kCount> at;                           ///< varyings
    std::array<StripOf<float>, kDerivatives ? kCount : 0> dx, dy;    ///< and their derivatives by the sample's place
    std::array<StripOf<float>, 3> ng; ///< VertexInput::ng
    StripOf<double> b1, b2;           ///< barycentrics of the second and third corner
    StripOf<double> depth;            ///< camera-space −z

private:
    /// What follows from one triangle, for all its samples; D and F are numbers, or strips of them, a triangle each.
    /// Planes are the coefficients of x, y and 1, all with the sign that is positive inside: Interpolation's e[1] and
    /// e[2], the sum of its three, and Σ(e·depth).
    template <typename D, typename F> struct SetUp {
        std::array<D, 3> e1, e2, sum, depth_sum;
        std::array<F, kCount> n, n1, n2; ///< the first corner's varyings, and their changes along the barycentrics
        std::array<F, 3> ng;
    };
    struct CachedSetUp : SetUp<double, float> {
        std::uint32_t id = kNoTriangle;
    };

    const CachedSetUp& set_up_of(std::size_t i);
    void set_up_each();
    void gather_vertices(std::array<std::array<StripOf<float>, 8>, 3>& corners);
    std::uint32_t set_up_planes(const std::array<std::array<StripOf<float>, 8>, 3>& corners);
    template <typename T, typename ToSetUp>
    void set_up_varyings(const std::array<Vec3T<T>, 3>& p, const std::array<Vec3T<T>, 3>& n,
                         const std::array<Vec2T<T>, 3>& uv, T side, const ToSetUp& keep) const;
    template <typename Planes, typename Positions>
    void solve_lanes(const Planes& planes, const Positions& positions, std::uint32_t lanes, bool only);
    template <typename Positions> void solve_at(const Positions& positions);

    const PassView& view_;
    const S& shader_;
    std::optional<ObjectView> object_;
    std::uint32_t inside_ = 0;
    int origin_x_, origin_y_;
    SetUp<StripOf<double>, StripOf<float>> lanes_; ///< of many triangles
    static constexpr std::size_t kCached = 64;
    std::array<CachedSetUp, kCached> cache_; ///< by id; the next strip sees much the same triangles
};

/// What has nothing to interpolate: for who wants barycentrics and depths alone.
struct NoVaryings {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> struct Varyings {};
    template <typename T> Varyings<T> vertex(const VertexInput<T>&) const { return {}; }
};
/// What interpolates the vertices' normals alone.
struct NormalVaryings {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> struct Varyings {
        Vec3T<T> n;
    };
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const { return {v.n}; }
};

namespace strips {

inline Doubles lanes_of(double value, std::size_t) { return Doubles(value); }
inline Doubles lanes_of(const StripOf<double>& value, std::size_t i) { return load(value, i); }
inline Floats lanes_of(float value, std::size_t) { return Floats(value); }
inline Floats lanes_of(const StripOf<float>& value, std::size_t i) { return load(value, i); }

template <typename Strips> Vec3T<Floats> vector(const Strips& v, std::size_t first, std::size_t i) {
    return {load(v[first], i), load(v[first + 1], i), load(v[first + 2], i)};
}

/// Where samples lie, from the tile's corner: on a grid, or each at its own place.
struct OnGrid {
    Vec2d first;
    Doubles x(std::size_t i) const { return Doubles(first.x) + load(kColumns<double>, i); }
    Doubles y(std::size_t i) const { return Doubles(first.y) + load(kRows<double>, i); }
};
struct Scattered {
    StripOf<double> xs, ys;
    Doubles x(std::size_t i) const { return load(xs, i); }
    Doubles y(std::size_t i) const { return load(ys, i); }
};

} // namespace strips

/// The vertex function's numbers at three corners: keep(k, first corner's, change along b1, along b2), and the normal.
template <VertexShader S>
template <typename T, typename ToSetUp>
void StripSolver<S>::set_up_varyings(const std::array<Vec3T<T>, 3>& p, const std::array<Vec3T<T>, 3>& n,
                                     const std::array<Vec2T<T>, 3>& uv, T side, const ToSetUp& keep) const {
    const Vec3T<T> ng_here = cross(p[1] - p[0], p[2] - p[0]) * side;
    const Vec3T<T> middle = (p[0] + p[1] + p[2]) * T(1.0f / 3);
    std::array<std::array<T, kCount>, 3> v;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3T<T> edges(T(k == 0 ? 1 : 0), T(k == 1 ? 1 : 0), T(k == 2 ? 1 : 0));
        v[k] = numbers<S, T>(shader_.vertex(VertexInput<T>{p[k], n[k], uv[k], ng_here, middle, edges, *object_}));
    }
    for (std::size_t c = 0; c < kCount; ++c) keep(c, v[0][c], v[1][c] - v[0][c], v[2][c] - v[0][c]);
    keep.normal(ng_here);
}

template <VertexShader S> const typename StripSolver<S>::CachedSetUp& StripSolver<S>::set_up_of(std::size_t i) {
    CachedSetUp& entry = cache_[id(i) % kCached];
    if (entry.id == id(i)) return entry;
    entry.id = id(i);
    const auto& vertices = (*triangles_.vertices)[triangles_.scene->objects[one_object()->object].shape];
    const auto& corners = one_mesh()->triangles[index(i)];
    std::array<double, 3> x, y, w, d;
    std::array<Vec3, 3> p, n;
    std::array<Vec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
        const PackedVertex& packed = vertices[corners[k]];
        const PixelVertex v = pixel_vertex(*one_object(), packed.p);
        x[k] = v.xw - origin_x_ * v.w;
        y[k] = v.yw - origin_y_ * v.w;
        w[k] = v.w;
        d[k] = v.depth;
        p[k] = packed.p, n[k] = packed.n, uv[k] = {packed.u, packed.v};
    }
    const TrianglePlanes<double> planes = triangle_planes(x, y, w, d);
    entry.e1 = planes.e1;
    entry.e2 = planes.e2;
    entry.sum = planes.sum;
    entry.depth_sum = planes.depth_sum;
    // Counter-clockwise in the picture, whose y points down, is the front, of an object that is not mirrored.
    const bool front = (planes.determinant < 0) != one_object()->mirrored;
    struct Keep {
        CachedSetUp& entry;
        void operator()(std::size_t c, float first, float along_1, float along_2) const {
            entry.n[c] = first, entry.n1[c] = along_1, entry.n2[c] = along_2;
        }
        void normal(Vec3 v) const { entry.ng = {v.x, v.y, v.z}; }
    };
    set_up_varyings(p, n, uv, front ? 1.0f : -1.0f, Keep{entry});
    return entry;
}

/// Of each of three corners eight numbers: position and u, normal and v.
template <VertexShader S>
void StripSolver<S>::gather_vertices(std::array<std::array<StripOf<float>, 8>, 3>& corners) {
    const auto& vertices = (*triangles_.vertices)[triangles_.scene->objects[one_object()->object].shape];
    std::array<std::array<std::uint32_t, 3>, kStrip> triangles;
    for (std::size_t i = 0; i < kStrip; ++i) { // all the waiting for memory at once
        triangles[i] = one_mesh()->triangles[index(i)];
        for (const std::uint32_t corner : triangles[i]) prefetch(&vertices[corner]);
    }
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < kStrip; i += Quads::size)
            for (std::size_t first = 0; first < 8; first += 4) { // number of four in the vertex
                const auto from = [&](std::size_t lane) {
                    return Quads::load_aligned(&vertices[triangles[i + lane][k]].p.x + first);
                };
                const Transposed four = transposed(from(0), from(1), from(2), from(3));
                four.x.store_aligned(corners[k][first].at(i));
                four.y.store_aligned(corners[k][first + 1].at(i));
                four.z.store_aligned(corners[k][first + 2].at(i));
                if constexpr (wants_texture_coordinates<S>()) four.w.store_aligned(corners[k][first + 3].at(i));
            }
}

/// Returns a bit for each triangle that runs counter-clockwise in the picture.
template <VertexShader S>
std::uint32_t StripSolver<S>::set_up_planes(const std::array<std::array<StripOf<float>, 8>, 3>& corners) {
    const Mat4d& m = one_object()->to_pixel;
    const auto entry = [&](std::size_t r, std::size_t c) { return Doubles(m[r][c]); };
    const Doubles left(static_cast<double>(origin_x_)), top(static_cast<double>(origin_y_));
    std::uint32_t front = 0;
    for (std::size_t i = 0; i < kStrip; i += Doubles::size) {
        std::array<Doubles, 3> x, y, w, d;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& p = corners[k];
            const Doubles px = widened(p[0].at(i)), py = widened(p[1].at(i)), pz = widened(p[2].at(i));
            const auto row = [&](std::size_t r) {
                return entry(r, 0) * px + entry(r, 1) * py + entry(r, 2) * pz + entry(r, 3);
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
    return front;
}

template <VertexShader S> void StripSolver<S>::set_up_each() {
    std::array<std::array<StripOf<float>, 8>, 3> corners;
    gather_vertices(corners);
    std::uint32_t front = set_up_planes(corners);
    if (one_object()->mirrored) front = ~front;
    StripOf<float> side;
    for (std::size_t i = 0; i < kStrip; ++i) side[i] = front >> i & 1 ? 1.0f : -1.0f;
    struct Keep {
        SetUp<StripOf<double>, StripOf<float>>& lanes;
        std::size_t i;
        void operator()(std::size_t c, Floats first, Floats along_1, Floats along_2) const {
            store(lanes.n[c], i, first);
            store(lanes.n1[c], i, along_1);
            store(lanes.n2[c], i, along_2);
        }
        void normal(Vec3T<Floats> v) const {
            store(lanes.ng[0], i, v.x);
            store(lanes.ng[1], i, v.y);
            store(lanes.ng[2], i, v.z);
        }
    };
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        std::array<Vec3T<Floats>, 3> p, n;
        std::array<Vec2T<Floats>, 3> uv;
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = strips::vector(corners[k], 0, i);
            n[k] = strips::vector(corners[k], 4, i);
            if constexpr (wants_texture_coordinates<S>())
                uv[k] = {raster::load(corners[k][3], i), raster::load(corners[k][7], i)};
            else
                uv[k] = {Floats(0.0f), Floats(0.0f)};
        }
        set_up_varyings(p, n, uv, raster::load(side, i), Keep{lanes_, i});
    }
}

/// Barycentrics are bᵢ = eᵢ / Σe, depth is Σ(e·depth) / Σe: see Interpolation. The derivative of such a quotient by x is
/// (eᵢ' − bᵢ·(Σe)') / Σe. For the lanes given; `only`: the others need not be kept.
template <VertexShader S>
template <typename Planes, typename Positions>
void StripSolver<S>::solve_lanes(const Planes& planes, const Positions& positions, std::uint32_t lanes, bool only) {
    using strips::lanes_of;
    std::uint32_t inside = 0;
    StripOf<std::int32_t> chosen;
    if (!only)
        for (std::size_t i = 0; i < kStrip; i += Ints::size)
            store(chosen, i, (Ints(static_cast<std::int32_t>(lanes)) >> raster::load(kLanes, i)) & Ints(1));
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        std::array<Doubles, 2> first_b, second_b, d1_dx, d1_dy, d2_dx, d2_dy;
        for (std::size_t half = 0; half < 2; ++half) {
            const std::size_t k = i + half * Doubles::size;
            const Doubles x = positions.x(k), y = positions.y(k), zero(0.0);
            const auto value = [&](const auto& plane) {
                return xsimd::fma(lanes_of(plane[0], k), x, xsimd::fma(lanes_of(plane[1], k), y, lanes_of(plane[2], k)));
            };
            const Doubles e1 = value(planes.e1), e2 = value(planes.e2), sum = value(planes.sum), inverse = Doubles(1.0) / sum;
            inside |= lane_bits(e1 >= zero && e2 >= zero && sum - e1 - e2 >= zero && sum > zero) << k;
            // Under perspective Σ(e·depth) is the same everywhere, and its coefficients of x and y are noise.
            const Doubles depth_sum =
                view_.viewport.orthographic ? value(planes.depth_sum) : lanes_of(planes.depth_sum[2], k);
            first_b[half] = e1 * inverse;
            second_b[half] = e2 * inverse;
            if constexpr (kDerivatives) {
                const auto along = [&](const auto& plane, const Doubles& b, std::size_t axis) {
                    return (lanes_of(plane[axis], k) - b * lanes_of(planes.sum[axis], k)) * inverse;
                };
                d1_dx[half] = along(planes.e1, first_b[half], 0);
                d1_dy[half] = along(planes.e1, first_b[half], 1);
                d2_dx[half] = along(planes.e2, second_b[half], 0);
                d2_dy[half] = along(planes.e2, second_b[half], 1);
            }
            const Doubles depth_here = depth_sum * inverse;
            if (only) {
                store(b1, k, first_b[half]);
                store(b2, k, second_b[half]);
                store(depth, k, depth_here);
            } else {
                const auto here = widened(chosen.at(k)) > zero;
                store(b1, k, xsimd::select(here, first_b[half], raster::load(b1, k)));
                store(b2, k, xsimd::select(here, second_b[half], raster::load(b2, k)));
                store(depth, k, xsimd::select(here, depth_here, raster::load(depth, k)));
            }
        }
        const auto mask = xsimd::bool_cast(raster::load(chosen, i) != Ints(0));
        const auto keep = [&](StripOf<float>& to, const Floats& v) {
            store(to, i, only ? v : xsimd::select(mask, v, raster::load(to, i)));
        };
        const Floats u = narrowed(first_b[0], first_b[1]), v = narrowed(second_b[0], second_b[1]);
        for (std::size_t c = 0; c < kCount; ++c)
            keep(at[c], xsimd::fma(lanes_of(planes.n1[c], i), u,
                                   xsimd::fma(lanes_of(planes.n2[c], i), v, lanes_of(planes.n[c], i))));
        for (std::size_t axis = 0; axis < 3; ++axis) keep(ng[axis], lanes_of(planes.ng[axis], i));
        if constexpr (kDerivatives) {
            const Floats u_dx = narrowed(d1_dx[0], d1_dx[1]), v_dx = narrowed(d2_dx[0], d2_dx[1]);
            const Floats u_dy = narrowed(d1_dy[0], d1_dy[1]), v_dy = narrowed(d2_dy[0], d2_dy[1]);
            for (std::size_t c = 0; c < kCount; ++c) {
                keep(dx[c], lanes_of(planes.n1[c], i) * u_dx + lanes_of(planes.n2[c], i) * v_dx);
                keep(dy[c], lanes_of(planes.n1[c], i) * u_dy + lanes_of(planes.n2[c], i) * v_dy);
            }
        }
    }
    inside_ |= inside & lanes;
}

template <VertexShader S> template <typename Positions> void StripSolver<S>::solve_at(const Positions& positions) {
    if (each_)
        solve_lanes(lanes_, positions, ~0u, true);
    else
        for (std::size_t k = 0; k < few_; ++k)
            solve_lanes(set_up_of(static_cast<std::size_t>(std::countr_zero(few_lanes_[k]))), positions, few_lanes_[k],
                        k == 0);
}

template <VertexShader S> void StripSolver<S>::solve(const StripPlace& place) {
    inside_ = 0;
    if (on_mesh() == 0) return;
    if (!object_ || object_->object != one_object()->object) object_.emplace(*triangles_.prepared, view_, one_object()->object);
    if (each_ && changed_) set_up_each();
    changed_ = false;
    if (place.offsets == nullptr) {
        solve_at(strips::OnGrid{place.offset.position(place.x - origin_x_, place.y - origin_y_)});
    } else {
        strips::Scattered positions;
        for (std::size_t i = 0; i < kStrip; ++i) {
            const Vec2d p = place.position(i);
            positions.xs[i] = p.x - origin_x_;
            positions.ys[i] = p.y - origin_y_;
        }
        solve_at(positions);
    }
    inside_ &= sabotaged(Guard::kPerspective) ? 0 : on_mesh();
}

template <VertexShader S> void StripSolver<S>::solve_all(const StripPlace& place) {
    solve(place);
    for (std::uint32_t left = on_mesh() & ~inside_; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        const WholeTriangle whole = triangles_.whole(run(i), Triangles::index(run(i), id(i)));
        const Interpolated here = interpolate(whole, place.position(i));
        b1[i] = here.b1 / here.sum;
        b2[i] = here.b2 / here.sum;
        depth[i] = here.depth_sum / here.sum;
        const auto u = static_cast<float>(b1[i]), v = static_cast<float>(b2[i]);
        const CachedSetUp* few = each_ ? nullptr : &set_up_of(i);
        for (std::size_t c = 0; c < kCount; ++c)
            at[c][i] = few != nullptr ? few->n[c] + few->n1[c] * u + few->n2[c] * v
                                      : lanes_.n[c][i] + lanes_.n1[c][i] * u + lanes_.n2[c][i] * v;
    }
}

} // namespace duet::raster
