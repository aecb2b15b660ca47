// Computes barycentrics, depth and a shader's varyings for a packet of sixteen samples with SIMD.
#pragma once

#include "raster/visibility/packet_setups.h"

#include <limits>
#include <span>

namespace duet::raster {

/// Holds the solution of a packet whose samples see triangles of one object, or a sphere.
template <VertexShader S, typename D> struct InterpolatedPacket {
    static constexpr std::size_t kCount = kVaryings<S>;
    static constexpr bool kDerivatives = wants_derivatives<S>();

    const PacketPrimitives* samples = nullptr;
    const ObjectView* object_view = nullptr; ///< null if the packet does not see triangles of exactly one object
    std::array<PacketOf<float>, kCount> at;  ///< varyings
    std::array<PacketOf<float>, kDerivatives ? kCount : 0> dx, dy; ///< screen-space derivatives of the varyings
    std::array<PacketOf<float>, 3> ng;                             ///< like VertexInput::ng
    PacketOf<float> b1, b2; ///< barycentrics of the second and third corner; with D = double as in a Hit
    PacketOf<D> depth;      ///< camera-space −z, meters
    /// These are the derivatives of b1 and b2 along the row and the column, if requested.
    std::array<PacketOf<float>, 2> b1_steps, b2_steps;
    /// The bit of a sample is set if the sample is certainly inside the unsnapped triangle, where the solution is
    /// accurate.
    std::uint32_t inside = 0;
};

/// Interpolates varyings and depth at the samples of a packet if all see triangles of one object. S's vertex function
/// computes the varyings. D is the precision: double, or float with errors below 2^-13, mostly below 2^-20, in
/// barycentrics and depth (kSteepest).
template <VertexShader S, typename D> class PacketInterpolator {
public:
    using ResultPacket = InterpolatedPacket<S, D>;

    /// `tile` is the rectangle of the tile that all packets lie in. `steps` requests the derivatives of the
    /// barycentrics.
    PacketInterpolator(const Triangles& triangles, const PassView& view, const PixelRect& tile, const S& shader,
                       bool steps)
        : triangles_(triangles), view_(view), reader_(triangles), setups_(triangles, view, tile, shader),
          origin_x_(tile.x0), origin_y_(tile.y0), with_derivatives_(steps) {}

    /// Calls use(first, results) for a few packets at a time. `results` holds the solutions of consecutive packets from
    /// packets[first] on, and is valid until use() returns. `recompute_inexact` recomputes the samples with inaccurate
    /// solutions one by one.
    template <typename Use>
    void interpolate_packets(std::span<const SamplePacket> packets, bool recompute_inexact, const Use& use);
    const Run& run_of(std::uint32_t id) const { return reader_.run_of(id); }

private:
    static constexpr std::size_t kCount = ResultPacket::kCount;
    static constexpr bool kDerivatives = ResultPacket::kDerivatives;
    using Setups = SetupPacket<S, D>;
    using PacketSetups = raster::PacketSetups<S, D>;
    using Ds = xsimd::batch<D>;
    static constexpr std::size_t kParts = Floats::size / Ds::size;

    /// The value of a plane at (x, y) relative to its origin has an error of at most 4ε·M, where ε is half a unit
    /// in the last place and M = steepest·(|x| + |y|) + greatest: the coefficients, their products (which fused
    /// multiply-add does not round) and both sums are rounded, each with an error of at most ε·M. The third
    /// barycentric, Σe minus the other two, accumulates three of these errors and two roundings of less than 4ε·M:
    /// 20ε·M in all.
    static constexpr D kError = 16 * std::numeric_limits<D>::epsilon(); // 32ε
    /// The upper bound of M/Σe limits the error of the barycentrics e/Σe, which is 8ε·M/Σe and two roundings.
    static constexpr D kSteepest = Setups::kSteepest;

    void set_grid(SampleOffset offset);
    std::size_t read(std::span<const SamplePacket> packets);
    void interpolate_one(const SamplePacket& packet, const PacketSetups& samples, ResultPacket& result,
                         bool recompute_inexact);
    template <typename Positions>
    void interpolate_at(const PacketSetups& samples, const Positions& positions, ResultPacket& result) const;
    template <typename Lookup, typename Positions>
    void interpolate_lanes(const Lookup& lookup, const Positions& positions, ResultPacket& result) const;
    template <typename Lookup>
    static void interpolate_varyings(const Lookup& lookup, std::size_t i, ResultPacket& result);
    void recompute_inexact_samples(const SamplePacket& packet, const PacketSetups& samples, ResultPacket& result) const;

    const Triangles& triangles_;
    const PassView& view_;
    PacketReader reader_;
    SetupCache<S, D> setups_;
    int origin_x_, origin_y_;
    bool with_derivatives_;
    SampleOffset grid_offset_{0, 0};
    /// These are the positions of samples at `grid_offset_`, relative to their packet's first pixel.
    PacketOf<D> grid_xs_ = kColumns<D>, grid_ys_ = kRows<D>;
    /// The triangles of kMost packets are set up together. kAtOnce packets are solved together: enough for their work
    /// to overlap, few enough to fit into the L1 cache.
    static constexpr std::size_t kMost = 64, kAtOnce = 8;
    std::array<PacketSetups, kMost> packets_of_setups_;
    std::array<ResultPacket, kAtOnce> results_;
};

/// Declares no varyings, for users that need only barycentrics and depths.
struct NoVaryings {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> struct Varyings {};
    template <typename T> Varyings<T> vertex(const VertexInput<T>&) const { return {}; }
};
/// Interpolates only the vertex normals, which the fragment function normalizes.
struct NormalVaryings {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> struct Varyings { Vec3T<T> n; };
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const { return {v.n}; }
};

namespace packet_detail {

template <typename Packets> Vec3T<Floats> vector(const Packets& v, std::size_t first, std::size_t i) {
    return {load(v[first], i), load(v[first + 1], i), load(v[first + 2], i)};
}

/// The table holds the pixel indices of a tile, converted to D. A table lookup is faster than the conversion, which
/// would be on the critical path.
template <typename D>
inline const std::array<D, TileGrid::kTileSize> kPixels = [] {
    std::array<D, TileGrid::kTileSize> numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<D>(i);
    return numbers;
}();

/// Computes the positions of samples relative to the tile's corner: on a regular grid (GridPositions) or one by one
/// (ScatteredPositions). They are exact, even as floats.
template <typename D> struct GridPositions {
    std::size_t column, row;   ///< column and row of the first pixel
    const PacketOf<D>&xs, &ys; ///< samples relative to the first pixel
    xsimd::batch<D> x(std::size_t i) const { return xsimd::batch<D>(kPixels<D>[column]) + load(xs, i); }
    xsimd::batch<D> y(std::size_t i) const { return xsimd::batch<D>(kPixels<D>[row]) + load(ys, i); }
};
template <typename D> struct ScatteredPositions {
    PacketOf<D> xs, ys;
    xsimd::batch<D> x(std::size_t i) const { return load(xs, i); }
    xsimd::batch<D> y(std::size_t i) const { return load(ys, i); }
};

inline Floats join(const std::array<Floats, 1>& parts) { return parts[0]; }
inline Floats join(const std::array<Doubles, 2>& parts) { return narrowed(parts[0], parts[1]); }

} // namespace packet_detail

/// The barycentrics are bᵢ = eᵢ / Σe, and the depth is Σ(e·depth) / Σe (see Interpolation). The derivative of
/// such a quotient by x is (eᵢ' − bᵢ·(Σe)') / Σe.
template <VertexShader S, typename D>
template <typename Lookup, typename Positions>
void PacketInterpolator<S, D>::interpolate_lanes(const Lookup& lookup, const Positions& positions,
                                                 ResultPacket& result) const {
    using Parts = std::array<Ds, kParts>;
    std::uint32_t inside = 0;
    for (std::size_t i = 0; i < kPacketSize; i += Floats::size) {
        Parts first_b, second_b;
        std::array<Parts, 2> first_steps, second_steps;
        for (std::size_t part = 0; part < kParts; ++part) {
            const std::size_t k = i + part * Ds::size;
            const auto number = [&](PacketOf<D> Setups::*which) {
                return lookup.template get<D>(k, [&](const Setups& s) -> const PacketOf<D>& { return s.*which; });
            };
            const auto coefficient = [&](typename Setups::Plane Setups::*which, std::size_t c) {
                return lookup.template get<D>(k, [&](const Setups& s) -> const PacketOf<D>& { return (s.*which)[c]; });
            };
            const auto plane = [&](typename Setups::Plane Setups::*which) -> std::array<Ds, 3> {
                return {coefficient(which, 0), coefficient(which, 1), coefficient(which, 2)};
            };
            const Ds x = positions.x(k) - number(&Setups::x), y = positions.y(k) - number(&Setups::y);
            const auto value = [&](const std::array<Ds, 3>& p) {
                return multiply_add(p[0], x, multiply_add(p[1], y, p[2]));
            };
            const std::array<Ds, 3> plane1 = plane(&Setups::e1), plane2 = plane(&Setups::e2),
                                    of_sum = plane(&Setups::sum);
            const Ds e1 = value(plane1), e2 = value(plane2), sum = value(of_sum), inverse = Ds(D(1)) / sum;
            const Ds size = multiply_add(number(&Setups::steepest), abs(x) + abs(y), number(&Setups::greatest)),
                     error = size * Ds(kError);
            inside |= lane_bits(e1 >= error && e2 >= error && sum - e1 - e2 >= error && sum * Ds(kSteepest) >= size)
                      << k;
            first_b[part] = e1 * inverse;
            second_b[part] = e2 * inverse;
            const Ds depth_sum =
                view_.viewport.orthographic ? value(plane(&Setups::depth_sum)) : coefficient(&Setups::depth_sum, 2);
            store(result.depth, k, depth_sum * inverse);
            if (!kDerivatives && !with_derivatives_) continue;
            for (std::size_t axis = 0; axis < 2; ++axis) {
                first_steps[axis][part] = (plane1[axis] - first_b[part] * of_sum[axis]) * inverse;
                second_steps[axis][part] = (plane2[axis] - second_b[part] * of_sum[axis]) * inverse;
            }
        }
        store(result.b1, i, packet_detail::join(first_b));
        store(result.b2, i, packet_detail::join(second_b));
        for (std::size_t axis = 0; axis < 2 && (kDerivatives || with_derivatives_); ++axis) {
            store(result.b1_steps[axis], i, packet_detail::join(first_steps[axis]));
            store(result.b2_steps[axis], i, packet_detail::join(second_steps[axis]));
        }
        interpolate_varyings(lookup, i, result);
    }
    result.inside = inside;
}

/// Interpolates the varyings of one batch of samples from the i-th on by their barycentrics.
template <VertexShader S, typename D>
template <typename Lookup>
void PacketInterpolator<S, D>::interpolate_varyings(const Lookup& lookup, std::size_t i, ResultPacket& result) {
    const auto number = [&](typename Setups::VaryingPackets Setups::*which, std::size_t c) {
        return lookup.template get<float>(i, [&](const Setups& s) -> const PacketOf<float>& { return (s.*which)[c]; });
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        store(result.ng[axis], i,
              lookup.template get<float>(i, [&](const Setups& s) -> const PacketOf<float>& { return s.ng[axis]; }));
    const Floats u = load(result.b1, i), v = load(result.b2, i);
    for (std::size_t c = 0; c < kCount; ++c) {
        const Floats along_u = number(&Setups::n1, c), along_v = number(&Setups::n2, c);
        store(result.at[c], i, multiply_add(along_u, u, multiply_add(along_v, v, number(&Setups::n, c))));
        if constexpr (kDerivatives) {
            store(result.dx[c], i,
                  Floats(along_u * load(result.b1_steps[0], i) + along_v * load(result.b2_steps[0], i)));
            store(result.dy[c], i,
                  Floats(along_u * load(result.b1_steps[1], i) + along_v * load(result.b2_steps[1], i)));
        }
    }
}

template <VertexShader S, typename D>
template <typename Positions>
void PacketInterpolator<S, D>::interpolate_at(const PacketSetups& samples, const Positions& positions,
                                              ResultPacket& result) const {
    samples.with_lookup([&](const auto& lookup) { interpolate_lanes(lookup, positions, result); });
}

template <VertexShader S, typename D>
void PacketInterpolator<S, D>::recompute_inexact_samples(const SamplePacket& packet, const PacketSetups& samples,
                                                         ResultPacket& result) const {
    for (const std::size_t i : SetBits(samples.on_mesh & ~result.inside)) {
        const Run& run = run_of(samples.id(i));
        const UnclippedTriangle whole = triangles_.unclipped(run, Triangles::index(run, samples.id(i)));
        const Interpolated here = interpolate(whole, packet.position(i));
        result.b1[i] = static_cast<float>(here.b1 / here.sum);
        result.b2[i] = static_cast<float>(here.b2 / here.sum);
        result.depth[i] = static_cast<D>(here.depth_sum / here.sum);
        const auto slots = static_cast<std::size_t>(samples.slots[i]), lane = slots % kPacketSize;
        const Setups& set_up = setups_.packet(slots / kPacketSize);
        for (std::size_t c = 0; c < kCount; ++c)
            result.at[c][i] = set_up.n[c][lane] + set_up.n1[c][lane] * result.b1[i] + set_up.n2[c][lane] * result.b2[i];
    }
}

template <VertexShader S, typename D>
void PacketInterpolator<S, D>::interpolate_one(const SamplePacket& packet, const PacketSetups& samples,
                                               ResultPacket& result, bool recompute_inexact) {
    result.samples = &samples;
    result.object_view = nullptr;
    if (samples.on_mesh == 0) return;
    setups_.use(*samples.object, *samples.shape, samples.first_id);
    result.object_view = &setups_.object();
    if (packet.offsets == nullptr) {
        if (packet.offset != grid_offset_) set_grid(packet.offset);
        const auto column = static_cast<std::size_t>(packet.x - origin_x_),
                   row = static_cast<std::size_t>(packet.y - origin_y_);
        interpolate_at(samples, packet_detail::GridPositions<D>{column, row, grid_xs_, grid_ys_}, result);
    } else {
        packet_detail::ScatteredPositions<D> positions;
        for (std::size_t i = 0; i < kPacketSize; ++i) {
            const Vec2d p = packet.position(i);
            positions.xs[i] = static_cast<D>(p.x - origin_x_);
            positions.ys[i] = static_cast<D>(p.y - origin_y_);
        }
        interpolate_at(samples, positions, result);
    }
    result.inside &= samples.on_mesh;
    if (recompute_inexact) recompute_inexact_samples(packet, samples, result);
}

/// Sets the samples' offset in their pixels for the following packets.
template <VertexShader S, typename D> void PacketInterpolator<S, D>::set_grid(SampleOffset offset) {
    grid_offset_ = offset;
    const Vec2d first = offset.position(0, 0);
    for (std::size_t i = 0; i < kPacketSize; ++i) {
        grid_xs_[i] = kColumns<D>[i] + static_cast<D>(first.x);
        grid_ys_[i] = kRows<D>[i] + static_cast<D>(first.y);
    }
}

/// Reads as many packets as there is room for, and sets up their triangles together with SIMD. Returns the number
/// of packets.
template <VertexShader S, typename D>
std::size_t PacketInterpolator<S, D>::read(std::span<const SamplePacket> packets) {
    if (!setups_.has_room()) setups_.clear();
    std::size_t count = 0;
    for (; count < std::min(kMost, packets.size()) && setups_.has_room(); ++count) {
        PacketSetups& entry = packets_of_setups_[count];
        reader_.read(packets[count].ids, entry);
        if (entry.on_mesh == 0) continue;
        setups_.use(*entry.object, *entry.shape, entry.first_id);
        setups_.lookup_or_insert(entry.ids, entry.slots);
    }
    setups_.finish();
    for (std::size_t s = 0; s < count; ++s)
        if (packets_of_setups_[s].on_mesh != 0) packets_of_setups_[s].find_pairs(setups_);
    return count;
}

template <VertexShader S, typename D>
template <typename Use>
void PacketInterpolator<S, D>::interpolate_packets(std::span<const SamplePacket> packets, bool recompute_inexact,
                                                   const Use& use) {
    for (std::size_t first = 0; first < packets.size();) {
        const std::size_t count = read(packets.subspan(first));
        for (std::size_t i = 0; i < count; i += kAtOnce) {
            const std::size_t end = std::min(i + kAtOnce, count);
            for (std::size_t s = i; s < end; ++s)
                interpolate_one(packets[first + s], packets_of_setups_[s], results_[s - i], recompute_inexact);
            use(first + i, std::span<const ResultPacket>(results_).first(end - i));
        }
        first += count;
    }
}

} // namespace duet::raster
