// Defines types that hold values of several paths in SIMD lanes, one path per lane, and convert them to and from
// scalars.
#pragma once

#include "common/image/rgb.h"
#include "raytrace/wavefront/batch_path.h"
#include "raytrace/wavefront/robust_batch.h"
#include "raytrace/wavefront/widen.h"

#include <array>
#include <span>

namespace duet::raytrace::lanes {

constexpr std::size_t kLanes = kPathLanes;
using Floats = FloatBatch<kLanes>;
using Doubles = DoubleBatch;
using Vec = Vec3T<Floats>;
using Vecd = Vec3T<Doubles>;
using Color = RgbT<Floats>;
using Mask = MaskOf<Floats>;

/// Holds one number per path.
struct LaneValues {
    alignas(sizeof(Doubles)) std::array<float, kLanes> values{};

    LaneValues() = default;
    explicit LaneValues(Floats lanes) { lanes.store_aligned(values.data()); }
    explicit LaneValues(Doubles lanes) { store_floats(lanes, values.data()); }
    Floats floats() const { return Floats::load_aligned(values.data()); }
    Doubles doubles() const { return load_doubles(values.data()); }
};
/// Holds three numbers per path: a vector or a color.
struct LaneVectors {
    LaneValues x, y, z;

    LaneVectors() = default;
    template <typename T> explicit LaneVectors(const Vec3T<T>& v) : x(v.x), y(v.y), z(v.z) {}
    explicit LaneVectors(const Color& c) : x(c.r), y(c.g), z(c.b) {}
    void set(std::size_t i, Vec3 v) { x.values[i] = v.x, y.values[i] = v.y, z.values[i] = v.z; }
    void set(std::size_t i, Rgb c) { set(i, Vec3(c.r, c.g, c.b)); }
    Vec3 vec(std::size_t i) const { return {x.values[i], y.values[i], z.values[i]}; }
    Rgb rgb(std::size_t i) const { return {x.values[i], y.values[i], z.values[i]}; }
    Vec floats() const { return {x.floats(), y.floats(), z.floats()}; }
    Vecd doubles() const { return {x.doubles(), y.doubles(), z.doubles()}; }
    Color colors() const { return {x.floats(), y.floats(), z.floats()}; }
};

/// Calls set(lane, path) for each lane. Lanes beyond the number of paths repeat the first path, so that their values
/// are valid.
template <typename Set> void for_lanes(std::span<const BatchPath> paths, const Set& set) {
    for (std::size_t i = 0; i < kLanes; ++i) set(i, paths[i < paths.size() ? i : 0]);
}

/// Loads four consecutive floats of each path, starting at first(path), into four batches.
template <typename First> std::array<Floats, 4> load_four(std::span<const BatchPath> paths, const First& first) {
    return load_columns<kLanes>([&](std::size_t i) { return &first(paths[i < paths.size() ? i : 0]); });
}

} // namespace duet::raytrace::lanes
