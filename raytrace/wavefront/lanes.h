// These types hold values of several paths in SIMD lanes, one path per lane, and convert them to and from scalars.
#pragma once

#include "common/image/rgb.h"
#include "common/vec/robust_batch.h"
#include "common/vec/widen.h"
#include "raytrace/wavefront/batch.h"

#include <array>
#include <span>

namespace duet::raytrace::lanes {

#if XSIMD_WITH_AVX

constexpr std::size_t kLanes = kPathLanes;
using Floats = FloatBatch<kLanes>;
using Doubles = DoubleBatch;
using Vec = Vec3T<Floats>;
using Vecd = Vec3T<Doubles>;
using Color = RgbT<Floats>;
using Mask = MaskOf<Floats>;

// A Column has one number per path, and Columns have three.
struct Column {
    alignas(sizeof(Doubles)) std::array<float, kLanes> of{};

    Column() = default;
    explicit Column(Floats lanes) { lanes.store_aligned(of.data()); }
    explicit Column(Doubles lanes) { store_floats(lanes, of.data()); }
    Floats floats() const { return Floats::load_aligned(of.data()); }
    Doubles doubles() const { return load_doubles(of.data()); }
};
struct Columns {
    Column x, y, z;

    Columns() = default;
    template <typename T> explicit Columns(const Vec3T<T>& v) : x(v.x), y(v.y), z(v.z) {}
    explicit Columns(const Color& c) : x(c.r), y(c.g), z(c.b) {}
    void set(std::size_t i, Vec3 v) { x.of[i] = v.x, y.of[i] = v.y, z.of[i] = v.z; }
    void set(std::size_t i, Rgb c) { set(i, Vec3(c.r, c.g, c.b)); }
    Vec3 vec(std::size_t i) const { return {x.of[i], y.of[i], z.of[i]}; }
    Rgb rgb(std::size_t i) const { return {x.of[i], y.of[i], z.of[i]}; }
    Vec floats() const { return {x.floats(), y.floats(), z.floats()}; }
    Vecd doubles() const { return {x.doubles(), y.doubles(), z.doubles()}; }
    Color colors() const { return {x.floats(), y.floats(), z.floats()}; }
};

// Calls set(lane, path) for each lane. Lanes beyond the number of paths get the first path, so that their values are
// valid.
template <typename Set> void for_lanes(std::span<const BatchPath> paths, const Set& set) {
    for (std::size_t i = 0; i < kLanes; ++i) set(i, paths[i < paths.size() ? i : 0]);
}

// Loads four consecutive numbers of each path, starting at first(path), into four batches.
template <typename First> std::array<Floats, 4> fours(std::span<const BatchPath> paths, const First& first) {
    return load_columns<kLanes>([&](std::size_t i) { return &first(paths[i < paths.size() ? i : 0]); });
}

#endif

} // namespace duet::raytrace::lanes
