// Reads the ids of a packet of sixteen samples and finds the object they belong to.
#pragma once

#include "raster/visibility/depth_tile.h"
#include "raster/visibility/sample_packet.h"

#include <cstdint>

namespace duet::raster {

/// Returns one bit per sample that has a visible primitive.
inline std::uint32_t visible_lanes(const std::int32_t* ids) {
    const Ints none(static_cast<std::int32_t>(kNoTriangle));
    std::uint32_t visible = 0;
    for (std::size_t i = 0; i < kPacketSize; i += Ints::size)
        visible |= lane_bits(Ints::load_aligned(ids + i) != none) << i;
    return visible;
}

/// Returns the packet that starts at pixel (x, y), whose storage index is `sample_index`.
inline SamplePacket sample_packet(const DepthTile& tile, int x, int y, std::uint32_t sample_index) {
    return {.x = x,
            .y = y,
            .ids = tile.ids() + sample_index,
            .reversed_depth = tile.reversed_depth() + sample_index,
            .offset = tile.offset()};
}
inline SamplePacket sample_packet(const DepthTile& tile, int x, int y) {
    return sample_packet(tile, x, y, tile.sample_index(x, y));
}

/// Holds the visible primitives of a packet's samples.
struct PacketPrimitives {
    PacketOf<std::int32_t> ids; ///< samples without a primitive repeat the id of another one
    std::uint32_t visible = 0;  ///< one bit per sample with a visible primitive
    std::uint32_t on_mesh = 0; ///< one bit per sample on a mesh or quad; 0 unless all belong to the same object
    const TransformedObject* object = nullptr; ///< object of all samples, or null
    const PackedShape* shape = nullptr;        ///< triangles of `object`; null for a sphere
    std::size_t first_id = 0;                  ///< id of the first triangle of `object`

    std::uint32_t id(std::size_t i) const { return static_cast<std::uint32_t>(ids[i]); }
    /// Returns the index of sample i's triangle among those of `object`.
    std::size_t index(std::size_t i) const { return static_cast<std::size_t>(ids[i]) - first_id; }
};

/// Reads consecutive packets. The object lookup is skipped while packets see the same object.
class PacketReader {
public:
    explicit PacketReader(const Triangles& triangles) : triangles_(triangles) {}

    /// Reads the ids of the sixteen samples' visible primitives (DepthTile::ids).
    void read(const std::int32_t* ids, PacketPrimitives& samples);
    const Run& run_of(std::uint32_t id) const { return triangles_.run_of(id, *last_run_); }

private:
    bool all_of_last_object(const PacketPrimitives& samples) const;
    void find_object(const PacketPrimitives& samples);

    const Triangles& triangles_;
    const Run* last_run_ = nullptr;
    const TransformedObject* object_ = nullptr; ///< null unless the last packet saw one object's triangles
    const PackedShape* shape_ = nullptr;
    std::size_t first_id_ = 0;
    std::int32_t low_id_ = 0, end_id_ = 0; ///< range of the ids of the object's triangles
};

inline bool PacketReader::all_of_last_object(const PacketPrimitives& samples) const {
    if (object_ == nullptr) return false;
    bool all = true;
    for (std::size_t i = 0; i < kPacketSize; i += Ints::size) {
        const Ints id = load(samples.ids, i);
        all = all && xsimd::all(id >= Ints(low_id_) && id < Ints(end_id_));
    }
    return all;
}

inline void PacketReader::read(const std::int32_t* ids, PacketPrimitives& samples) {
    const Ints none(static_cast<std::int32_t>(kNoTriangle));
    samples.visible = visible_lanes(ids);
    samples.on_mesh = 0;
    if (samples.visible == 0) return;
    const Ints first(ids[std::countr_zero(samples.visible)]);
    for (std::size_t i = 0; i < kPacketSize; i += Ints::size) {
        const Ints read = Ints::load_aligned(ids + i);
        store(samples.ids, i, xsimd::select(read == none, first, read));
    }
    if (!all_of_last_object(samples)) find_object(samples);
    samples.object = object_;
    if (object_ == nullptr) return;
    samples.on_mesh = samples.visible;
    samples.shape = shape_;
    samples.first_id = first_id_;
}

} // namespace duet::raster
