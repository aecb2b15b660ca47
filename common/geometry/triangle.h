// Ray and triangle.
#pragma once

#include "common/system/sabotage.h"
#include "common/vec/box.h"
#include "common/vec/ray.h"
#include "common/vec/robust.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace duet {

/// Where a ray meets a triangle abc: distance t, and the barycentric coordinates u of b and v of c.
struct TriangleHit {
    float t, u, v;
};

/// The axes and the shear that take a ray, or each ray of a batch, to (0, 0, 1): its largest axis becomes z (Woop,
/// Benthin and Wald 2013, «Watertight Ray/Triangle Intersection», §3).
template <typename T> struct Shear {
    std::size_t kx, ky, kz; ///< axes of the world; x and y swapped where z runs backwards, to keep triangles' winding
    Vec3T<T> origin;        ///< of the rays, its axes in that order
    T sx, sy, sz;
    T speed; ///< of the largest axis, |d.z|: a stretch of t is as long in the world times this
};

/// A vertex as seen from the ray's origin: the difference of the two.
template <typename Vertex> struct Relative {
    Vertex vertex;
};

/// A ray prepared for watertight tests.
struct ShearedRay {
    Vec3 origin, direction;
    float t_min, t_max;
    Shear<float> shear;

    explicit ShearedRay(const Ray& ray)
        : origin(ray.origin), direction(ray.direction), t_min(ray.t_min), t_max(ray.t_max) {
        // Without a branch: the axes of incoherent rays cannot be predicted.
        constexpr std::array<std::array<std::uint8_t, 2>, 6> kAcross{{{1, 2}, {2, 0}, {0, 1}, {2, 1}, {0, 2}, {1, 0}}};
        const std::array<float, 3> d{direction.x, direction.y, direction.z}, o{origin.x, origin.y, origin.z};
        const std::size_t kz = longest_axis(abs(direction)), backwards = std::bit_cast<std::uint32_t>(d[kz]) >> 31;
        const auto [kx, ky] = kAcross[kz + 3 * backwards];
        shear = {kx, ky, kz, {o[kx], o[ky], o[kz]}, d[kx] / d[kz], d[ky] / d[kz], 1 / d[kz], std::abs(d[kz])};
    }
};

/// What a ray meets of triangles, T being a number or a batch of them, of one ray and many triangles or the other way
/// round: the vertices sheared, the edge functions (twice the signed areas that the ray's foot spans with the edges) in
/// T's precision. (All inlined by order: calls with batches in memory cost a ray tracer a tenth of its rays.)
template <typename T> struct TriangleTest {
    Vec3T<T> at, bt, ct; ///< vertices in the ray's frame: it runs along +z from the origin
    T e0, e1, e2;        ///< of the edges opposite a, b and c

    /// a, b, c: the vertices; their components at index 0, 1, 2.
    template <typename S, typename Vertex>
    [[gnu::always_inline]] TriangleTest(const Shear<S>& ray, const Vertex& a, const Vertex& b, const Vertex& c)
        : TriangleTest(sheared(ray, a), sheared(ray, b), sheared(ray, c)) {}
    /// Of sheared vertices.
    [[gnu::always_inline]] TriangleTest(const Vec3T<T>& a, const Vec3T<T>& b, const Vec3T<T>& c)
        : TriangleTest(a, b, c, edge(c, b), edge(a, c), edge(b, a)) {}
    /// Of these and their edge functions.
    [[gnu::always_inline]] TriangleTest(const Vec3T<T>& a, const Vec3T<T>& b, const Vec3T<T>& c, T ea, T eb, T ec)
        : at(a), bt(b), ct(c), e0(ea), e1(eb), e2(ec) {}

    /// A vertex relative to the ray's origin and sheared, which makes the test one of the origin in a 2D triangle.
    template <typename S, typename Vertex>
    [[gnu::always_inline]] static Vec3T<T> sheared(const Shear<S>& ray, const Vertex& p) {
        return shear(ray, {T(p[ray.kx]) - T(ray.origin.x), T(p[ray.ky]) - T(ray.origin.y),
                           T(p[ray.kz]) - T(ray.origin.z)});
    }
    template <typename S, typename Vertex>
    [[gnu::always_inline]] static Vec3T<T> sheared(const Shear<S>& ray, const Relative<Vertex>& p) {
        return shear(ray, {T(p.vertex[ray.kx]), T(p.vertex[ray.ky]), T(p.vertex[ray.kz])});
    }
    /// The same edge gives the same numbers in both of its triangles, but for the sign: no ray slips between.
    [[gnu::always_inline]] static T edge(const Vec3T<T>& p, const Vec3T<T>& q) {
        using std::fma;
        if (sabotaged(Guard::kUnfusedEdges)) return fma(p.x, q.y, -(p.y * q.x));
        return p.x * q.y - p.y * q.x;
    }

    T det() const { return e0 + e1 + e2; }
    /// The distance along the ray; inv_det = 1 / det().
    [[gnu::always_inline]] T distance(T inv_det) const {
        return e0 * inv_det * at.z + e1 * inv_det * bt.z + e2 * inv_det * ct.z;
    }

    /// The bound on the error of that distance t = Σ bᵢ zᵢ where the triangle is met, after Pharr, Jakob and Humphreys
    /// 2023, §6.8.7. There no |bᵢ| is above 1, and with |x| at most X, |y| at most Y, W = X + Y and D the depth, the
    /// sheared coordinates are off by γ₅(X + D) and γ₅(Y + D), an edge function by no more than
    /// 2(γ₂XY + γ₅(2XY + DW)) ≤ 2γ₅W(W + D). Products are ordered so that they stay in range wherever the edge functions
    /// do. `speed` is the shear's: x and y, of the world's measure, were sheared by depths of that measure, while z
    /// counts in the ray's own t.
    template <typename S> [[gnu::always_inline]] T distance_error(T inv_det, const S& speed) const {
        const T z = max(farthest(), -nearest()), width = this->width();
        const T weights = width * abs(inv_det) * (width + z * T(speed)); // their error, over 2γ₅
        return z * (T(6 * gamma_bound(3)) + T(6 * gamma_bound(5)) * weights);
    }

    /// Whether the triangle is a needle as the ray sees it, so that the distance may be off by more than that. The
    /// sheared coordinates are off by some u·max_z, an edge function by that times the triangle's width: the hit moves
    /// along the triangle by as much over det, across depths of `spread` (in the world: the shear's `speed` makes them
    /// so). That is no more than z's own rounding, but where the triangle is much thinner than it is deep.
    template <typename S> [[gnu::always_inline]] auto is_needle(T inv_det, const S& speed) const {
        const T spread = farthest() - nearest();
        const float limit = sabotaged(Guard::kNeedles) ? std::numeric_limits<float>::infinity() : 8.0f;
        return width() * abs(inv_det) * (spread * T(speed)) > T(limit);
    }

private:
    [[gnu::always_inline]] T farthest() const { return max(max(at.z, bt.z), ct.z); }
    [[gnu::always_inline]] T nearest() const { return min(min(at.z, bt.z), ct.z); }
    /// Of the largest |x| and the largest |y| the sum.
    [[gnu::always_inline]] T width() const {
        return max(max(abs(at.x), abs(bt.x)), abs(ct.x)) + max(max(abs(at.y), abs(bt.y)), abs(ct.y));
    }
    template <typename S> [[gnu::always_inline]] static Vec3T<T> shear(const Shear<S>& ray, const Vec3T<T>& d) {
        return Vec3T<T>(d.x - T(ray.sx) * d.z, d.y - T(ray.sy) * d.z, T(ray.sz) * d.z);
    }
};

/// The distance along the ray to the plane of a, b and c in double, from the unrounded differences: its sign is right
/// even for an origin that is one float away from the plane of a triangle a million times as wide.
template <typename T>
[[gnu::always_inline]] inline T plane_distance(const Vec3T<T>& origin, const Vec3T<T>& direction, const Vec3T<T>& a,
                                               const Vec3T<T>& b, const Vec3T<T>& c) {
    const Vec3T<T> n = cross(b - a, c - a);
    return dot(n, a - origin) / dot(n, direction);
}
inline float plane_distance(const ShearedRay& ray, Vec3 a, Vec3 b, Vec3 c) {
    return static_cast<float>(
        plane_distance(Vec3d(ray.origin), Vec3d(ray.direction), Vec3d(a), Vec3d(b), Vec3d(c)));
}

/// Watertight: a ray through a shared edge or vertex of a closed mesh hits at least one of its triangles. Both sides
/// are hit; a triangle seen edge-on or of zero area is missed. The test uses the unsnapped float vertices.
std::optional<TriangleHit> intersect_triangle(const ShearedRay& ray, Vec3 a, Vec3 b, Vec3 c);

} // namespace duet
