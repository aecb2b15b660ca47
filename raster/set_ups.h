// What follows from a triangle for all the samples of a tile that see it: worked out sixteen triangles side by side, and
// kept, for strips beside each other see much the same triangles.
#pragma once

#include "raster/planes.h"
#include "raster/shader.h"
#include "raster/triangles.h"

#include <array>
#include <bit>
#include <map>
#include <vector>

namespace duet::raster {

/// D and F are numbers, or strips of them, a triangle each. Planes are the coefficients of x, y and 1, pixels counted from
/// the tile's corner, all with the sign that is positive inside: Interpolation's e[1] and e[2], the sum of its three, and
/// Σ(e·depth).
template <VertexShader S, typename D, typename F> struct SetUp {
    std::array<D, 3> e1, e2, sum, depth_sum;
    std::array<F, kVaryings<S>> n, n1, n2; ///< the first corner's varyings, and their changes along the barycentrics
    std::array<F, 3> ng;                   ///< VertexInput::ng
};

/// Set-ups of meshes' triangles under one view of a tile; S's vertex function is asked for what is interpolated.
template <VertexShader S> class SetUps {
public:
    using One = SetUp<S, double, float>;
    using Many = SetUp<S, StripOf<double>, StripOf<float>>;

    SetUps(const Triangles& triangles, const PassView& view, const PixelRect& tile, const S& shader)
        : triangles_(triangles), view_(view), shader_(shader), origin_x_(tile.x0), origin_y_(tile.y0) {}

    /// The object whose triangles are asked for from now on; its first triangle's number.
    void use(const TransformedObject& object, const Mesh& mesh, std::size_t first_id);
    /// The object in use; stays where it is.
    const ObjectView& object() const { return *view_of_object_; }

    /// Of sixteen triangles at once, by number; until the next call of anything.
    const Many& set_up(const StripOf<std::int32_t>& ids);

    /// Sees to it that there is room to keep so many more: 1 to kRoom. All kept may be forgotten.
    void make_room(std::size_t count);
    static constexpr std::size_t kRoom = 512;
    /// Where a triangle's is kept, which may be made by finish() only; where there is room.
    std::uint32_t keep(std::uint32_t id);
    void finish();
    const One& kept(std::uint32_t place) const { return kept_[place]; }

private:
    using Corners = std::array<std::array<StripOf<float>, 8>, 3>;
    void gather_vertices(const StripOf<std::int32_t>& ids, Corners& corners) const;
    std::uint32_t set_up_planes(const Corners& corners);
    template <typename T, typename Keep>
    void set_up_varyings(const std::array<Vec3T<T>, 3>& p, const std::array<Vec3T<T>, 3>& n, const std::array<Vec2T<T>, 3>& uv,
                         T side, const Keep& keep) const;

    const Triangles& triangles_;
    const PassView& view_;
    const S& shader_;
    int origin_x_, origin_y_;
    const TransformedObject* object_ = nullptr;
    const Mesh* mesh_ = nullptr;
    std::size_t first_id_ = 0;
    const ObjectView* view_of_object_ = nullptr;
    std::map<std::uint32_t, ObjectView> views_of_objects_;
    Many many_;

    static constexpr std::size_t kPlaces = 2 * kRoom; ///< at most half of which are taken
    static std::size_t first_place(std::uint32_t id) { return id * 0x9e3779b1u >> (32 - std::countr_zero(kPlaces)); }
    struct Place {
        std::uint32_t id = kNoTriangle, kept = 0;
    };
    std::array<Place, kPlaces> places_; ///< by number, or at the next free one after
    std::vector<One> kept_;
    StripOf<std::int32_t> wanted_; ///< to be kept next
    std::size_t wanted_count_ = 0;
};

template <VertexShader S> void SetUps<S>::use(const TransformedObject& object, const Mesh& mesh, std::size_t first_id) {
    if (object_ == &object) return;
    finish();
    object_ = &object;
    mesh_ = &mesh;
    first_id_ = first_id;
    view_of_object_ = &views_of_objects_.try_emplace(object.object, *triangles_.prepared, view_, object.object).first->second;
}

template <VertexShader S> void SetUps<S>::make_room(std::size_t count) {
    if (kept_.size() + count <= kRoom) return;
    kept_.clear();
    places_.fill({});
}

template <VertexShader S> std::uint32_t SetUps<S>::keep(std::uint32_t id) {
    std::size_t at = first_place(id);
    while (places_[at].id != id && places_[at].id != kNoTriangle) at = (at + 1) % kPlaces;
    if (places_[at].id == id) return places_[at].kept;
    const auto kept = static_cast<std::uint32_t>(kept_.size() + wanted_count_);
    places_[at] = {id, kept};
    wanted_[wanted_count_] = static_cast<std::int32_t>(id);
    if (++wanted_count_ == kStrip) finish();
    return kept;
}

/// The vertex function's numbers at three corners: keep(k, first corner's, change along b1, along b2), and the normal.
template <VertexShader S>
template <typename T, typename Keep>
void SetUps<S>::set_up_varyings(const std::array<Vec3T<T>, 3>& p, const std::array<Vec3T<T>, 3>& n,
                                const std::array<Vec2T<T>, 3>& uv, T side, const Keep& keep) const {
    const Vec3T<T> ng_here = cross(p[1] - p[0], p[2] - p[0]) * side;
    const Vec3T<T> middle = (p[0] + p[1] + p[2]) * T(1.0f / 3);
    std::array<std::array<T, kVaryings<S>>, 3> v;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3T<T> edges(T(k == 0 ? 1 : 0), T(k == 1 ? 1 : 0), T(k == 2 ? 1 : 0));
        v[k] = numbers<S, T>(shader_.vertex(VertexInput<T>{p[k], n[k], uv[k], ng_here, middle, edges, *view_of_object_}));
    }
    for (std::size_t c = 0; c < kVaryings<S>; ++c) keep(c, v[0][c], v[1][c] - v[0][c], v[2][c] - v[0][c]);
    keep.normal(ng_here);
}

/// Of each of three corners eight numbers: position and u, normal and v.
template <VertexShader S>
void SetUps<S>::gather_vertices(const StripOf<std::int32_t>& ids, Corners& corners) const {
    const auto& vertices = (*triangles_.vertices)[triangles_.scene->objects[object_->object].shape];
    std::array<std::array<std::uint32_t, 3>, kStrip> triangles;
    for (std::size_t i = 0; i < kStrip; ++i) { // all the waiting for memory at once
        triangles[i] = mesh_->triangles[static_cast<std::size_t>(ids[i]) - first_id_];
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
template <VertexShader S> std::uint32_t SetUps<S>::set_up_planes(const Corners& corners) {
    const Mat4d& m = object_->to_pixel;
    const auto entry = [&](std::size_t r, std::size_t c) { return Doubles(m[r][c]); };
    const Doubles left(static_cast<double>(origin_x_)), top(static_cast<double>(origin_y_));
    std::uint32_t front = 0;
    for (std::size_t i = 0; i < kStrip; i += Doubles::size) {
        std::array<Doubles, 3> x, y, w, d;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& p = corners[k];
            const Doubles px = load_doubles(p[0].at(i)), py = load_doubles(p[1].at(i)), pz = load_doubles(p[2].at(i));
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
            store(many_.e1[c], i, planes.e1[c]);
            store(many_.e2[c], i, planes.e2[c]);
            store(many_.sum[c], i, planes.sum[c]);
            store(many_.depth_sum[c], i, planes.depth_sum[c]);
        }
        front |= lane_bits(planes.determinant < Doubles(0.0)) << i;
    }
    return front;
}

template <VertexShader S> const typename SetUps<S>::Many& SetUps<S>::set_up(const StripOf<std::int32_t>& ids) {
    Corners corners;
    gather_vertices(ids, corners);
    // Counter-clockwise in the picture, whose y points down, is the front, of an object that is not mirrored.
    std::uint32_t front = set_up_planes(corners);
    if (object_->mirrored) front = ~front;
    struct Keep {
        Many& many;
        std::size_t i;
        void operator()(std::size_t c, Floats first, Floats along_1, Floats along_2) const {
            store(many.n[c], i, first);
            store(many.n1[c], i, along_1);
            store(many.n2[c], i, along_2);
        }
        void normal(Vec3T<Floats> v) const {
            store(many.ng[0], i, v.x);
            store(many.ng[1], i, v.y);
            store(many.ng[2], i, v.z);
        }
    };
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        std::array<Vec3T<Floats>, 3> p, n;
        std::array<Vec2T<Floats>, 3> uv;
        const auto vector = [&](std::size_t k, std::size_t first) {
            return Vec3T<Floats>{load(corners[k][first], i), load(corners[k][first + 1], i), load(corners[k][first + 2], i)};
        };
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = vector(k, 0);
            n[k] = vector(k, 4);
            if constexpr (wants_texture_coordinates<S>())
                uv[k] = {load(corners[k][3], i), load(corners[k][7], i)};
            else
                uv[k] = {Floats(0.0f), Floats(0.0f)};
        }
        const Floats side = xsimd::select(lanes_from<float>(front >> i), Floats(1.0f), Floats(-1.0f));
        set_up_varyings(p, n, uv, side, Keep{many_, i});
    }
    return many_;
}

template <VertexShader S> void SetUps<S>::finish() {
    if (wanted_count_ == 0) return;
    for (std::size_t i = wanted_count_; i < kStrip; ++i) wanted_[i] = wanted_[0];
    set_up(wanted_);
    const auto pick = [](auto& to, const auto& from, std::size_t i) {
        for (std::size_t c = 0; c < to.size(); ++c) to[c] = from[c][i];
    };
    for (std::size_t i = 0; i < wanted_count_; ++i) {
        One& one = kept_.emplace_back();
        pick(one.e1, many_.e1, i);
        pick(one.e2, many_.e2, i);
        pick(one.sum, many_.sum, i);
        pick(one.depth_sum, many_.depth_sum, i);
        pick(one.n, many_.n, i);
        pick(one.n1, many_.n1, i);
        pick(one.n2, many_.n2, i);
        pick(one.ng, many_.ng, i);
    }
    wanted_count_ = 0;
}

} // namespace duet::raster
