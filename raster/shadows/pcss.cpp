#include "raster/shadows/pcss.h"

#include "common/sampling/sobol.h"
#include "raster/geometry/sample_positions.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;

/// A blocker must rise above the receiver's plane by this fraction of its distance from the receiver. Facets of a
/// concave surface that meet at up to 6 degrees thus do not shade each other.
constexpr float kLeastRise = 0.1f;
/// This is the rounding error of a depth, and of a point relative to the light, as a fraction of its distance.
constexpr float kRounding = 0x1p-18f;
constexpr float kMargin = 0.02f; ///< a line may miss the light by this fraction of its edge

/// Holds one tap of each pixel in a row: a point (a, b) on the unit square, the same point mapped to the unit disk, and
/// the fraction of the line to the light at which a blocker is searched.
struct Tap {
    PacketOf<float> a, b, disk_x, disk_y, fraction;
};

/// Holds kTaps taps for each row of a block of pixels. The points of the block are a (0,2)-net. So are the points of
/// four neighbors in a row, which share what they find.
template <int kTaps> struct Taps {
    std::array<std::array<Tap, kTaps>, kDitherSide> rows;

    Taps() {
        constexpr int kPixels = kDitherSide * kDitherSide;
        for (int y = 0; y < kDitherSide; ++y)
            for (int k = 0; k < kTaps; ++k)
                for (int x = 0; x < static_cast<int>(kPacketSize); ++x) {
                    const int rank = y * kDitherSide + (x ^ y) % kDitherSide;
                    const Vec2 u = sobol_net_point(static_cast<std::uint32_t>(k * kPixels + rank), kTaps * kPixels);
                    const float radius = std::sqrt(u.x), angle = 2 * kPi * u.y;
                    // Searched fractions grow quadratically, so that blockers near the receiver are found, too.
                    const float stratum = (static_cast<float>(rank * 7 % kPixels) + 0.5f) / kPixels,
                                s = (static_cast<float>(k) + stratum) / kTaps;
                    Tap& tap = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(k)];
                    const auto lane = static_cast<std::size_t>(x);
                    tap.a[lane] = u.x, tap.b[lane] = u.y, tap.fraction[lane] = s * s;
                    tap.disk_x[lane] = radius * std::cos(angle), tap.disk_y[lane] = radius * std::sin(angle);
                }
    }
    const std::array<Tap, kTaps>& row(int y) const { return rows[static_cast<std::size_t>(y % kDitherSide)]; }
};
const Taps<SoftShadowMap::kSearchTaps> kSearch;
const Taps<SoftShadowMap::kFilterTaps> kFilter;

/// Returns in each lane the sum over its group of four lanes, which are neighbors in a row.
Floats sum_of_four(const Floats& x) {
    static_assert(Floats::size % kDitherSide == 0);
    PacketOf<float> lanes;
    store(lanes, 0, x);
    for (std::size_t i = 0; i < Floats::size; i += kDitherSide)
        std::fill_n(&lanes[i], kDitherSide, (lanes[i] + lanes[i + 1]) + (lanes[i + 2] + lanes[i + 3]));
    return load(lanes, 0);
}

} // namespace

/// Represents the light as seen from a receiver: points corner + a·u + b·v with a, b in [0, 1], or a disk.
struct LightOutline {
    Vec3s corner, u, v, dual_u, dual_v;
    Floats per_u, per_v; ///< lengths of dual_u and dual_v
    Emitter::Kind shape; ///< kSphere stands for a disk
    Vec3s axis; ///< unit direction from the receiver's side to the light's plane
};

namespace {

/// Represents points that receive light. surface(q, texel) returns the point that the map sees in direction q from
/// the light's center, and the width of its texel there.
template <typename Surface> struct Receiver {
    const Surface& surface;
    const LightOutline& light;
    Vec3s p, n;
    Floats per_height; ///< 1 / the height of p above the light's plane, along −axis
    Floats slack;
    Floats from_a, from_b; ///< coordinates of p along the light's u and v, from its corner

    /// Returns the fraction of the line from p to the light's plane at which the surface seen in direction q blocks the
    /// light. The fraction is negated in lanes where the surface lies in between but the line misses the light. It is 0
    /// in all other lanes.
    Floats blocker(const Vec3s& q) const {
        Floats texel;
        const Vec3s to = surface(q, texel) - p;
        const Floats f = dot(to, light.axis) * per_height;
        const Floats rise = dot(to, n), distance2 = dot(to, to);
        // The line meets the light's plane at coordinates a / f and b / f. All comparisons are multiplied by f, which
        // saves a division; only lanes with f > 0 count.
        const Floats a = multiply_add(from_a, f, dot(to, light.dual_u)),
                     b = multiply_add(from_b, f, dot(to, light.dual_v));
        // The texel that contains direction q has its center up to this far from q; 1 / f projects it onto the light.
        const Floats reach = texel * Floats(0.7f), margin = f * Floats(kMargin);
        const Floats margin_a = multiply_add(reach, light.per_u, margin),
                     margin_b = multiply_add(reach, light.per_v, margin);
        const Mask inside = (a > -margin_a) & (b > -margin_b) & (a < f + margin_a) & (b < f + margin_b);
        const Mask meets = light.shape == Emitter::Kind::kSphere ? a * a + b * b <= (f + margin_a) * (f + margin_a)
            : light.shape == Emitter::Kind::kTriangle            ? inside & (a + b < f + margin_a + margin_b)
                                                                 : inside;
        const Mask between = (f > Floats(1e-5f)) & (f < Floats(0.9999f)) & (rise > slack) &
                             (rise * rise > Floats(kLeastRise * kLeastRise) * distance2);
        return xsimd::select(between, xsimd::select(meets, f, -f), Floats(0.0f));
    }
    /// Returns the position of a tap on the light.
    Vec3s on_light(const Tap& tap) const {
        if (light.shape == Emitter::Kind::kSphere)
            return light.u * load(tap.disk_x, 0) + light.v * load(tap.disk_y, 0);
        const Floats a = load(tap.a, 0), b = load(tap.b, 0);
        if (light.shape == Emitter::Kind::kTriangle) { // fold the other half of the parallelogram onto it
            const Mask beyond = a + b > Floats(1.0f);
            return light.corner + light.u * xsimd::select(beyond, Floats(1.0f) - a, a) +
                   light.v * xsimd::select(beyond, Floats(1.0f) - b, b);
        }
        return light.corner + light.u * a + light.v * b;
    }
};

/// Returns the visible fraction of a light, for points relative to its center. `surface` is that of a Receiver.
template <typename Surface>
Floats visible_fraction(const Surface& surface, const LightOutline& light, const Vec3s& own, const Vec3s& n, int y,
                        const Mask& lanes) {
    const Floats height = max(-dot(own, light.axis), Floats(1e-20f));
    const Vec3s from = own - light.corner;
    const Receiver<Surface> receiver{surface, light, own, n, Floats(1.0f) / height, height * Floats(kRounding),
                            dot(from, light.dual_u), dot(from, light.dual_v)};

    Floats sum(0.0f), count(0.0f);
    for (const Tap& tap : kSearch.row(y)) {
        const Floats f = load(tap.fraction, 0);
        const Floats found = receiver.blocker(own * (Floats(1.0f) - f) + receiver.on_light(tap) * f);
        const Mask blocks = lanes & (found > Floats(0.0f));
        sum += xsimd::select(blocks, found, Floats(0.0f));
        count += xsimd::select(blocks, Floats(1.0f), Floats(0.0f));
    }
    if (!xsimd::any(count > Floats(0.0f))) return Floats(1.0f);
    // Four neighbors in a row share what they found, because a thin blocker may escape the few taps of one of them.
    sum = sum_of_four(sum), count = sum_of_four(count);
    const Mask any = count > Floats(0.0f);
    const Floats f = sum / max(count, Floats(1.0f));
    Floats dark(0.0f);
    for (const Tap& tap : kFilter.row(y)) {
        const Vec3s l = receiver.on_light(tap);
        const auto found_at = [&](const Floats& at) { return receiver.blocker(own * (Floats(1.0f) - at) + l * at); };
        Floats found = found_at(f);
        // If the line misses a blocker beside it at another depth, it is tested at that depth, too.
        if (const Mask beside = found < Floats(0.0f); xsimd::any(any & beside))
            found = xsimd::select(beside, found_at(-found), found);
        dark += xsimd::select(found > Floats(0.0f), Floats(1.0f), Floats(0.0f));
    }
    return xsimd::select(any, Floats(1.0f) - dark * Floats(1.0f / SoftShadowMap::kFilterTaps), Floats(1.0f));
}

/// Returns a disk around the light's center that is seen along `axis`, a unit vector, from a distance. `sine` is that
/// of its angular radius.
LightOutline disk(const Vec3s& axis, const Floats& distance, const Floats& sine) {
    const FrameT<Floats> frame = frame_from_normal(axis);
    const Floats radius = distance * sine / xsimd::sqrt(Floats(1.0f) - sine * sine), over = Floats(1.0f) / radius;
    const Vec3s none{Floats(0.0f), Floats(0.0f), Floats(0.0f)};
    return {none, frame.s * radius, frame.t * radius, frame.s * over, frame.t * over, over, over,
            Emitter::Kind::kSphere, axis};
}

} // namespace

SoftShadowMap::SoftShadowMap(const CellMaps& maps, const Emitter& emitter)
    : cube_(maps.all), near_visibility_(maps.near_visibility), reach_(maps.reach), kind_(emitter.kind),
      radius_(static_cast<float>(emitter.radius)) {
    if (maps.distant) distant_.emplace(*maps.distant);
    if (kind_ == Emitter::Kind::kSphere) return;
    const Vec3d u = emitter.u, v = emitter.v, n = cross(u, v);
    const double over = 1 / dot(n, n);
    u_ = Vec3(cube_.frame.to_local(u)), v_ = Vec3(cube_.frame.to_local(v));
    dual_u_ = Vec3(cube_.frame.to_local(cross(v, n) * over)), dual_v_ = Vec3(cube_.frame.to_local(cross(n, u) * over));
    corner_ = (u_ + v_) * (kind_ == Emitter::Kind::kTriangle ? -1.0f / 3 : -0.5f);
}

std::size_t SoftShadowMap::memory_bytes() const {
    return cube_.memory_bytes() + (distant_ ? distant_->memory_bytes() : 0) + near_visibility_.memory_bytes();
}

LightOutline SoftShadowMap::outline_from(const Vec3s& p) const {
    if (kind_ != Emitter::Kind::kSphere) {
        const Floats toward = xsimd::select(p.z < Floats(0.0f), Floats(1.0f), Floats(-1.0f));
        return {broadcast<Floats>(corner_), broadcast<Floats>(u_), broadcast<Floats>(v_),
                broadcast<Floats>(dual_u_), broadcast<Floats>(dual_v_), Floats(length(dual_u_)),
                Floats(length(dual_v_)), kind_, {Floats(0.0f), Floats(0.0f), toward}};
    }
    // A sphere is replaced by the disk through its center that fills the cone tangent to it.
    const Floats distance = xsimd::sqrt(max(dot(p, p), Floats(1e-30f)));
    return disk(p * (Floats(-1.0f) / distance), distance, min(Floats(radius_) / distance, Floats(0.999f)));
}

/// Returns the vector in the cube's frame.
Vec3s SoftShadowMap::local(const Vec3s& w) const {
    const auto axis = [&](Vec3d a) { return dot(w, broadcast<Floats>(Vec3(a))); };
    return {axis(cube_.frame.s), axis(cube_.frame.t), axis(cube_.frame.n)};
}

/// Combines the results of a lookup in the maps, for points in the cube's frame. Within the reach of near casters, the
/// result is the visible fraction past all casters. From twice the reach on, it is the product of the fractions past
/// near and past distant casters, which are thus taken to be independent.
template <typename Lookup> Floats SoftShadowMap::combined(const Vec3s& p, const Lookup& lookup) const {
    if (!distant_) return lookup(cube_);
    const Floats zero(0.0f), one(1.0f);
    const Floats away = clamp(max(abs(p.x), max(abs(p.y), abs(p.z))) * Floats(1 / reach_) - one, zero, one);
    Floats near = near_visibility_.at<1>(p)[0] * away;
    if (xsimd::any(near > zero)) near *= lookup(*distant_);
    return xsimd::all(away == one) ? near : near + lookup(cube_) * (one - away);
}

Floats SoftShadowMap::visibility(const Vec3d& eye, const Vec3s& p) const {
    const Vec3s own = local(p + broadcast<Floats>(Vec3(eye - cube_.center)));
    return combined(own, [&](const DepthCube& cube) {
        Floats texel;
        const Vec3s seen = cube.surface(own, texel);
        return xsimd::select(dot(own, own) > dot(seen, seen) * Floats(1 + kRounding), Floats(0.0f), Floats(1.0f));
    });
}

Floats SoftShadowMap::visibility(const Vec3d& eye, const Vec3s& p, const Vec3s& n, int y, const Mask& lanes) const {
    const Vec3s own = local(p + broadcast<Floats>(Vec3(eye - cube_.center))), normal = local(n);
    return combined(own, [&](const DepthCube& cube) {
        const auto surface = [&](const Vec3s& w, Floats& texel) { return cube.surface(w, texel); };
        return visible_fraction(surface, outline_from(own), own, normal, y, lanes);
    });
}

Floats sun_visibility(const SharpShadowMap& map, float sine, const Vec3s& p, const Vec3s& n, int y, const Mask& lanes,
                      Mask& inside) {
    // The disk is where the map begins, which is before all casters, straight above each point.
    const Vec3s toward = broadcast<Floats>(-map.direction());
    const Floats distance = max(map.depth(p, sine, inside), Floats(1e-20f));
    const Vec3s center = p + toward * distance;
    const auto surface = [&](const Vec3s& w, Floats& texel) {
        texel = Floats(map.texel());
        return map.surface(center + w) - center;
    };
    return visible_fraction(surface, disk(toward, distance, Floats(sine)), p - center, n, y, lanes & inside);
}

} // namespace duet::raster
