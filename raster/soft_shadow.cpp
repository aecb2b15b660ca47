#include "raster/soft_shadow.h"

#include "common/sampling/hash.h"
#include "common/sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

constexpr double kFlat = 1e-4; ///< of a group's size: how far it may be off one plane

/// The light from one receiver, in the light's own frame: its centre is the origin, a flat one's normal +z. Floats do
/// here, for all is near the origin by the light's own measure.
class Cone {
public:
    Cone(const CubeMap& map, const Emitter& light, const Receiver& receiver)
        : kind_(light.kind), p(map.frame.to_local(receiver.p - map.center)), n(map.frame.to_local(receiver.n)),
          slack(static_cast<float>(2 * receiver.error) + length(p) * 0x1p-19f) {
        if (kind_ == Emitter::Kind::kBall) {
            const float distance = length(p), r = static_cast<float>(light.radius);
            empty_ = !(distance > r);
            axis_ = -p / distance;
            const Frame disk = frame_from_normal(axis_);
            // The disk through the centre that fills the cone of the lines that touch the ball.
            const float radius = r / safe_sqrt(1 - sqr(r / distance));
            u_ = disk.s * radius, v_ = disk.t * radius;
        } else {
            axis_ = {0, 0, p.z < 0 ? 1.0f : -1.0f};
            empty_ = p.z == 0;
            u_ = Vec3(map.frame.to_local(light.u)), v_ = Vec3(map.frame.to_local(light.v));
            corner_ = (u_ + v_) * (kind_ == Emitter::Kind::kTriangle ? -1.0f / 3 : -0.5f);
        }
        const float uu = dot(u_, u_), uv = dot(u_, v_), vv = dot(v_, v_), over = 1 / (uu * vv - uv * uv);
        dual_u_ = (u_ * vv - v_ * uv) * over, dual_v_ = (v_ * uu - u_ * uv) * over;
        per_height_ = -1 / dot(axis_, p);
        p_u_ = dot(p - corner_, dual_u_), p_v_ = dot(p - corner_, dual_v_);
    }

    /// Nothing is before a receiver in the light's own plane, or within its ball.
    bool empty() const { return empty_; }

    /// The way from the receiver to a point of the light, uniformly for u in [0, 1)².
    Vec3 way(Vec2 u) const {
        if (kind_ == Emitter::Kind::kBall) u = concentric_disk(u);
        if (kind_ == Emitter::Kind::kTriangle) u = uniform_triangle(u);
        return corner_ + u_ * u.x + v_ * u.y - p;
    }

    /// The fraction of the way to the light's plane at which q stands: 0 here, 1 there. A negative number where that is
    /// not between the two, or not over the receiver's plane.
    float between(Vec3 q) const {
        const Vec3 to = q - p;
        const float fraction = dot(axis_, to) * per_height_;
        return dot(n, to) > slack && fraction > 0 && fraction < 1 ? fraction : -1;
    }

    /// The same, and negative, too, where the line from the receiver through q does not go on to the light.
    float within(Vec3 q) const {
        const float fraction = between(q);
        if (fraction < 0) return -1;
        const Vec3 to = q - p;
        // The line goes on to corner + a·u + b·v; both sides times the fraction save the division.
        const float a = p_u_ * fraction + dot(to, dual_u_), b = p_v_ * fraction + dot(to, dual_v_);
        const bool meets = kind_ == Emitter::Kind::kBall           ? a * a + b * b <= fraction * fraction
                           : kind_ == Emitter::Kind::kParallelogram ? a >= 0 && b >= 0 && a <= fraction && b <= fraction
                                                                    : a >= 0 && b >= 0 && a + b <= fraction;
        return meets ? fraction : -1;
    }

private:
    Emitter::Kind kind_;
    bool empty_ = false;
    Vec3 axis_, corner_, u_, v_, dual_u_, dual_v_;
    float per_height_ = 0, p_u_ = 0, p_v_ = 0;

public:
    const Vec3 p, n;   ///< the receiver
    const float slack; ///< height over its plane that rounding accounts for
};

/// Looks for blockers in the maps, for one receiver.
class Taps {
public:
    Taps(const CubeMap& map, const Cone& cone) : map_(map), cone_(cone) {}

    /// What the light's centre sees in the direction of q: at which fraction of the way it stands within the cone;
    /// negative where it does not.
    float blocker(Vec3 q) const {
        const Place place = this->place(q);
        if (place.map == nullptr) return -1;
        const std::optional<Vec3> seen = this->seen(place, static_cast<int>(place.x), static_cast<int>(place.y));
        return seen ? cone_.within(*seen) : -1;
    }

    /// The part of the four texels about q, weighed by how near they are, that see nothing between receiver and light.
    float lit(Vec3 q) const {
        const Place place = this->place(q);
        if (place.map == nullptr) return 1;
        const int x = static_cast<int>(place.x - 0.5f), y = static_cast<int>(place.y - 0.5f);
        const float fx = place.x - 0.5f - static_cast<float>(x), fy = place.y - 0.5f - static_cast<float>(y);
        float dark = 0;
        if (dark_at(place, x, y)) dark += (1 - fx) * (1 - fy);
        if (dark_at(place, x + 1, y)) dark += fx * (1 - fy);
        if (dark_at(place, x, y + 1)) dark += (1 - fx) * fy;
        if (dark_at(place, x + 1, y + 1)) dark += fx * fy;
        return 1 - dark;
    }

private:
    struct Place {
        const ShadowMap* map;
        std::size_t face;
        float x, y;
    };
    Place place(Vec3 q) const {
        const std::size_t face = cube_face(q);
        const Vec3 along = to_face(face, q);
        const ShadowMap* map = map_.faces[face].get();
        const float per_depth = map_.scale / along.z;
        return {map, face, map_.middle + along.x * per_depth, map_.middle - along.y * per_depth};
    }

    bool dark_at(const Place& place, int x, int y) const {
        const std::optional<Vec3> seen = this->seen(place, x, y);
        return seen && cone_.between(*seen) > 0;
    }

    std::optional<Vec3> seen(const Place& place, int x, int y) const {
        const float nearness = place.map->nearness(x, y);
        if (!(nearness > 0)) return std::nullopt;
        const float depth = map_.near / nearness, per_depth = depth / map_.scale;
        return from_face(place.face, {(static_cast<float>(x) + 0.5f - map_.middle) * per_depth,
                                      (map_.middle - static_cast<float>(y) - 0.5f) * per_depth, depth});
    }

    const CubeMap& map_;
    const Cone& cone_;
};

/// Number i of n × n strata of the square, jittered.
Vec2 stratum(int i, int n, std::uint64_t key) {
    const std::uint64_t random = stream_number(key, static_cast<std::uint64_t>(i));
    return {min((static_cast<float>(i % n) + unit_float(high_bits(random))) / static_cast<float>(n), kOneMinusEpsilon),
            min((static_cast<float>(i / n) + unit_float(low_bits(random))) / static_cast<float>(n), kOneMinusEpsilon)};
}

/// The mean fraction of the way at which blockers stand; none found: negative. Each tap looks at another distance, for
/// close to the light its cone covers much of the map, close to the receiver a few texels.
float mean_blocker(const Taps& taps, const Cone& cone, int n, std::uint64_t key) {
    const int count = n * n;
    float sum = 0;
    int found = 0;
    for (int i = 0; i < count; ++i) {
        // A stride without a factor in common with any square used visits each distance once, far from the last.
        const float jitter = unit_float(high_bits(stream_number(~key, static_cast<std::uint64_t>(i))));
        const float fraction = (static_cast<float>(i * 7 % count) + jitter) / static_cast<float>(count);
        const float blocker = taps.blocker(cone.p + cone.way(stratum(i, n, key)) * fraction);
        if (blocker > 0) sum += blocker, ++found;
    }
    return found > 0 ? sum / static_cast<float>(found) : -1;
}

/// The part of the light that gets past blockers in a plane parallel to it.
float lit_past(float blocker, const Taps& taps, const Cone& cone, int n, std::uint64_t key) {
    float lit = 0;
    for (int i = 0; i < n * n; ++i) lit += taps.lit(cone.p + cone.way(stratum(i, n, key)) * blocker);
    return lit / static_cast<float>(n * n);
}

Emitter ball_around(std::span<const SurfaceLight> lights, std::span<const Vec3d> points) {
    Box3d box;
    for (const Vec3d p : points) box.extend(p);
    for (const SurfaceLight& light : lights)
        if (const auto* sphere = std::get_if<Sphere>(&light.shape)) {
            const Vec3d center(sphere->center), r(Vec3(sphere->radius, sphere->radius, sphere->radius));
            box.extend(center - r);
            box.extend(center + r);
        }
    Emitter result;
    result.center = box.center();
    result.radius = length(box.diagonal()) / 2 / (points.empty() ? std::sqrt(3.0) : 1.0);
    return result;
}

} // namespace

Emitter Emitter::of(const SurfaceLight& light) {
    Emitter result;
    if (const auto* quad = std::get_if<Quad>(&light.shape)) {
        result.kind = Kind::kParallelogram;
        result.u = Vec3d(quad->u), result.v = Vec3d(quad->v);
        result.center = Vec3d(quad->corner) + (result.u + result.v) * 0.5;
    } else if (const auto* triangle = std::get_if<SurfaceLight::Triangle>(&light.shape)) {
        result.kind = Kind::kTriangle;
        result.u = Vec3d(triangle->b) - Vec3d(triangle->a), result.v = Vec3d(triangle->c) - Vec3d(triangle->a);
        result.center = Vec3d(triangle->a) + (result.u + result.v) / 3.0;
    } else {
        const auto& sphere = std::get<Sphere>(light.shape);
        result.center = Vec3d(sphere.center);
        result.radius = static_cast<double>(sphere.radius);
        return result;
    }
    result.normal = normalize(cross(result.u, result.v));
    return result;
}

Emitter Emitter::of(std::span<const SurfaceLight> lights) {
    if (lights.size() == 1) return of(lights.front());
    std::vector<Vec3d> points;
    bool flat = true;
    const Emitter first = of(lights.front());
    for (const SurfaceLight& light : lights) {
        const Emitter one = of(light);
        flat = flat && one.kind != Kind::kBall && dot(one.normal, first.normal) > 1 - kFlat;
        if (const auto* quad = std::get_if<Quad>(&light.shape))
            for (const Vec3 p : corners(*quad)) points.emplace_back(p);
        else if (const auto* t = std::get_if<SurfaceLight::Triangle>(&light.shape))
            points.insert(points.end(), {Vec3d(t->a), Vec3d(t->b), Vec3d(t->c)});
    }
    Emitter ball = ball_around(lights, points);
    for (const Vec3d p : points)
        flat = flat && std::abs(dot(first.normal, p - points.front())) <= kFlat * ball.radius;
    if (!flat) return ball;
    Emitter best;
    double least = kPiDouble * 1e300;
    for (const Vec3d edge : {first.u, first.v, first.v - first.u}) {
        const Vec3d s = normalize(edge), t = cross(first.normal, s);
        Vec2d low(1e300, 1e300), high(-1e300, -1e300);
        for (const Vec3d p : points) {
            low = {min(low.x, dot(p, s)), min(low.y, dot(p, t))};
            high = {max(high.x, dot(p, s)), max(high.y, dot(p, t))};
        }
        const double area = (high.x - low.x) * (high.y - low.y);
        if (area >= least) continue;
        least = area;
        best = {Kind::kParallelogram,
                s * ((low.x + high.x) / 2) + t * ((low.y + high.y) / 2) + first.normal * dot(first.normal, points.front()),
                s * (high.x - low.x), t * (high.y - low.y), first.normal, 0};
    }
    return best;
}

float soft_visibility(const CubeMap& map, const Emitter& light, const Receiver& receiver, SoftTaps counts,
                      std::uint64_t key) {
    const Cone cone(map, light, receiver);
    if (cone.empty()) return 1;
    const Taps taps(map, cone);
    const float blocker = mean_blocker(taps, cone, counts.search, key);
    if (blocker < 0) return 1;
    const float few = lit_past(blocker, taps, cone, counts.filter, mix_bits(key));
    if (few == 0 || few == 1 || counts.refine == 0) return few;
    const float more = lit_past(blocker, taps, cone, counts.refine, mix_bits(key + 1));
    const auto weight = static_cast<float>(counts.filter * counts.filter), rest = static_cast<float>(counts.refine * counts.refine);
    return (few * weight + more * rest) / (weight + rest);
}

} // namespace duet::raster
