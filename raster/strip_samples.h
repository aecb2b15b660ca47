// Sixteen samples of a tile, and what they see.
#pragma once

#include "raster/depth_tile.h"
#include "raster/strip_shader.h"

#include <cstdint>

namespace duet::raster {

/// A bit for each sample that sees something.
inline std::uint32_t samples_seen(const std::int32_t* ids) {
    const Ints none(static_cast<std::int32_t>(kNoTriangle));
    std::uint32_t seen = 0;
    for (std::size_t i = 0; i < kStrip; i += Ints::size) seen |= lane_bits(Ints::load_aligned(ids + i) != none) << i;
    return seen;
}

/// The strip of a tile that begins at a pixel.
inline StripPlace strip_place(const DepthTile& tile, int x, int y) {
    const std::uint32_t place = tile.place(x, y);
    return {.x = x, .y = y, .ids = tile.ids() + place, .nearness = tile.nearness() + place, .offset = tile.offset()};
}

/// Walks from strip to strip: what two of them have in common is not looked up again.
class StripSamples {
public:
    StripSamples(const Triangles& triangles) : triangles_(triangles) {}

    /// Takes the numbers of what the sixteen samples see (DepthTile::ids).
    void load(const std::int32_t* ids);

    /// A bit for each sample that sees something, and for each that sees a mesh's triangle.
    std::uint32_t seen() const { return seen_; }
    std::uint32_t on_mesh() const { return on_mesh_; }

    std::uint32_t id(std::size_t i) const { return static_cast<std::uint32_t>(ids_[i]); }
    const Run& run(std::size_t i) const { return triangles_.run_of(id(i), *last_run_); }
    /// The only object that is seen of all meshes, or null.
    const TransformedObject* one_object() const { return one_object_; }
    const Mesh* one_mesh() const { return one_mesh_; }
    /// Triangle of the one mesh.
    std::size_t index(std::size_t i) const { return static_cast<std::size_t>(ids_[i]) - first_id_; }

protected:
    const Triangles& triangles_;
    StripOf<std::int32_t> ids_; ///< where nothing is seen: another's
    bool changed_ = false;      ///< by load(): other triangles, until who uses them resets it
    bool each_ = false;         ///< so many triangles that each sample's is worked on by itself, side by side
    static constexpr std::size_t kFew = 5;
    std::size_t few_ = 0;                         ///< else: how many there are
    std::array<std::uint32_t, kFew> few_lanes_{}; ///< and a bit for each of their samples

private:
    const Run* last_run_ = nullptr;
    const TransformedObject* one_object_ = nullptr;
    const Mesh* one_mesh_ = nullptr;
    std::size_t first_id_ = 0; ///< number of the object's first triangle
    std::uint32_t seen_ = 0, on_mesh_ = 0;
};

} // namespace duet::raster
