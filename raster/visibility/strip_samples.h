// Sixteen samples of a tile, and what they see.
#pragma once

#include "raster/visibility/strip_place.h"
#include "raster/visibility/depth_tile.h"

#include <cstdint>

namespace duet::raster {

/// A bit for each sample that sees something.
inline std::uint32_t samples_seen(const std::int32_t* ids) {
    const Ints none(static_cast<std::int32_t>(kNoTriangle));
    std::uint32_t seen = 0;
    for (std::size_t i = 0; i < kStrip; i += Ints::size) seen |= lane_bits(Ints::load_aligned(ids + i) != none) << i;
    return seen;
}

/// The strip of a tile that begins at a pixel, whose place is known.
inline StripPlace strip_place(const DepthTile& tile, int x, int y, std::uint32_t place) {
    return {.x = x,
            .y = y,
            .ids = tile.ids() + place,
            .nearness = tile.nearness() + place,
            .inside = tile.inside(place),
            .offset = tile.offset()};
}
inline StripPlace strip_place(const DepthTile& tile, int x, int y) { return strip_place(tile, x, y, tile.place(x, y)); }

/// What the samples of a strip see.
struct StripSamples {
    StripOf<std::int32_t> ids; ///< where nothing is seen: another's
    std::uint32_t seen = 0;    ///< a bit for each sample that sees something
    std::uint32_t on_mesh = 0; ///< and for each that sees a mesh's triangle or a quad's half, where only one object's are seen
    const TransformedObject* object = nullptr; ///< that one, or null
    const PackedShape* shape = nullptr;        ///< its triangles; of a sphere: null
    std::size_t first_id = 0;                  ///< number of the first of them

    std::uint32_t id(std::size_t i) const { return static_cast<std::uint32_t>(ids[i]); }
    /// Triangle of the one object.
    std::size_t index(std::size_t i) const { return static_cast<std::size_t>(ids[i]) - first_id; }
};

/// Walks from strip to strip: the object that two of them have in common is not looked up again.
class StripReader {
public:
    explicit StripReader(const Triangles& triangles) : triangles_(triangles) {}

    /// Takes the numbers of what the sixteen samples see (DepthTile::ids).
    void read(const std::int32_t* ids, StripSamples& samples);
    const Run& run_of(std::uint32_t id) const { return triangles_.run_of(id, *last_run_); }

private:
    bool all_of_last_object(const StripSamples& samples) const;
    void find_object(const StripSamples& samples);

    const Triangles& triangles_;
    const Run* last_run_ = nullptr;
    const TransformedObject* object_ = nullptr; ///< null: the last samples did not see the triangles of just one
    const PackedShape* shape_ = nullptr;
    std::size_t first_id_ = 0;
    std::int32_t low_id_ = 0, end_id_ = 0; ///< numbers of its triangles
};

inline bool StripReader::all_of_last_object(const StripSamples& samples) const {
    if (object_ == nullptr) return false;
    bool all = true;
    for (std::size_t i = 0; i < kStrip; i += Ints::size) {
        const Ints id = load(samples.ids, i);
        all = all && xsimd::all(id >= Ints(low_id_) && id < Ints(end_id_));
    }
    return all;
}

inline void StripReader::read(const std::int32_t* ids, StripSamples& samples) {
    const Ints none(static_cast<std::int32_t>(kNoTriangle));
    samples.seen = samples_seen(ids);
    samples.on_mesh = 0;
    if (samples.seen == 0) return;
    const Ints first(ids[std::countr_zero(samples.seen)]);
    for (std::size_t i = 0; i < kStrip; i += Ints::size) {
        const Ints read = Ints::load_aligned(ids + i);
        store(samples.ids, i, xsimd::select(read == none, first, read));
    }
    if (!all_of_last_object(samples)) find_object(samples);
    samples.object = object_;
    if (object_ == nullptr) return;
    samples.on_mesh = samples.seen;
    samples.shape = shape_;
    samples.first_id = first_id_;
}

} // namespace duet::raster
