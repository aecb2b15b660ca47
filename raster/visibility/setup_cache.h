// Implements the triangle setup cache. A setup holds the values that all samples of a tile that see a triangle share.
// Setups are computed for sixteen triangles at a time with SIMD and cached, because adjacent packets see mostly the
// same triangles.
#pragma once

#include "raster/geometry/geometry.h"
#include "raster/geometry/packet_lookup.h"
#include "raster/geometry/planes.h"
#include "raster/geometry/triangles.h"
#include "raster/visibility/shader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <map>
#include <memory>

namespace duet::raster {

/// Stores the setups of sixteen triangles. A plane is stored as the coefficients of x, y and 1, with the sign that
/// makes it positive inside the triangle: Interpolation's e[1] and e[2], the sum of its three e, and Σ(e·depth). D
/// is float or double. Pixel coordinates are relative to an origin beside the triangle's first corner, so that terms
/// that cancel have the size of the triangle.
template <VertexShader S, typename D> struct SetupPacket {
    using Plane = std::array<PacketOf<D>, 3>;
    using VaryingPackets = std::array<PacketOf<float>, kVaryings<S>>;
    /// This is the upper bound of M/Σe, where M = steepest·(|x| + |y|) + greatest bounds the terms of a plane.
    /// M/Σe is about the triangle's length over its height in pixels, or its farthest depth in the tile over the
    /// sample's depth. Beyond this bound, the planes are too inaccurate.
    static constexpr D kSteepest = std::is_same_v<D, float> ? D(1 << 8) : D(1 << 21);

    PacketOf<D> x, y; ///< origin: a pixel relative to the tile's corner
    Plane e1, e2, sum, depth_sum;
    PacketOf<D> steepest, greatest; ///< greatest |coefficient| of x or y, and of 1, in e1, e2 and sum
    VaryingPackets n, n1, n2;       ///< varyings at the first corner, and their derivatives along the two barycentrics
    std::array<PacketOf<float>, 3> ng; ///< like VertexInput::ng
};

/// Caches the setups of mesh and quad triangles, for one view of a tile. S's vertex function computes the varyings.
template <VertexShader S, typename D> class SetupCache {
public:
    using Setups = SetupPacket<S, D>;

    SetupCache(const Triangles& triangles, const PassView& view, const PixelRect& tile, const S& shader)
        : triangles_(triangles), view_(view), shader_(shader), origin_x_(tile.x0), origin_y_(tile.y0) {
        clear();
    }

    /// Selects the object whose triangles are requested from now on. `first_id` is the id of its first triangle.
    void use(const TransformedObject& object, const PackedShape& shape, std::size_t first_id);
    /// Returns the view of the selected object. The reference stays valid.
    const ObjectView& object() const { return *object_view_; }

    /// Returns true if there is room for another packet's triangles.
    bool has_room() const { return count_ + 2 * kPacketSize <= kCapacity; }
    /// Removes all setups.
    void clear();
    /// Stores the cache slot of each sample's triangle in `slots`. The setup is valid after finish(). Requires
    /// has_room().
    void lookup_or_insert(const PacketOf<std::int32_t>& ids, PacketOf<std::int32_t>& slots);
    /// Computes the setups that were added since the last call.
    void finish();
    /// Returns the setups in slots 16·i to 16·i + 15.
    const Setups& packet(std::size_t i) const { return packets_[i]; }

private:
    std::int32_t lookup_or_insert_one(std::int32_t id);
    void insert_all(const PacketOf<std::int32_t>& ids, PacketOf<std::int32_t>& slots);
    void pad_last_packet();
    void begin_packet();
    void prefetch_triangle(std::int32_t id) const { prefetch(&triangle(id)); }
    const PackedShape::Triangle& triangle(std::int32_t id) const {
        return shape_->triangles[static_cast<std::size_t>(id) - first_id_];
    }
    void prefetch_vertices(const PacketOf<std::int32_t>& ids) const;
    void set_up(const PacketOf<std::int32_t>& ids, Setups& to) const;
    using Corners = std::array<std::array<PacketOf<float>, 8>, 3>;
    void gather_vertices(const PacketOf<std::int32_t>& ids, Corners& corners) const;
    std::uint32_t second_halves(const PacketOf<std::int32_t>& ids) const;
    std::uint32_t set_up_planes(const Corners& corners, Setups& to) const;
    void set_up_varyings(std::size_t i, const Corners& corners, Floats side, std::uint32_t second_halves,
                         Setups& to) const;

    const Triangles& triangles_;
    const PassView& view_;
    const S& shader_;
    int origin_x_, origin_y_;
    const TransformedObject* object_ = nullptr;
    const PackedShape* shape_ = nullptr;
    std::size_t first_id_ = 0;
    const ObjectView* object_view_ = nullptr;
    std::map<std::uint32_t, ObjectView> object_views_;

    static constexpr std::size_t kCapacity = 1024, kMost = kCapacity / kPacketSize, kTableSize = kCapacity;
    static constexpr std::uint64_t kEmptySlot = std::uint64_t{kNoTriangle} << 32;
    /// This direct-mapped table holds (id, slot), indexed by the lower bits of the id. A triangle whose entry was
    /// overwritten is set up again.
    std::array<std::uint64_t, kTableSize> slot_table_;
    /// This table holds the most recently requested triangles, indexed by the lower six bits of their ids. It is
    /// small enough to be looked up for sixteen samples with SIMD.
    struct Recent {
        PacketOf<std::int32_t> ids, slots;
    };
    std::array<Recent, 4> recent_;
    std::unique_ptr<Setups[]> packets_ = std::make_unique_for_overwrite<Setups[]>(kMost);
    std::array<PacketOf<std::int32_t>, kMost> slot_ids_; ///< ids of triangles, indexed by slot
    std::size_t count_ = 0, finished_ = 0;            ///< slots in use, and slots with finished setups
};

template <VertexShader S, typename D>
void SetupCache<S, D>::use(const TransformedObject& object, const PackedShape& shape, std::size_t first_id) {
    if (object_ == &object) return;
    finish();
    begin_packet(); // a group of sixteen belongs to one object
    object_ = &object;
    shape_ = &shape;
    first_id_ = first_id;
    object_view_ = &object_views_.try_emplace(object.object, *triangles_.prepared, view_, object.object).first->second;
}

template <VertexShader S, typename D> void SetupCache<S, D>::clear() {
    count_ = finished_ = 0;
    slot_table_.fill(kEmptySlot);
    for (Recent& entry : recent_) entry.ids.fill(kNoTriangle);
}

template <VertexShader S, typename D>
void SetupCache<S, D>::lookup_or_insert(const PacketOf<std::int32_t>& ids, PacketOf<std::int32_t>& slots) {
    constexpr std::size_t kBatches = kPacketSize / Ints::size;
    std::array<Ints, kBatches> slots_of_batches;
    std::uint32_t found = 0;
    for (std::size_t b = 0; b < kBatches; ++b) {
        const std::size_t i = b * Ints::size;
        const Ints id = load(ids, i);
        const auto first = (id & Ints(2 * kPacketSize)) == Ints(0);
        const auto recent = [&](PacketOf<std::int32_t> Recent::*which) {
            return xsimd::select(first, look_up(recent_[0].*which, recent_[1].*which, ids, i),
                                 look_up(recent_[2].*which, recent_[3].*which, ids, i));
        };
        found |= lane_bits(recent(&Recent::ids) == id) << i;
        slots_of_batches[b] = recent(&Recent::slots);
    }
    constexpr std::uint32_t kAll = (1u << kPacketSize) - 1;
    std::uint32_t left = kAll & ~found;
    constexpr int kMany = 8; // with more new triangles, adding the whole packet is cheaper
    if (left != 0 && std::popcount(first_occurrences(ids) & left) > kMany) return insert_all(ids, slots);
    while (left != 0) {
        const std::int32_t id = ids[static_cast<std::size_t>(std::countr_zero(left))];
        const Ints slot(lookup_or_insert_one(id));
        left &= ~lanes_equal(ids, id);
        for (std::size_t b = 0; b < kBatches; ++b)
            slots_of_batches[b] = xsimd::select(load(ids, b * Ints::size) == Ints(id), slot, slots_of_batches[b]);
    }
    for (std::size_t b = 0; b < kBatches; ++b) store(slots, b * Ints::size, slots_of_batches[b]);
}

/// Adds the triangles of all sixteen samples without removing duplicates. They are not entered into the tables.
template <VertexShader S, typename D>
void SetupCache<S, D>::insert_all(const PacketOf<std::int32_t>& ids, PacketOf<std::int32_t>& slots) {
    begin_packet();
    for (std::size_t i = 0; i < kPacketSize; i += Ints::size)
        store(slots, i, Ints(static_cast<std::int32_t>(count_)) + load(kLanes, i));
    slot_ids_[count_ / kPacketSize] = ids;
    for (const std::int32_t id : ids.v) prefetch_triangle(id);
    count_ += kPacketSize;
}

/// Fills the last group of sixteen with copies of its last triangle.
template <VertexShader S, typename D> void SetupCache<S, D>::pad_last_packet() {
    for (std::size_t i = count_; i % kPacketSize != 0; ++i)
        slot_ids_[i / kPacketSize][i % kPacketSize] = slot_ids_[i / kPacketSize][i % kPacketSize - 1];
}

template <VertexShader S, typename D> void SetupCache<S, D>::begin_packet() {
    pad_last_packet();
    const std::size_t next = (count_ + kPacketSize - 1) / kPacketSize * kPacketSize;
    if (finished_ == count_) finished_ = next;
    count_ = next;
}

/// This function has no branch, because whether a triangle is cached is unpredictable.
template <VertexShader S, typename D> std::int32_t SetupCache<S, D>::lookup_or_insert_one(std::int32_t id) {
    std::uint64_t& slot = slot_table_[static_cast<std::size_t>(id) % kTableSize];
    const auto number = static_cast<std::uint32_t>(id);
    const std::uint64_t is_new = (slot >> 32) != number, new_bits = -is_new;
    const auto slots = static_cast<std::uint32_t>((slot & ~new_bits) | (count_ & new_bits));
    slot = std::uint64_t{number} << 32 | slots;
    count_ += is_new;
    const std::size_t recent = static_cast<std::size_t>(id) % (recent_.size() * kPacketSize);
    slot_ids_[slots / kPacketSize][slots % kPacketSize] = id;
    recent_[recent / kPacketSize].ids[recent % kPacketSize] = id;
    recent_[recent / kPacketSize].slots[recent % kPacketSize] = static_cast<std::int32_t>(slots);
    prefetch_triangle(id);
    return static_cast<std::int32_t>(slots);
}

/// Returns one bit per triangle that is the second half of a quad.
template <VertexShader S, typename D>
std::uint32_t SetupCache<S, D>::second_halves(const PacketOf<std::int32_t>& ids) const {
    std::uint32_t halves = 0;
    if (!shape_->quads()) return halves;
    const Ints first(static_cast<std::int32_t>(first_id_)), one(1);
    for (std::size_t i = 0; i < kPacketSize; i += Ints::size)
        halves |= lane_bits(((load(ids, i) ^ first) & one) == one) << i;
    return halves;
}

/// Computes the varyings of one batch of triangles from the i-th on. `side` is 1 for front faces and -1 for back
/// faces.
template <VertexShader S, typename D>
void SetupCache<S, D>::set_up_varyings(std::size_t i, const Corners& corners, Floats side, std::uint32_t second_halves,
                                       Setups& to) const {
    const auto vector = [&](std::size_t k, std::size_t first) {
        return Vec3T<Floats>{load(corners[k][first], i), load(corners[k][first + 1], i),
                             load(corners[k][first + 2], i)};
    };
    const std::array<Vec3T<Floats>, 3> p{vector(0, 0), vector(1, 0), vector(2, 0)};
    // Divide by the largest component, so that squares do not underflow for tiny triangles.
    const Vec3T<Floats> across = cross(p[1] - p[0], p[2] - p[0]);
    const Floats largest = max(max(abs(across.x), abs(across.y)), abs(across.z));
    const Vec3T<Floats> ng = across * (side / max(largest, Floats(std::numeric_limits<float>::min())));
    // A quad's diagonal is not an edge. It lies opposite to the second corner of the first half and to the third corner
    // of the second half.
    const auto second = lanes_from<float>(second_halves >> i);
    const bool quads = shape_->quads();
    const Vec3T<Floats> middle =
        quads ? (p[0] + select(second, p[1], p[2])) * Floats(0.5f) : (p[0] + p[1] + p[2]) * Floats(1.0f / 3);
    const Floats zero(0.0f), one(1.0f), no_edge1 = quads ? xsimd::select(second, zero, one) : zero,
                 no_edge2 = quads ? xsimd::select(second, one, zero) : zero;
    std::array<std::array<Floats, kVaryings<S>>, 3> v;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3T<Floats> edges(k == 0 ? one : zero, k == 1 ? one : no_edge1, k == 2 ? one : no_edge2);
        Vec2T<Floats> uv(Floats(0.0f), Floats(0.0f));
        if constexpr (wants_texture_coordinates<S>()) uv = {load(corners[k][3], i), load(corners[k][7], i)};
        v[k] = varying_floats<S, Floats>(
            shader_.vertex(VertexInput<Floats>{p[k], vector(k, 4), uv, ng, middle, edges, *object_view_}));
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

/// Loads eight values for each of three corners: position and u, normal and v.
template <VertexShader S, typename D>
void SetupCache<S, D>::gather_vertices(const PacketOf<std::int32_t>& ids, Corners& corners) const {
    const PackedVertex* all = shape_->vertices.data();
    std::array<std::array<std::uint32_t, 3>, kPacketSize> triangles;
    for (std::size_t i = 0; i < kPacketSize; ++i) triangles[i] = triangle(ids[i]);
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < kPacketSize; i += Quads::size)
            for (std::size_t first = 0; first < 8; first += 4) { // offset in the vertex, in floats
                const auto [x, y, z, w] = load_columns<Quads::size>(
                    [&](std::size_t lane) { return &all[triangles[i + lane][k]].p.x + first; });
                x.store_aligned(corners[k][first].at(i));
                y.store_aligned(corners[k][first + 1].at(i));
                z.store_aligned(corners[k][first + 2].at(i));
                if constexpr (wants_texture_coordinates<S>()) w.store_aligned(corners[k][first + 3].at(i));
            }
}

/// Returns one bit per triangle that runs counter-clockwise in the image. The planes are computed in double for
/// every D, and scaled so that no coefficient of e1, e2 and sum exceeds 1.
template <VertexShader S, typename D>
std::uint32_t SetupCache<S, D>::set_up_planes(const Corners& corners, Setups& to) const {
    const Mat4d& m = object_->to_pixel;
    const auto entry = [&](std::size_t r, std::size_t c) { return Doubles(m[r][c]); };
    const Doubles left(static_cast<double>(origin_x_)), top(static_cast<double>(origin_y_)), zero(0.0),
        size(TileGrid::kTileSize);
    std::uint32_t front = 0;
    for (std::size_t i = 0; i < kPacketSize; i += Doubles::size) {
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
            plane[2] = multiply_add(plane[0], from_x, multiply_add(plane[1], from_y, plane[2]));
        };
        Doubles steepest = zero, greatest = zero;
        for (auto* plane : {&planes.e1, &planes.e2, &planes.sum}) {
            move(*plane);
            steepest = max(steepest, max(abs((*plane)[0]), abs((*plane)[1])));
            greatest = max(greatest, abs((*plane)[2]));
        }
        // Under perspective Σ(e·depth) is constant, and its coefficients of x and y are rounding noise.
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

template <VertexShader S, typename D>
void SetupCache<S, D>::prefetch_vertices(const PacketOf<std::int32_t>& ids) const {
    const PackedVertex* all = shape_->vertices.data();
    for (const std::int32_t id : ids.v)
        for (const std::uint32_t corner : triangle(id)) prefetch(&all[corner]);
}

/// Computes the new setups. It prefetches all vertices first, so that the cache misses overlap.
template <VertexShader S, typename D> void SetupCache<S, D>::finish() {
    if (finished_ == count_) return;
    pad_last_packet();
    const std::size_t first = finished_ / kPacketSize, end = (count_ + kPacketSize - 1) / kPacketSize;
    for (std::size_t i = first; i < end; ++i) prefetch_vertices(slot_ids_[i]);
    for (std::size_t i = first; i < end; ++i) set_up(slot_ids_[i], packets_[i]);
    finished_ = count_;
}

/// Computes the setups of sixteen triangles of the selected object.
template <VertexShader S, typename D>
void SetupCache<S, D>::set_up(const PacketOf<std::int32_t>& ids, Setups& to) const {
    Corners corners;
    gather_vertices(ids, corners);
    // A front face runs counter-clockwise in the image (y points down) unless the object is mirrored.
    std::uint32_t front = set_up_planes(corners, to);
    if (object_->mirrored) front = ~front;
    const std::uint32_t halves = second_halves(ids);
    for (std::size_t i = 0; i < kPacketSize; i += Floats::size)
        set_up_varyings(i, corners, xsimd::select(lanes_from<float>(front >> i), Floats(1.0f), Floats(-1.0f)), halves,
                        to);
}

} // namespace duet::raster
