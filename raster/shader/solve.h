// Computes barycentrics, depth and a shader's varyings for a packet of sixteen samples with SIMD.
#pragma once

#include "raster/shader/read_strip.h"

#include <bit>
#include <limits>
#include <span>

namespace duet::raster {

/// Holds the solution of a packet whose samples see triangles of one object, or a sphere.
template <VertexShader S, typename D> struct SolvedStrip {
    static constexpr std::size_t kCount = kVaryings<S>;
    static constexpr bool kDerivatives = wants_derivatives<S>();

    const StripSamples* samples = nullptr;
    const ObjectView* object_view = nullptr; ///< null if the packet does not see triangles of exactly one object
    std::array<StripOf<float>, kCount> at;                        ///< varyings
    std::array<StripOf<float>, kDerivatives ? kCount : 0> dx, dy; ///< screen-space derivatives of the varyings
    std::array<StripOf<float>, 3> ng;                             ///< as VertexInput::ng
    StripOf<float> b1, b2; ///< barycentrics of the second and third corner; with D = double as in a Hit
    StripOf<D> depth;      ///< camera-space −z, meters
    /// Derivatives of b1 and b2 along the row and the column, if requested.
    std::array<StripOf<float>, 2> b1_steps, b2_steps;
    /// A sample's bit is set if it is certainly inside the unsnapped triangle, where the solution is accurate. No
    /// bits are set for directions.
    std::uint32_t inside = 0;
    /// Only the direction of `at` is known, nothing else but `samples` is set, and all normals are on the visible
    /// side (SetUp::easy).
    bool directions = false;
};

/// Solves for the samples of a packet if all see triangles of one object. S's vertex function computes the
/// varyings. D is the precision: double, or float with errors below 2^-13, mostly below 2^-20, in barycentrics and
/// depth (kSteepest).
template <VertexShader S, typename D> class StripSolver {
public:
    using Solved = SolvedStrip<S, D>;

    /// `tile` is the rectangle of the tile that all packets lie in. `steps` requests the derivatives of the
    /// barycentrics.
    StripSolver(const Triangles& triangles, const PassView& view, const PixelRect& tile, const S& shader, bool steps)
        : triangles_(triangles), view_(view), reader_(triangles), set_ups_(triangles, view, tile, shader),
          origin_x_(tile.x0), origin_y_(tile.y0), steps_(steps) {}

    /// Calls use(first, strips) for a few packets at a time. `strips` holds the solutions of places[first] and
    /// those that follow, and is valid until use() returns. `mend` recomputes the samples with inaccurate solutions
    /// one by one.
    template <typename Use> void solve(std::span<const StripPlace> places, bool mend, const Use& use);
    const Run& run_of(std::uint32_t id) const { return reader_.run_of(id); }

private:
    static constexpr std::size_t kCount = Solved::kCount;
    static constexpr bool kDerivatives = Solved::kDerivatives;
    using Sixteen = SetUp<S, D>;
    using ReadStrip = raster::ReadStrip<S, D>;
    using Ds = xsimd::batch<D>;
    static constexpr std::size_t kParts = Floats::size / Ds::size;

    /// The value of a plane at (x, y) relative to its origin has an error of at most 3ε·M, where ε is half a unit
    /// in the last place and M = steepest·(|x| + |y|) + greatest: each coefficient is rounded once, and so are both
    /// fused steps. The third barycentric, Σe minus the other two, accumulates three of these errors and two
    /// roundings of less than 4ε·M: 17ε·M in all.
    static constexpr D kError = 16 * std::numeric_limits<D>::epsilon(); // 32ε
    /// The upper bound of M/Σe limits the error of the barycentrics e/Σe, which is 6ε·M/Σe and two roundings.
    static constexpr D kSteepest = Sixteen::kSteepest;

    void set_grid(SampleOffset offset);
    std::size_t read(std::span<const StripPlace> places);
    void solve_one(const StripPlace& place, const ReadStrip& samples, Solved& strip, bool mend);
    template <typename Positions>
    void solve_at(const ReadStrip& samples, const Positions& positions, Solved& strip) const;
    template <typename Own, typename Positions>
    void solve_lanes(const Own& own, const Positions& positions, Solved& strip) const;
    bool may_solve_directions(const StripPlace& place, const ReadStrip& samples) const;
    template <typename Own, typename Positions>
    static void solve_directions(const Own& own, const Positions& positions, Solved& strip);
    template <typename Own> static void interpolate_varyings(const Own& own, std::size_t i, Solved& strip);
    void mend_strip(const StripPlace& place, const ReadStrip& samples, Solved& strip) const;

    const Triangles& triangles_;
    const PassView& view_;
    StripReader reader_;
    SetUps<S, D> set_ups_;
    int origin_x_, origin_y_;
    bool steps_;
    SampleOffset grid_offset_{0, 0};
    /// Samples at that offset, relative to their packet's first pixel.
    StripOf<D> grid_xs_ = kColumns<D>, grid_ys_ = kRows<D>;
    /// kMost packets have their triangles set up together. kTogether packets are solved together: enough for their work
    /// to overlap, few enough to fit into the L1 cache.
    static constexpr std::size_t kMost = 64, kTogether = 8;
    std::array<ReadStrip, kMost> read_;
    std::array<Solved, kTogether> solved_;
};

/// This vertex shader is empty, for users that need only barycentrics and depths.
struct NoVaryings {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> struct Varyings {};
    template <typename T> Varyings<T> vertex(const VertexInput<T>&) const { return {}; }
};
/// Interpolates only the vertex normals, which the fragment function normalizes.
struct NormalVaryings {
    static constexpr bool kTextureCoordinates = false, kDirections = true;
    template <typename T> struct Varyings {
        Vec3T<T> n;
    };
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const { return {v.n}; }
};

namespace strips {

template <typename Strips> Vec3T<Floats> vector(const Strips& v, std::size_t first, std::size_t i) {
    return {load(v[first], i), load(v[first + 1], i), load(v[first + 2], i)};
}

/// The table holds the pixel indices of a tile, converted to D. A table lookup is faster than the conversion, which
/// would be on the critical path.
template <typename D> inline const std::array<D, TileGrid::kTileSize> kPixels = [] {
    std::array<D, TileGrid::kTileSize> numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<D>(i);
    return numbers;
}();

/// Computes the positions of samples relative to the tile's corner: on a regular grid (OnGrid) or one by one
/// (Scattered). They are exact, even as floats.
template <typename D> struct OnGrid {
    std::size_t column, row; ///< of the first pixel
    const StripOf<D>&xs, &ys; ///< samples relative to the first pixel
    xsimd::batch<D> x(std::size_t i) const { return xsimd::batch<D>(kPixels<D>[column]) + load(xs, i); }
    xsimd::batch<D> y(std::size_t i) const { return xsimd::batch<D>(kPixels<D>[row]) + load(ys, i); }
};
template <typename D> struct Scattered {
    StripOf<D> xs, ys;
    xsimd::batch<D> x(std::size_t i) const { return load(xs, i); }
    xsimd::batch<D> y(std::size_t i) const { return load(ys, i); }
};

inline Floats joined(const std::array<Floats, 1>& parts) { return parts[0]; }
inline Floats joined(const std::array<Doubles, 2>& parts) { return narrowed(parts[0], parts[1]); }

} // namespace strips

/// The barycentrics are bᵢ = eᵢ / Σe, and the depth is Σ(e·depth) / Σe (see Interpolation). The derivative of
/// such a quotient by x is (eᵢ' − bᵢ·(Σe)') / Σe.
template <VertexShader S, typename D>
template <typename Own, typename Positions>
void StripSolver<S, D>::solve_lanes(const Own& own, const Positions& positions, Solved& strip) const {
    using Parts = std::array<Ds, kParts>;
    std::uint32_t inside = 0;
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        Parts first_b, second_b;
        std::array<Parts, 2> first_steps, second_steps;
        for (std::size_t part = 0; part < kParts; ++part) {
            const std::size_t k = i + part * Ds::size;
            const auto number = [&](StripOf<D> Sixteen::*which) {
                return own.template get<D>(k, [&](const Sixteen& s) -> const StripOf<D>& { return s.*which; });
            };
            const auto coefficient = [&](typename Sixteen::Plane Sixteen::*which, std::size_t c) {
                return own.template get<D>(k, [&](const Sixteen& s) -> const StripOf<D>& { return (s.*which)[c]; });
            };
            const auto plane = [&](typename Sixteen::Plane Sixteen::*which) -> std::array<Ds, 3> {
                return {coefficient(which, 0), coefficient(which, 1), coefficient(which, 2)};
            };
            const Ds x = positions.x(k) - number(&Sixteen::x), y = positions.y(k) - number(&Sixteen::y);
            const auto value = [&](const std::array<Ds, 3>& p) { return fused(p[0], x, fused(p[1], y, p[2])); };
            const std::array<Ds, 3> plane1 = plane(&Sixteen::e1), plane2 = plane(&Sixteen::e2),
                                    of_sum = plane(&Sixteen::sum);
            const Ds e1 = value(plane1), e2 = value(plane2), sum = value(of_sum), inverse = Ds(D(1)) / sum;
            const Ds size = fused(number(&Sixteen::steepest), abs(x) + abs(y), number(&Sixteen::greatest)),
                     error = size * Ds(kError);
            inside |= lane_bits(e1 >= error && e2 >= error && sum - e1 - e2 >= error && sum * Ds(kSteepest) >= size)
                      << k;
            first_b[part] = e1 * inverse;
            second_b[part] = e2 * inverse;
            const Ds depth_sum =
                view_.viewport.orthographic ? value(plane(&Sixteen::depth_sum)) : coefficient(&Sixteen::depth_sum, 2);
            store(strip.depth, k, depth_sum * inverse);
            if (!kDerivatives && !steps_) continue;
            for (std::size_t axis = 0; axis < 2; ++axis) {
                first_steps[axis][part] = (plane1[axis] - first_b[part] * of_sum[axis]) * inverse;
                second_steps[axis][part] = (plane2[axis] - second_b[part] * of_sum[axis]) * inverse;
            }
        }
        store(strip.b1, i, strips::joined(first_b));
        store(strip.b2, i, strips::joined(second_b));
        for (std::size_t axis = 0; axis < 2 && (kDerivatives || steps_); ++axis) {
            store(strip.b1_steps[axis], i, strips::joined(first_steps[axis]));
            store(strip.b2_steps[axis], i, strips::joined(second_steps[axis]));
        }
        interpolate_varyings(own, i, strip);
    }
    strip.inside = inside;
}

/// Interpolates the varyings of one batch of samples from the i-th on by their barycentrics.
template <VertexShader S, typename D>
template <typename Own>
void StripSolver<S, D>::interpolate_varyings(const Own& own, std::size_t i, Solved& strip) {
    const auto number = [&](typename Sixteen::Numbers Sixteen::*which, std::size_t c) {
        return own.template get<float>(i, [&](const Sixteen& s) -> const StripOf<float>& { return (s.*which)[c]; });
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        store(strip.ng[axis], i,
              own.template get<float>(i, [&](const Sixteen& s) -> const StripOf<float>& { return s.ng[axis]; }));
    const Floats u = load(strip.b1, i), v = load(strip.b2, i);
    for (std::size_t c = 0; c < kCount; ++c) {
        const Floats along_u = number(&Sixteen::n1, c), along_v = number(&Sixteen::n2, c);
        store(strip.at[c], i, fused(along_u, u, fused(along_v, v, number(&Sixteen::n, c))));
        if constexpr (kDerivatives) {
            store(strip.dx[c], i, Floats(along_u * load(strip.b1_steps[0], i) + along_v * load(strip.b2_steps[0], i)));
            store(strip.dy[c], i, Floats(along_u * load(strip.b1_steps[1], i) + along_v * load(strip.b2_steps[1], i)));
        }
    }
}

/// Computes the varyings times Σe, which are linear in the image. The factor does not change their direction.
template <VertexShader S, typename D>
template <typename Own, typename Positions>
void StripSolver<S, D>::solve_directions(const Own& own, const Positions& positions, Solved& strip) {
    if constexpr (Sixteen::kDirections)
        for (std::size_t i = 0; i < kStrip; i += Floats::size) {
            const Floats x = positions.x(i), y = positions.y(i);
            for (std::size_t c = 0; c < kCount; ++c) {
                const auto coefficient = [&](std::size_t k) {
                    return own.template get<float>(
                        i, [c, k](const Sixteen& s) -> const StripOf<float>& { return s.directions[c][k]; });
                };
                store(strip.at[c], i, fused(coefficient(0), x, fused(coefficient(1), y, coefficient(2))));
            }
        }
}

/// Returns true if directions suffice: all samples are certainly inside their triangles, and no attribute depends
/// on the position on the triangle.
template <VertexShader S, typename D>
bool StripSolver<S, D>::may_solve_directions(const StripPlace& place, const ReadStrip& samples) const {
    return Sixteen::kDirections && (samples.seen & ~(samples.on_mesh & place.inside)) == 0 && samples.all_easy();
}

template <VertexShader S, typename D>
template <typename Positions>
void StripSolver<S, D>::solve_at(const ReadStrip& samples, const Positions& positions, Solved& strip) const {
    samples.with_own([&](const auto& own) {
        if (strip.directions)
            solve_directions(own, positions, strip);
        else
            solve_lanes(own, positions, strip);
    });
}

template <VertexShader S, typename D>
void StripSolver<S, D>::mend_strip(const StripPlace& place, const ReadStrip& samples, Solved& strip) const {
    for (std::uint32_t left = samples.on_mesh & ~strip.inside; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        const Run& run = run_of(samples.id(i));
        const WholeTriangle whole = triangles_.whole(run, Triangles::index(run, samples.id(i)));
        const Interpolated here = interpolate(whole, place.position(i));
        strip.b1[i] = static_cast<float>(here.b1 / here.sum);
        strip.b2[i] = static_cast<float>(here.b2 / here.sum);
        strip.depth[i] = static_cast<D>(here.depth_sum / here.sum);
        const auto kept = static_cast<std::size_t>(samples.kept[i]), lane = kept % kStrip;
        const Sixteen& set_up = set_ups_.sixteen(kept / kStrip);
        for (std::size_t c = 0; c < kCount; ++c)
            strip.at[c][i] = set_up.n[c][lane] + set_up.n1[c][lane] * strip.b1[i] + set_up.n2[c][lane] * strip.b2[i];
    }
}

template <VertexShader S, typename D>
void StripSolver<S, D>::solve_one(const StripPlace& place, const ReadStrip& samples, Solved& strip, bool mend) {
    strip.samples = &samples;
    strip.object_view = nullptr;
    if (samples.on_mesh == 0) return;
    set_ups_.use(*samples.object, *samples.shape, samples.first_id);
    strip.object_view = &set_ups_.object();
    strip.directions = may_solve_directions(place, samples);
    if (place.offsets == nullptr) {
        if (place.offset != grid_offset_) set_grid(place.offset);
        const auto column = static_cast<std::size_t>(place.x - origin_x_),
                   row = static_cast<std::size_t>(place.y - origin_y_);
        solve_at(samples, strips::OnGrid<D>{column, row, grid_xs_, grid_ys_}, strip);
    } else {
        strips::Scattered<D> positions;
        for (std::size_t i = 0; i < kStrip; ++i) {
            const Vec2d p = place.position(i);
            positions.xs[i] = static_cast<D>(p.x - origin_x_);
            positions.ys[i] = static_cast<D>(p.y - origin_y_);
        }
        solve_at(samples, positions, strip);
    }
    if (strip.directions) return;
    strip.inside &= samples.on_mesh;
    if (mend) mend_strip(place, samples, strip);
}

/// Sets the samples' offset in their pixels for the following packets.
template <VertexShader S, typename D> void StripSolver<S, D>::set_grid(SampleOffset offset) {
    grid_offset_ = offset;
    const Vec2d first = offset.position(0, 0);
    for (std::size_t i = 0; i < kStrip; ++i) {
        grid_xs_[i] = kColumns<D>[i] + static_cast<D>(first.x);
        grid_ys_[i] = kRows<D>[i] + static_cast<D>(first.y);
    }
}

/// Reads as many packets as there is room for, and sets up their triangles together with SIMD. Returns the number
/// of packets.
template <VertexShader S, typename D> std::size_t StripSolver<S, D>::read(std::span<const StripPlace> places) {
    if (!set_ups_.has_room()) set_ups_.forget();
    std::size_t count = 0;
    for (; count < std::min(kMost, places.size()) && set_ups_.has_room(); ++count) {
        ReadStrip& strip = read_[count];
        reader_.read(places[count].ids, strip);
        if (strip.on_mesh == 0) continue;
        set_ups_.use(*strip.object, *strip.shape, strip.first_id);
        set_ups_.keep(strip.ids, strip.kept);
    }
    set_ups_.finish();
    for (std::size_t s = 0; s < count; ++s)
        if (read_[s].on_mesh != 0) read_[s].find_pairs(set_ups_);
    return count;
}

template <VertexShader S, typename D>
template <typename Use>
void StripSolver<S, D>::solve(std::span<const StripPlace> places, bool mend, const Use& use) {
    for (std::size_t first = 0; first < places.size();) {
        const std::size_t count = read(places.subspan(first));
        for (std::size_t i = 0; i < count; i += kTogether) {
            const std::size_t end = std::min(i + kTogether, count);
            for (std::size_t s = i; s < end; ++s) solve_one(places[first + s], read_[s], solved_[s - i], mend);
            use(first + i, std::span<const Solved>(solved_).first(end - i));
        }
        first += count;
    }
}

} // namespace duet::raster
