// Where on its triangle each of sixteen samples lies, side by side: barycentrics, depth, and a shader's varyings.
#pragma once

#include "raster/set_ups.h"
#include "raster/strip_samples.h"

#include <bit>
#include <span>

namespace duet::raster {

/// Where the samples of a strip that see a mesh's triangle lie on it.
template <VertexShader S> struct SolvedStrip {
    static constexpr std::size_t kCount = kVaryings<S>;
    static constexpr bool kDerivatives = wants_derivatives<S>();

    const StripSamples* samples = nullptr;
    const ObjectView* object_view = nullptr;
    std::array<StripOf<float>, kCount> at;                        ///< varyings
    std::array<StripOf<float>, kDerivatives ? kCount : 0> dx, dy; ///< and their derivatives by the sample's place
    std::array<StripOf<float>, 3> ng;                             ///< VertexInput::ng
    StripOf<float> b1, b2; ///< barycentrics of the second and third corner, as a Hit has them: rounded here, and nowhere else
    StripOf<double> depth;                                        ///< camera-space −z
    std::array<StripOf<float>, 2> b1_steps, b2_steps; ///< if asked for: derivatives of b1 and b2, along the row and the column
    /// A bit for each sample that lies in the unsnapped triangle, where the solution holds as it is.
    std::uint32_t inside = 0;
};

/// Solves for the samples that see a mesh's triangle; S's vertex function is asked for what is interpolated.
template <VertexShader S> class StripSolver {
public:
    using Solved = SolvedStrip<S>;
    static constexpr std::size_t kMost = 32; ///< strips at a time

    /// Pixels are counted from the tile's corner. `steps`: find the barycentrics' derivatives, too.
    StripSolver(const Triangles& triangles, const PassView& view, const PixelRect& tile, const S& shader, bool steps)
        : triangles_(triangles), view_(view), reader_(triangles), set_ups_(triangles, view, tile, shader),
          origin_x_(tile.x0), origin_y_(tile.y0), steps_(steps) {}

    /// For up to kMost strips: use(i, strip) for each of them, in any order; `strip` is there until use() returns, solved if
    /// it sees a mesh. `mend`: solve otherwise where the solution does not hold as it is.
    template <typename Use> void solve(std::span<const StripPlace> places, bool mend, const Use& use);
    const Run& run_of(std::uint32_t id) const { return reader_.run_of(id); }

private:
    static constexpr std::size_t kCount = Solved::kCount, kFew = 8;
    static constexpr bool kDerivatives = Solved::kDerivatives;
    using One = typename SetUps<S>::One;
    using Many = typename SetUps<S>::Many;

    struct ReadStrip : StripSamples {
        bool each = false;   ///< so many triangles that each sample's is worked on by itself, side by side
        std::size_t few = 0; ///< else: how many there are
        std::array<std::uint32_t, kFew> few_lanes{}, few_kept{}; ///< a bit for each of their samples; where their set-ups are
    };

    /// The set-ups of a strip's samples: each its own, or some, each for several samples. for_each<T>() calls
    /// body(set-up, merge) for each of them; merge(to, value) is for the samples from k on that it is of, as many as a batch
    /// of T has lanes.
    struct OfEach {
        const Many& many;
        template <typename T, typename Body> void for_each(std::size_t, const Body& body) const {
            body(many, [](auto& to, const auto& value) { to = value; });
        }
    };
    struct OfFew {
        const SetUps<S>& set_ups;
        const ReadStrip& strip;
        template <typename T, typename Body> void for_each(std::size_t k, const Body& body) const {
            body(set_ups.kept(strip.few_kept[0]), [](auto& to, const auto& value) { to = value; });
            for (std::size_t i = 1; i < strip.few; ++i) {
                const xsimd::batch_bool<T> here = lanes_from<T>(strip.few_lanes[i] >> k);
                body(set_ups.kept(strip.few_kept[i]), [&](auto& to, const auto& value) { to = xsimd::select(here, value, to); });
            }
        }
    };
    void read(std::span<const StripPlace> places);
    void solve_one(const StripPlace& place, const ReadStrip& samples, Solved& strip, bool mend);
    template <typename SetUpsOf> void solve_at(const SetUpsOf& set_ups, const StripPlace& place, Solved& strip) const;
    template <typename SetUpsOf, typename Positions>
    void solve_lanes(const SetUpsOf& set_ups, const Positions& positions, Solved& strip) const;
    void mend_strip(const Many* many, const StripPlace& place, const ReadStrip& samples, Solved& strip) const;

    const Triangles& triangles_;
    const PassView& view_;
    StripReader reader_;
    SetUps<S> set_ups_;
    int origin_x_, origin_y_;
    bool steps_;
    std::array<ReadStrip, kMost> read_;
    static constexpr std::size_t kTogether = 8; ///< enough for one's work to overlap with the next's, few enough for the first cache
    std::array<Solved, kTogether> solved_;
};

/// What has nothing to interpolate: for who wants barycentrics and depths alone.
struct NoVaryings {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> struct Varyings {};
    template <typename T> Varyings<T> vertex(const VertexInput<T>&) const { return {}; }
};
/// What interpolates the vertices' normals alone.
struct NormalVaryings {
    static constexpr bool kTextureCoordinates = false;
    template <typename T> struct Varyings {
        Vec3T<T> n;
    };
    template <typename T> Varyings<T> vertex(const VertexInput<T>& v) const { return {v.n}; }
};

namespace strips {

inline Doubles lanes_of(double value, std::size_t) { return Doubles(value); }
inline Doubles lanes_of(const StripOf<double>& value, std::size_t i) { return load(value, i); }
inline Floats lanes_of(float value, std::size_t) { return Floats(value); }
inline Floats lanes_of(const StripOf<float>& value, std::size_t i) { return load(value, i); }

template <typename Strips> Vec3T<Floats> vector(const Strips& v, std::size_t first, std::size_t i) {
    return {load(v[first], i), load(v[first + 1], i), load(v[first + 2], i)};
}

/// Where samples lie, from the tile's corner: on a grid, or each at its own place.
struct OnGrid {
    Vec2d first;
    Doubles x(std::size_t i) const { return Doubles(first.x) + load(kColumns<double>, i); }
    Doubles y(std::size_t i) const { return Doubles(first.y) + load(kRows<double>, i); }
};
struct Scattered {
    StripOf<double> xs, ys;
    Doubles x(std::size_t i) const { return load(xs, i); }
    Doubles y(std::size_t i) const { return load(ys, i); }
};

} // namespace strips

/// Barycentrics are bᵢ = eᵢ / Σe, depth is Σ(e·depth) / Σe: see Interpolation. The derivative of such a quotient by x is
/// (eᵢ' − bᵢ·(Σe)') / Σe.
template <VertexShader S>
template <typename SetUpsOf, typename Positions>
void StripSolver<S>::solve_lanes(const SetUpsOf& set_ups, const Positions& positions, Solved& strip) const {
    using strips::lanes_of;
    const Doubles zero(0.0);
    std::uint32_t inside = 0;
    for (std::size_t i = 0; i < kStrip; i += Floats::size) {
        std::array<Doubles, 2> first_b, second_b, d1_dx{zero, zero}, d1_dy{zero, zero}, d2_dx{zero, zero}, d2_dy{zero, zero};
        for (std::size_t half = 0; half < 2; ++half) {
            const std::size_t k = i + half * Doubles::size;
            const Doubles x = positions.x(k), y = positions.y(k);
            Doubles e1 = zero, e2 = zero, sum = zero, depth_sum = zero;
            set_ups.template for_each<double>(k, [&](const auto& one, const auto& merge) {
                const auto value = [&](const auto& plane) {
                    return fused(lanes_of(plane[0], k), x, fused(lanes_of(plane[1], k), y, lanes_of(plane[2], k)));
                };
                merge(e1, value(one.e1));
                merge(e2, value(one.e2));
                merge(sum, value(one.sum));
                // Under perspective Σ(e·depth) is the same everywhere, and its coefficients of x and y are noise.
                merge(depth_sum, view_.viewport.orthographic ? value(one.depth_sum) : lanes_of(one.depth_sum[2], k));
            });
            const Doubles inverse = Doubles(1.0) / sum;
            inside |= lane_bits(e1 >= zero && e2 >= zero && sum - e1 - e2 >= zero && sum > zero) << k;
            first_b[half] = e1 * inverse;
            second_b[half] = e2 * inverse;
            if (kDerivatives || steps_)
                set_ups.template for_each<double>(k, [&](const auto& one, const auto& merge) {
                    const auto along = [&](const auto& plane, const Doubles& b, std::size_t axis) -> Doubles {
                        return (lanes_of(plane[axis], k) - b * lanes_of(one.sum[axis], k)) * inverse;
                    };
                    merge(d1_dx[half], along(one.e1, first_b[half], 0));
                    merge(d1_dy[half], along(one.e1, first_b[half], 1));
                    merge(d2_dx[half], along(one.e2, second_b[half], 0));
                    merge(d2_dy[half], along(one.e2, second_b[half], 1));
                });
            store(strip.depth, k, depth_sum * inverse);
        }
        const Floats u = narrowed(first_b[0], first_b[1]), v = narrowed(second_b[0], second_b[1]);
        store(strip.b1, i, u);
        store(strip.b2, i, v);
        std::array<Floats, kCount> at_here;
        Vec3T<Floats> ng_here;
        set_ups.template for_each<float>(i, [&](const auto& one, const auto& merge) {
            for (std::size_t c = 0; c < kCount; ++c)
                merge(at_here[c], fused(lanes_of(one.n1[c], i), u, fused(lanes_of(one.n2[c], i), v, lanes_of(one.n[c], i))));
            merge(ng_here.x, lanes_of(one.ng[0], i));
            merge(ng_here.y, lanes_of(one.ng[1], i));
            merge(ng_here.z, lanes_of(one.ng[2], i));
        });
        for (std::size_t c = 0; c < kCount; ++c) store(strip.at[c], i, at_here[c]);
        store(strip.ng[0], i, ng_here.x);
        store(strip.ng[1], i, ng_here.y);
        store(strip.ng[2], i, ng_here.z);
        if (!kDerivatives && !steps_) continue;
        const Floats u_dx = narrowed(d1_dx[0], d1_dx[1]), v_dx = narrowed(d2_dx[0], d2_dx[1]);
        const Floats u_dy = narrowed(d1_dy[0], d1_dy[1]), v_dy = narrowed(d2_dy[0], d2_dy[1]);
        store(strip.b1_steps[0], i, u_dx);
        store(strip.b1_steps[1], i, u_dy);
        store(strip.b2_steps[0], i, v_dx);
        store(strip.b2_steps[1], i, v_dy);
        if constexpr (kDerivatives) {
            std::array<Floats, kCount> dx_here, dy_here;
            set_ups.template for_each<float>(i, [&](const auto& one, const auto& merge) {
                for (std::size_t c = 0; c < kCount; ++c) {
                    merge(dx_here[c], Floats(lanes_of(one.n1[c], i) * u_dx + lanes_of(one.n2[c], i) * v_dx));
                    merge(dy_here[c], Floats(lanes_of(one.n1[c], i) * u_dy + lanes_of(one.n2[c], i) * v_dy));
                }
            });
            for (std::size_t c = 0; c < kCount; ++c) {
                store(strip.dx[c], i, dx_here[c]);
                store(strip.dy[c], i, dy_here[c]);
            }
        }
    }
    strip.inside = inside;
}

template <VertexShader S>
template <typename SetUpsOf>
void StripSolver<S>::solve_at(const SetUpsOf& set_ups, const StripPlace& place, Solved& strip) const {
    if (place.offsets == nullptr) {
        solve_lanes(set_ups, strips::OnGrid{place.offset.position(place.x - origin_x_, place.y - origin_y_)}, strip);
        return;
    }
    strips::Scattered positions;
    for (std::size_t i = 0; i < kStrip; ++i) {
        const Vec2d p = place.position(i);
        positions.xs[i] = p.x - origin_x_;
        positions.ys[i] = p.y - origin_y_;
    }
    solve_lanes(set_ups, positions, strip);
}

template <VertexShader S>
void StripSolver<S>::mend_strip(const Many* many, const StripPlace& place, const ReadStrip& samples, Solved& strip) const {
    for (std::uint32_t left = samples.on_mesh & ~strip.inside; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        const Run& run = run_of(samples.id(i));
        const WholeTriangle whole = triangles_.whole(run, Triangles::index(run, samples.id(i)));
        const Interpolated here = interpolate(whole, place.position(i));
        strip.b1[i] = static_cast<float>(here.b1 / here.sum);
        strip.b2[i] = static_cast<float>(here.b2 / here.sum);
        strip.depth[i] = here.depth_sum / here.sum;
        const One* one = nullptr;
        for (std::size_t k = 0; k < samples.few && many == nullptr; ++k)
            if (samples.few_lanes[k] >> i & 1) one = &set_ups_.kept(samples.few_kept[k]);
        for (std::size_t c = 0; c < kCount; ++c)
            strip.at[c][i] = one != nullptr ? one->n[c] + one->n1[c] * strip.b1[i] + one->n2[c] * strip.b2[i]
                                            : many->n[c][i] + many->n1[c][i] * strip.b1[i] + many->n2[c][i] * strip.b2[i];
    }
}

template <VertexShader S>
void StripSolver<S>::solve_one(const StripPlace& place, const ReadStrip& samples, Solved& strip, bool mend) {
    strip.samples = &samples;
    if (samples.on_mesh == 0) return;
    set_ups_.use(*samples.object, *samples.mesh, samples.first_id);
    strip.object_view = &set_ups_.object();
    const Many* many = samples.each ? &set_ups_.set_up(samples.ids) : nullptr;
    if (many != nullptr)
        solve_at(OfEach{*many}, place, strip);
    else
        solve_at(OfFew{set_ups_, samples}, place, strip);
    strip.inside &= sabotaged(Guard::kPerspective) ? 0 : samples.on_mesh;
    if (mend) mend_strip(many, place, samples, strip);
}

/// Reads all, and sets up what they see, side by side across strips.
template <VertexShader S> void StripSolver<S>::read(std::span<const StripPlace> places) {
    set_ups_.make_room(places.size() * kFew);
    for (std::size_t s = 0; s < places.size(); ++s) {
        ReadStrip& strip = read_[s];
        reader_.read(places[s].ids, strip);
        if (strip.on_mesh == 0) continue;
        std::uint32_t firsts = first_of_each(strip.ids);
        strip.few = static_cast<std::size_t>(std::popcount(firsts));
        strip.each = strip.few > kFew;
        if (strip.each) continue;
        set_ups_.use(*strip.object, *strip.mesh, strip.first_id);
        for (std::size_t k = 0; k < strip.few; ++k, firsts &= firsts - 1) {
            const std::int32_t id = strip.ids[static_cast<std::size_t>(std::countr_zero(firsts))];
            strip.few_lanes[k] = lanes_of_number(strip.ids, id);
            strip.few_kept[k] = set_ups_.keep(static_cast<std::uint32_t>(id));
        }
    }
    set_ups_.finish();
}

// By the number of triangles they see: so many branches go the same way, one strip after the other, and one's work overlaps
// with the next's.
template <VertexShader S>
template <typename Use>
void StripSolver<S>::solve(std::span<const StripPlace> places, bool mend, const Use& use) {
    static_assert(kMost * kFew <= SetUps<S>::kRoom);
    read(places);
    constexpr std::size_t kKinds = kFew + 2; // none, 1 to kFew, each
    const auto kind = [&](std::size_t s) { return read_[s].on_mesh == 0 ? 0 : read_[s].each ? kFew + 1 : read_[s].few; };
    std::array<std::size_t, kKinds + 1> first{};
    for (std::size_t s = 0; s < places.size(); ++s) ++first[kind(s) + 1];
    for (std::size_t k = 1; k < kKinds; ++k) first[k] += first[k - 1];
    std::array<std::size_t, kMost> order;
    for (std::size_t s = 0; s < places.size(); ++s) order[first[kind(s)]++] = s;
    for (std::size_t i = 0; i < places.size(); i += kTogether) {
        const auto some = std::span<const std::size_t>(order).subspan(i, std::min(kTogether, places.size() - i));
        for (std::size_t k = 0; k < some.size(); ++k) solve_one(places[some[k]], read_[some[k]], solved_[k], mend);
        for (std::size_t k = 0; k < some.size(); ++k) use(some[k], solved_[k]);
    }
}

} // namespace duet::raster
