// This file defines the intersection of a ray and a triangle.
#pragma once

#include "common/vec/box.h"
#include "common/vec/ray.h"
#include "common/vec/robust.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

namespace duet {

/// A hit of a triangle abc consists of the ray parameter t and the barycentric coordinates u of b and v of c.
struct TriangleHit {
    float t, u, v;
};

/// This permutation of the axes and shear together map a ray's direction to (0, 0, 1). T is float, or a batch for many
/// rays. The axis of the largest component becomes z (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle
/// Intersection", §3).
template <typename T> struct Shear {
    std::size_t kx, ky, kz; ///< world axes; x and y are swapped if d.z < 0, to preserve the winding of triangles
    Vec3T<T> origin;        ///< origin of the rays, with permuted axes
    T sx, sy, sz;           ///< d.x / d.z, d.y / d.z and 1 / d.z for a direction d with permuted axes
    T depth_per_t;          ///< |d.z|: converts a difference in t to a difference in depth along the z axis
};

/// A relative vertex is the difference between a vertex and the ray's origin.
template <typename Vertex> struct RelativeVertex { Vertex vertex; };

/// A sheared ray stores the precomputed values of the watertight test.
struct ShearedRay {
    Vec3 origin, direction;
    float t_min, t_max;
    Shear<float> shear;

    explicit ShearedRay(const Ray& ray)
        : origin(ray.origin), direction(ray.direction), t_min(ray.t_min), t_max(ray.t_max) {
        // The code avoids branches, because the axes of incoherent rays are unpredictable.
        constexpr std::array<std::array<std::uint8_t, 2>, 6> kOtherAxes{
            {{1, 2}, {2, 0}, {0, 1}, {2, 1}, {0, 2}, {1, 0}}};
        const std::array<float, 3> d{direction.x, direction.y, direction.z}, o{origin.x, origin.y, origin.z};
        const std::size_t kz = longest_axis(abs(direction)), is_negative = std::bit_cast<std::uint32_t>(d[kz]) >> 31;
        const auto [kx, ky] = kOtherAxes[kz + 3 * is_negative];
        shear = {kx, ky, kz, {o[kx], o[ky], o[kz]}, d[kx] / d[kz], d[ky] / d[kz], 1 / d[kz], std::abs(d[kz])};
    }
};

/// Holds the sheared vertices and the edge functions of a ray and a triangle, in the precision of T. If T is a SIMD
/// batch, the lanes are many triangles for one ray, or many rays for one triangle. In the sheared x and y, the ray is
/// the point (0, 0). An edge function is twice the signed area of the triangle that an edge forms with this point. All
/// functions are force-inlined, because calls that pass batches in memory reduce the rays per second by a tenth.
template <typename T> struct TriangleTest {
    Vec3T<T> at, bt, ct; ///< vertices in the ray's frame, where the ray starts at the origin and points along +z
    T e0, e1, e2;        ///< edge functions of the edges opposite a, b and c

    /// Constructs the test from the vertices a, b and c, whose components have the indices 0, 1 and 2.
    template <typename S, typename Vertex>
    [[gnu::always_inline]] TriangleTest(const Shear<S>& ray, const Vertex& a, const Vertex& b, const Vertex& c)
        : TriangleTest(sheared(ray, a), sheared(ray, b), sheared(ray, c)) {}
    /// Constructs the test from sheared vertices.
    [[gnu::always_inline]] TriangleTest(const Vec3T<T>& a, const Vec3T<T>& b, const Vec3T<T>& c)
        : TriangleTest(a, b, c, edge(c, b), edge(a, c), edge(b, a)) {}
    /// Constructs the test from sheared vertices and their edge functions.
    [[gnu::always_inline]] TriangleTest(const Vec3T<T>& a, const Vec3T<T>& b, const Vec3T<T>& c, T ea, T eb, T ec)
        : at(a), bt(b), ct(c), e0(ea), e1(eb), e2(ec) {}

    /// Translates a vertex by the ray's origin and shears it. The remaining test is whether a 2D triangle contains the
    /// origin.
    template <typename S, typename Vertex>
    [[gnu::always_inline]] static Vec3T<T> sheared(const Shear<S>& ray, const Vertex& p) {
        return shear(ray, {T(p[ray.kx]) - T(ray.origin.x), T(p[ray.ky]) - T(ray.origin.y),
                           T(p[ray.kz]) - T(ray.origin.z)});
    }
    template <typename S, typename Vertex>
    [[gnu::always_inline]] static Vec3T<T> sheared(const Shear<S>& ray, const RelativeVertex<Vertex>& p) {
        return shear(ray, {T(p.vertex[ray.kx]), T(p.vertex[ray.ky]), T(p.vertex[ray.kz])});
    }
    /// Returns the edge function of the edge from p to q. In both triangles that share an edge, it has exactly the same
    /// magnitude and opposite signs, so no ray passes between them. Fused multiply-add would break this symmetry.
    [[gnu::always_inline]] static T edge(const Vec3T<T>& p, const Vec3T<T>& q) { return p.x * q.y - p.y * q.x; }

    /// Returns the sum of the edge functions: twice the signed area of the sheared triangle.
    T det() const { return e0 + e1 + e2; }
    /// Returns the ray parameter t of the hit. inv_det must be 1 / det().
    [[gnu::always_inline]] T distance(T inv_det) const {
        return e0 * inv_det * at.z + e1 * inv_det * bt.z + e2 * inv_det * ct.z;
    }

    /// Returns a bound on the error of distance(), t = Σ bᵢ zᵢ, for a ray that hits the triangle (after Pharr,
    /// Jakob and Humphreys 2023, §6.8.7). At a hit, every |bᵢ| is at most 1. Let |x| ≤ X, |y| ≤ Y, W = X + Y,
    /// and let D be the largest depth. The errors of the sheared coordinates are at most γ₅(X + D) and γ₅(Y + D),
    /// and the error of an edge function is at most 2(γ₂XY + γ₅(2XY + DW)) ≤ 2γ₅W(W + D). The order of the
    /// products prevents overflow wherever the edge functions do not overflow. `depth_per_t` is Shear::depth_per_t. It
    /// is needed because x and y are sheared by depths in world units, while z is in units of t.
    template <typename S> [[gnu::always_inline]] T distance_error(T inv_det, const S& depth_per_t) const {
        const T z = max(max_depth(), -min_depth()), width = this->width();
        const T weights =
            width * abs(inv_det) * (width + z * T(depth_per_t)); // error of the weights bᵢ, divided by 2γ₅
        return z * (T(6 * gamma_bound(3)) + T(6 * gamma_bound(5)) * weights);
    }

    /// Returns whether the triangle is a needle: so thin, seen along the ray, that the error of distance() may exceed
    /// distance_error(). The error of the sheared coordinates is about u·max_z, where u is the unit roundoff. The
    /// error of an edge function is that times the width of the triangle. Divided by det, it moves the hit along the
    /// triangle, whose depth range is `depth_range`; the factor Shear::depth_per_t converts the range to world units.
    /// The resulting error is no larger than the rounding of z, except where the triangle is much thinner than it is
    /// deep.
    template <typename S> [[gnu::always_inline]] auto is_needle(T inv_det, const S& depth_per_t) const {
        const T depth_range = max_depth() - min_depth();
        return width() * abs(inv_det) * (depth_range * T(depth_per_t)) > T(8.0f);
    }

private:
    [[gnu::always_inline]] T max_depth() const { return max(max(at.z, bt.z), ct.z); }
    [[gnu::always_inline]] T min_depth() const { return min(min(at.z, bt.z), ct.z); }
    /// Returns the sum of the largest |x| and the largest |y|.
    [[gnu::always_inline]] T width() const {
        return max(max(abs(at.x), abs(bt.x)), abs(ct.x)) + max(max(abs(at.y), abs(bt.y)), abs(ct.y));
    }
    template <typename S> [[gnu::always_inline]] static Vec3T<T> shear(const Shear<S>& ray, const Vec3T<T>& d) {
        return Vec3T<T>(d.x - T(ray.sx) * d.z, d.y - T(ray.sy) * d.z, T(ray.sz) * d.z);
    }
};

/// Returns the ray parameter of the intersection with the plane of a, b and c. T is double or a batch of doubles, so
/// the differences are not rounded to float. The sign is then right even if the origin is one float away from the plane
/// of a triangle a million times as wide.
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

/// Intersects a ray with a triangle from either side. Returns the hit with t in (t_min, t_max], or nothing on a miss.
/// The test is watertight: a ray through a shared edge or vertex of a closed mesh hits at least one of its triangles. A
/// triangle that is seen edge-on or has zero area is missed. The test uses the float vertices, without the rasterizer's
/// snapping to a subpixel grid.
std::optional<TriangleHit> intersect_triangle(const ShearedRay& ray, Vec3 a, Vec3 b, Vec3 c);

} // namespace duet
