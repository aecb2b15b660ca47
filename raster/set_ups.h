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
        : triangles_(triangles), view_(view), shader_(shader), origin_x_(tile.x0), origin_y_(tile.y0) {
        kept_.reserve(kRoom);
    }

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
    void set_up_varyings(std::size_t i, const Corners& corners, Floats side);

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

/// The vertex function's numbers of the triangles from the i-th on, a batch of them; `side`: 1 in front, -1 behind.
template <VertexShader S> void SetUps<S>::set_up_varyings(std::size_t i, const Corners& corners, Floats side) {
    const auto vector = [&](std::size_t k, std::size_t first) {
        return Vec3T<Floats>{load(corners[k][first], i), load(corners[k][first + 1], i), load(corners[k][first + 2], i)};
    };
    const std::array<Vec3T<Floats>, 3> p{vector(0, 0), vector(1, 0), vector(2, 0)};
    const Vec3T<Floats> ng = cross(p[1] - p[0], p[2] - p[0]) * side, middle = (p[0] + p[1] + p[2]) * Floats(1.0f / 3);
    std::array<std::array<Floats, kVaryings<S>>, 3> v;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto edge = [k](std::size_t of) { return Floats(of == k ? 1.0f : 0.0f); };
        Vec2T<Floats> uv(Floats(0.0f), Floats(0.0f));
        if constexpr (wants_texture_coordinates<S>()) uv = {load(corners[k][3], i), load(corners[k][7], i)};
        v[k] = numbers<S, Floats>(shader_.vertex(VertexInput<Floats>{
            p[k], vector(k, 4), uv, ng, middle, {edge(0), edge(1), edge(2)}, *view_of_object_}));
    }
    for (std::size_t c = 0; c < kVaryings<S>; ++c) {
        store(many_.n[c], i, v[0][c]);
        store(many_.n1[c], i, v[1][c] - v[0][c]);
        store(many_.n2[c], i, v[2][c] - v[0][c]);
    }
    store(many_.ng[0], i, ng.x);
    store(many_.ng[1], i, ng.y);
    store(many_.ng[2], i, ng.z);
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
                const auto [x, y, z, w] = load_columns<Quads::size>(
                    [&](std::size_t lane) { return &vertices[triangles[i + lane][k]].p.x + first; });
                x.store_aligned(corners[k][first].at(i));
                y.store_aligned(corners[k][first + 1].at(i));
                z.store_aligned(corners[k][first + 2].at(i));
                if constexpr (wants_texture_coordinates<S>()) w.store_aligned(corners[k][first + 3].at(i));
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
    for (std::size_t i = 0; i < kStrip; i += Floats::size)
        set_up_varyings(i, corners, xsimd::select(lanes_from<float>(front >> i), Floats(1.0f), Floats(-1.0f)));
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
