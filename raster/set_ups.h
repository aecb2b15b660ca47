// What follows from a triangle for all the samples of a tile that see it: worked out sixteen triangles side by side, and
// kept so, for strips beside each other see much the same triangles.
#pragma once

#include "raster/planes.h"
#include "raster/shader.h"
#include "raster/triangles.h"

#include <array>
#include <bit>
#include <map>
#include <vector>

namespace duet::raster {

/// Of sixteen triangles. Planes are the coefficients of x, y and 1, all with the sign that is positive inside: Interpolation's
/// e[1] and e[2], the sum of its three, and Σ(e·depth). They are of D, float or double: pixels are counted from an origin
/// beside the triangle's first corner, so that what cancels is of the triangle's size.
template <VertexShader S, typename D> struct SetUp {
    using Plane = std::array<StripOf<D>, 3>;
    using Numbers = std::array<StripOf<float>, kVaryings<S>>;

    StripOf<D> x, y; ///< the origin, counted from the tile's corner: a pixel of the tile
    Plane e1, e2, sum, depth_sum;
    StripOf<D> steepest, greatest; ///< of e1, e2 and sum: no |coefficient| of x and y, and none of 1, is more
    Numbers n, n1, n2;             ///< the first corner's varyings, and their changes along the barycentrics
    std::array<StripOf<float>, 3> ng; ///< VertexInput::ng
};

/// Set-ups of meshes' triangles under one view of a tile; S's vertex function is asked for what is interpolated.
template <VertexShader S, typename D> class SetUps {
public:
    using Sixteen = SetUp<S, D>;

    SetUps(const Triangles& triangles, const PassView& view, const PixelRect& tile, const S& shader)
        : triangles_(triangles), view_(view), shader_(shader), origin_x_(tile.x0), origin_y_(tile.y0) {
        kept_.reserve(kRoom / kStrip);
        for (Recent& half : recent_) half.ids.fill(kNoTriangle);
    }

    /// The object whose triangles are asked for from now on; its first triangle's number.
    void use(const TransformedObject& object, const Mesh& mesh, std::size_t first_id);
    /// The object in use; stays where it is.
    const ObjectView& object() const { return *view_of_object_; }

    /// Whether a strip's triangles can still be kept.
    bool has_room() const { return count_ + 2 * kStrip <= kRoom; }
    void forget();
    /// Of each sample's triangle where its set-up is kept, which may be made by finish() only; where there is room.
    void keep(const StripOf<std::int32_t>& ids, StripOf<std::int32_t>& kept);
    void finish();
    /// Those kept from place 16·i on.
    const Sixteen& sixteen(std::size_t i) const { return kept_[i]; }

private:
    std::uint32_t find_or_keep(std::uint32_t id);
    void keep_each(const StripOf<std::int32_t>& ids, StripOf<std::int32_t>& kept);
    void begin_sixteen();
    using Corners = std::array<std::array<StripOf<float>, 8>, 3>;
    void gather_vertices(Corners& corners) const;
    std::uint32_t set_up_planes(const Corners& corners, Sixteen& to) const;
    void set_up_varyings(std::size_t i, const Corners& corners, Floats side, Sixteen& to) const;

    const Triangles& triangles_;
    const PassView& view_;
    const S& shader_;
    int origin_x_, origin_y_;
    const TransformedObject* object_ = nullptr;
    const Mesh* mesh_ = nullptr;
    std::size_t first_id_ = 0;
    const ObjectView* view_of_object_ = nullptr;
    std::map<std::uint32_t, ObjectView> views_of_objects_;

    static constexpr std::size_t kRoom = 512, kPlaces = 2 * kRoom; ///< at most half of which are taken
    static std::size_t first_place(std::uint32_t id) { return id * 0x9e3779b1u >> (32 - std::countr_zero(kPlaces)); }
    struct Place {
        std::uint32_t id = kNoTriangle, kept = 0;
    };
    std::array<Place, kPlaces> places_; ///< by number, or at the next free one after
    /// The last that were asked for, by the lower five bits of their numbers: sixteen samples are looked up side by side.
    struct Recent {
        StripOf<std::int32_t> ids, kept;
    };
    std::array<Recent, 2> recent_;
    std::vector<Sixteen> kept_;
    std::size_t count_ = 0;        ///< kept, or wanted to be
    bool finished_ = true;
    StripOf<std::int32_t> wanted_; ///< numbers of the last sixteen
};

template <VertexShader S, typename D>
void SetUps<S, D>::use(const TransformedObject& object, const Mesh& mesh, std::size_t first_id) {
    if (object_ == &object) return;
    begin_sixteen(); // each are of one object
    object_ = &object;
    mesh_ = &mesh;
    first_id_ = first_id;
    view_of_object_ = &views_of_objects_.try_emplace(object.object, *triangles_.prepared, view_, object.object).first->second;
}

template <VertexShader S, typename D> void SetUps<S, D>::forget() {
    count_ = 0;
    finished_ = true;
    places_.fill({});
    for (Recent& half : recent_) half.ids.fill(kNoTriangle);
}

template <VertexShader S, typename D>
void SetUps<S, D>::keep(const StripOf<std::int32_t>& ids, StripOf<std::int32_t>& kept) {
    std::uint32_t found = 0;
    for (std::size_t i = 0; i < kStrip; i += Ints::size) {
        const Ints id = load(ids, i);
        const auto first = (id & Ints(kStrip)) == Ints(0);
        const auto of_half = [&](StripOf<std::int32_t> Recent::*which) {
            return xsimd::select(first, look_up(recent_[0].*which, id), look_up(recent_[1].*which, id));
        };
        found |= lane_bits(of_half(&Recent::ids) == id) << i;
        store(kept, i, of_half(&Recent::kept));
    }
    std::uint32_t left = ((1u << kStrip) - 1) & ~found;
    constexpr int kMany = 8; // new ones: cheaper all at once than one by one
    if (left != 0 && std::popcount(first_of_each(ids) & left) > kMany) return keep_each(ids, kept);
    while (left != 0) {
        const std::int32_t id = ids[static_cast<std::size_t>(std::countr_zero(left))];
        const auto place = static_cast<std::int32_t>(find_or_keep(static_cast<std::uint32_t>(id)));
        left &= ~lanes_of_number(ids, id);
        for (std::size_t i = 0; i < kStrip; i += Ints::size)
            store(kept, i, xsimd::select(load(ids, i) == Ints(id), Ints(place), load(kept, i)));
        const auto at = static_cast<std::size_t>(id) % (2 * kStrip);
        recent_[at / kStrip].ids[at % kStrip] = id;
        recent_[at / kStrip].kept[at % kStrip] = place;
    }
}

/// Sixteen of them as they are, and never found again.
template <VertexShader S, typename D>
void SetUps<S, D>::keep_each(const StripOf<std::int32_t>& ids, StripOf<std::int32_t>& kept) {
    begin_sixteen();
    for (std::size_t i = 0; i < kStrip; i += Ints::size) store(kept, i, Ints(static_cast<std::int32_t>(count_)) + load(kLanes, i));
    wanted_ = ids;
    count_ += kStrip;
    finished_ = false;
    finish();
}

template <VertexShader S, typename D> void SetUps<S, D>::begin_sixteen() {
    finish();
    count_ = (count_ + kStrip - 1) / kStrip * kStrip;
}

template <VertexShader S, typename D> std::uint32_t SetUps<S, D>::find_or_keep(std::uint32_t id) {
    std::size_t at = first_place(id);
    while (places_[at].id != id && places_[at].id != kNoTriangle) at = (at + 1) % kPlaces;
    if (places_[at].id == id) return places_[at].kept;
    const std::size_t kept = count_++;
    places_[at] = {id, static_cast<std::uint32_t>(kept)};
    if (kept % kStrip == 0) wanted_.fill(static_cast<std::int32_t>(id));
    wanted_[kept % kStrip] = static_cast<std::int32_t>(id);
    finished_ = false;
    if (count_ % kStrip == 0) finish();
    return static_cast<std::uint32_t>(kept);
}

/// The vertex function's numbers of the triangles from the i-th on, a batch of them; `side`: 1 in front, -1 behind.
template <VertexShader S, typename D>
void SetUps<S, D>::set_up_varyings(std::size_t i, const Corners& corners, Floats side, Sixteen& to) const {
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
        store(to.n[c], i, v[0][c]);
        store(to.n1[c], i, v[1][c] - v[0][c]);
        store(to.n2[c], i, v[2][c] - v[0][c]);
    }
    store(to.ng[0], i, ng.x);
    store(to.ng[1], i, ng.y);
    store(to.ng[2], i, ng.z);
}

/// Of each of three corners eight numbers: position and u, normal and v.
template <VertexShader S, typename D> void SetUps<S, D>::gather_vertices(Corners& corners) const {
    const auto& vertices = (*triangles_.vertices)[triangles_.scene->objects[object_->object].shape];
    std::array<std::array<std::uint32_t, 3>, kStrip> triangles;
    for (std::size_t i = 0; i < kStrip; ++i) { // all the waiting for memory at once
        triangles[i] = mesh_->triangles[static_cast<std::size_t>(wanted_[i]) - first_id_];
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

/// Returns a bit for each triangle that runs counter-clockwise in the picture. Worked out in doubles, whatever D is; scaled so
/// that no coefficient of e1, e2 and sum is more than 1.
template <VertexShader S, typename D>
std::uint32_t SetUps<S, D>::set_up_planes(const Corners& corners, Sixteen& to) const {
    const Mat4d& m = object_->to_pixel;
    const auto entry = [&](std::size_t r, std::size_t c) { return Doubles(m[r][c]); };
    const Doubles left(static_cast<double>(origin_x_)), top(static_cast<double>(origin_y_)), zero(0.0), size(TileGrid::kTileSize);
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
        TrianglePlanes<Doubles> planes = triangle_planes(x, y, w, d);
        front |= lane_bits(planes.determinant < zero) << i;
        const auto beside = [&](const Doubles& at) {
            return xsimd::select(w[0] > zero, xsimd::floor(min(max(at / w[0], zero), size)), zero);
        };
        const Doubles from_x = beside(x[0]), from_y = beside(y[0]);
        const auto move = [&](std::array<Doubles, 3>& plane) {
            plane[2] = fused(plane[0], from_x, fused(plane[1], from_y, plane[2]));
        };
        Doubles steepest = zero, greatest = zero;
        for (auto* plane : {&planes.e1, &planes.e2, &planes.sum}) {
            move(*plane);
            steepest = max(steepest, max(abs((*plane)[0]), abs((*plane)[1])));
            greatest = max(greatest, abs((*plane)[2]));
        }
        // Under perspective Σ(e·depth) is the same everywhere, and its coefficients of x and y are noise.
        if (view_.viewport.orthographic) move(planes.depth_sum);
        const Doubles scale = Doubles(1.0) / max(steepest, greatest);
        for (std::size_t c = 0; c < 3; ++c) {
            store_rounded(to.e1[c], i, planes.e1[c] * scale);
            store_rounded(to.e2[c], i, planes.e2[c] * scale);
            store_rounded(to.sum[c], i, planes.sum[c] * scale);
            store_rounded(to.depth_sum[c], i, planes.depth_sum[c] * scale);
        }
        store_rounded(to.x, i, from_x);
        store_rounded(to.y, i, from_y);
        store_rounded(to.steepest, i, steepest * scale);
        store_rounded(to.greatest, i, greatest * scale);
    }
    return front;
}

template <VertexShader S, typename D> void SetUps<S, D>::finish() {
    if (finished_) return;
    finished_ = true;
    const std::size_t last = (count_ - 1) / kStrip;
    if (kept_.size() == last) kept_.emplace_back();
    Sixteen& to = kept_[last];
    Corners corners;
    gather_vertices(corners);
    // Counter-clockwise in the picture, whose y points down, is the front, of an object that is not mirrored.
    std::uint32_t front = set_up_planes(corners, to);
    if (object_->mirrored) front = ~front;
    for (std::size_t i = 0; i < kStrip; i += Floats::size)
        set_up_varyings(i, corners, xsimd::select(lanes_from<float>(front >> i), Floats(1.0f), Floats(-1.0f)), to);
}

} // namespace duet::raster
