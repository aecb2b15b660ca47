#include "raster/shadows/pcss.h"

#include "common/sampling/sobol.h"

#include <cmath>

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;
using Vec3s = Vec3T<Floats>;

constexpr int kPatterns = 16;
/// A blocker must rise above the receiver's plane by this fraction of its distance from the receiver. Facets of a
/// concave surface that meet at up to 6 degrees thus do not shade each other.
constexpr float kLeastRise = 0.1f;
/// This is the rounding error of a depth, and of a point relative to the light, as a fraction of its distance.
constexpr float kRounding = 0x1p-18f;
constexpr float kMargin = 0.02f; ///< a line may miss the light by this fraction of its edge

/// Holds tap positions by pattern and tap, kPatterns × count in a (0,2)-net: (a, b) on the unit square, and the same
/// points mapped to the unit disk.
template <int kTaps> struct Taps {
    std::array<std::array<float, kPatterns>, kTaps> a, b, disk_x, disk_y, fraction;

    Taps() {
        constexpr int kAll = kPatterns * kTaps;
        for (int pattern = 0; pattern < kPatterns; ++pattern)
            for (int tap = 0; tap < kTaps; ++tap) {
                const auto k = static_cast<std::size_t>(tap), i = static_cast<std::size_t>(pattern);
                const auto index = static_cast<std::uint32_t>(tap * kPatterns + pattern);
                const Vec2 u = sobol_net_point(index, kAll);
                a[k][i] = u.x, b[k][i] = u.y;
                const float radius = std::sqrt(u.x), angle = 2 * kPi * u.y;
                disk_x[k][i] = radius * std::cos(angle), disk_y[k][i] = radius * std::sin(angle);
                // Offsets from the center's direction grow quadratically, so that contacts near the receiver are found,
                // too.
                const float s = (static_cast<float>(tap) + (static_cast<float>(pattern * 7 % kPatterns) + 0.5f) /
                                                               kPatterns) / kTaps;
                fraction[k][i] = s * s;
            }
    }
};
const Taps<SoftShadowMap::kSearchTaps> kSearch;
const Taps<SoftShadowMap::kFilterTaps> kFilter;

} // namespace

struct SoftShadowMap::Outline {
    Vec3s corner, u, v, dual_u, dual_v;
    Floats per_u, per_v; ///< lengths of dual_u and dual_v
    Emitter::Kind shape; ///< kSphere stands for a disk
    Vec3s axis; ///< unit direction from the receiver's side to the light's plane
};

struct SoftShadowMap::Receiver {
    const DepthCube& cube;
    const Outline& light;
    Vec3s p, n;
    Floats per_height; ///< 1 / the height of p above the light's plane, along −axis
    Floats slack;

    /// Returns the fraction of the line from p to the light's plane at which the surface seen in direction q blocks the
    /// light. The fraction is negated in lanes where the surface lies in between but the line misses the light. It is 0
    /// in all other lanes.
    Floats blocker(const Vec3s& q) const {
        Floats texel;
        const Vec3s to = cube.surface(q, texel) - p;
        const Floats f = dot(to, light.axis) * per_height;
        const Floats rise = dot(to, n), distance2 = dot(to, to);
        const Floats scale = Floats(1.0f) / max(f, Floats(1e-6f));
        const Vec3s hit = p + to * scale - light.corner; // intersection of the line with the light's plane
        const Floats a = dot(hit, light.dual_u), b = dot(hit, light.dual_v);
        // The texel that contains direction q has its center up to this far from q, projected onto the light.
        const Floats reach = texel * scale * Floats(0.7f);
        const Floats margin_a = multiply_add(reach, light.per_u, Floats(kMargin)),
                     margin_b = multiply_add(reach, light.per_v, Floats(kMargin)), one(1.0f);
        const Mask inside = (a > -margin_a) & (b > -margin_b) & (a < one + margin_a) & (b < one + margin_b);
        const Mask meets = light.shape == Emitter::Kind::kSphere ? a * a + b * b <= (one + margin_a) * (one + margin_a)
            : light.shape == Emitter::Kind::kTriangle            ? inside & (a + b < one + margin_a + margin_b)
                                                                 : inside;
        const Mask between = (f > Floats(1e-5f)) & (f < Floats(0.9999f)) & (rise > slack) &
                             (rise * rise > Floats(kLeastRise * kLeastRise) * distance2);
        return xsimd::select(between, xsimd::select(meets, f, -f), Floats(0.0f));
    }
    /// Returns the position of a tap on the light.
    template <int kTaps> Vec3s on_light(const Taps<kTaps>& taps, std::size_t tap, const Ints& pattern) const {
        if (light.shape == Emitter::Kind::kSphere)
            return light.u * gather(taps.disk_x[tap].data(), pattern) +
                   light.v * gather(taps.disk_y[tap].data(), pattern);
        const Floats a = gather(taps.a[tap].data(), pattern), b = gather(taps.b[tap].data(), pattern);
        if (light.shape == Emitter::Kind::kTriangle) { // fold the other half of the parallelogram onto it
            const Mask beyond = a + b > Floats(1.0f);
            return light.corner + light.u * xsimd::select(beyond, Floats(1.0f) - a, a) +
                   light.v * xsimd::select(beyond, Floats(1.0f) - b, b);
        }
        return light.corner + light.u * a + light.v * b;
    }
};

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

SoftShadowMap::Outline SoftShadowMap::outline_from(const Vec3s& p) const {
    if (kind_ != Emitter::Kind::kSphere) {
        const Floats towards = xsimd::select(p.z < Floats(0.0f), Floats(1.0f), Floats(-1.0f));
        return {broadcast<Floats>(corner_), broadcast<Floats>(u_), broadcast<Floats>(v_),
                broadcast<Floats>(dual_u_), broadcast<Floats>(dual_v_), Floats(length(dual_u_)),
                Floats(length(dual_v_)), kind_, {Floats(0.0f), Floats(0.0f), towards}};
    }
    // A sphere is replaced by the disk through its center that fills the cone tangent to it.
    const Floats distance = xsimd::sqrt(max(dot(p, p), Floats(1e-30f)));
    const Vec3s axis = p * (Floats(-1.0f) / distance);
    const FrameT<Floats> frame = frame_from_normal(axis);
    const Floats sine = min(Floats(radius_) / distance, Floats(0.999f));
    const Floats radius = Floats(radius_) / xsimd::sqrt(Floats(1.0f) - sine * sine), over = Floats(1.0f) / radius;
    const Vec3s none{Floats(0.0f), Floats(0.0f), Floats(0.0f)};
    return {none, frame.s * radius, frame.t * radius, frame.s * over, frame.t * over, over, over, kind_, axis};
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

Floats SoftShadowMap::visibility(const Vec3d& eye, const Vec3s& p, const Vec3s& n, const Ints& pattern) const {
    const Vec3s own = local(p + broadcast<Floats>(Vec3(eye - cube_.center))), normal = local(n);
    return combined(own, [&](const DepthCube& cube) { return filtered(cube, own, normal, pattern); });
}

/// Returns the visible fraction by one cube, for points and normals in its frame.
Floats SoftShadowMap::filtered(const DepthCube& cube, const Vec3s& own, const Vec3s& n, const Ints& pattern) const {
    const Outline light = outline_from(own);
    const Floats height = max(-dot(own, light.axis), Floats(1e-20f));
    const Receiver receiver{cube, light, own, n, Floats(1.0f) / height, height * Floats(kRounding)};

    Floats sum(0.0f), count(0.0f);
    for (std::size_t i = 0; i < kSearchTaps; ++i) {
        const Floats f = gather(kSearch.fraction[i].data(), pattern);
        const Vec3s l = receiver.on_light(kSearch, i, pattern);
        const Floats found = receiver.blocker(own * (Floats(1.0f) - f) + l * f);
        sum += max(found, Floats(0.0f));
        count += xsimd::select(found > Floats(0.0f), Floats(1.0f), Floats(0.0f));
    }
    const Mask any = count > Floats(0.0f);
    if (!xsimd::any(any)) return Floats(1.0f);
    const Floats f = sum / max(count, Floats(1.0f));
    Floats dark(0.0f);
    for (std::size_t i = 0; i < kFilterTaps; ++i) {
        const Vec3s l = receiver.on_light(kFilter, i, pattern);
        const auto found_at = [&](const Floats& at) { return receiver.blocker(own * (Floats(1.0f) - at) + l * at); };
        Floats found = found_at(f);
        // If the line misses a blocker beside it at another depth, it is tested at that depth, too.
        if (const Mask beside = found < Floats(0.0f); xsimd::any(any & beside))
            found = xsimd::select(beside, found_at(-found), found);
        dark += xsimd::select(found > Floats(0.0f), Floats(1.0f), Floats(0.0f));
    }
    return xsimd::select(any, Floats(1.0f) - dark * Floats(1.0f / kFilterTaps), Floats(1.0f));
}

} // namespace duet::raster
