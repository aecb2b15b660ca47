// Computes the irradiance from a sphere in closed form (Snyder 1996, "Area Light Sources for Real-Time Graphics", §A),
// and the light of a sphere that a linearly transformed cosine reflects, for one point or a batch of points. The latter
// follows Heitz and Hill 2017, "Real-Time Line- and Disk-Light Shading with Linearly Transformed Cosines", but for the
// sphere's cone itself.
#pragma once

#include "raster/geometry/lane_math.h"
#include "raster/lighting/specular_lobe.h"

namespace duet::raster {

/// Returns ∫ max(0, z) dw over a sphere's solid angle, clipped to z ≥ 0. This is the irradiance per unit of radiance,
/// in [0, π]. `c` is the z component of the unit vector to the center, and `sine2` the squared sine of the half angle
/// that the sphere subtends, below 1. Lanes outside `lanes` are unspecified.
template <typename T> T sphere_form_factor_times_pi(T c, T sine2, const MaskOf<T>& lanes) {
    const T whole = T(kPi) * sine2 * max(c, T(0));
    const MaskOf<T> clipped = c * c < sine2;
    if (!any_lane(clipped & lanes)) return whole;
    // This is Snyder's s² (c arccos y − cot σ h) + arctan(h tan σ) with x = h tan σ, rearranged to avoid cancellation
    // for small spheres.
    const T tangent = sqrt(sine2 / (T(1) - sine2));
    const T reach = tangent * sqrt(max(T(1) - c * c, T(1e-12f))); // x where the chord is a diameter
    const T y = clamp(-c / reach, T(-1), T(1)), x = reach * safe_sqrt((T(1) - y) * (T(1) + y));
    const T part = sine2 * (c * arc_cosine(y) + x) + arc_tangent_excess(x);
    return select(clipped, max(part, T(0)), whole);
}

namespace sphere {

/// Represents the symmetric matrix [xx xy xz; xy yy yz; xz yz zz].
template <typename T> struct Symmetric {
    T xx, xy, xz, yy, yz, zz;

    Symmetric adjugate() const {
        return {yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy,
                xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy};
    }
};

/// Returns 2 cos(arccos(q) / 3), the greatest root of t³ − 3t − 2q, for q in [−1, 1]. The error is below 1e-6.
template <typename T> T greatest_root(T q) {
    constexpr std::array<float, 8> kFit{1,             1.1546944f,   -0.22208648f, 0.10573821f,
                                        -0.060626126f, 0.03231898f, -0.0123398994f, 0.00230085802f};
    return polynomial(kFit, safe_sqrt((T(1) + min(q, T(1))) * T(0.5f))); // there is no singularity in √((1 + q)/2)
}

} // namespace sphere

/// Spheres whose cone has at most this half angle (as a tangent) after the transformation count as small. The error is
/// then below 1 % of the lobe's greatest value.
inline constexpr float kSmallCone = 1.0f / 16;

/// Returns π times the fraction of a lobe that a sphere fills. `d` is the unit direction to its center in the frame of
/// the lobe, and `sine2` the squared sine of the half angle that the sphere subtends. Transformed to the cosine's
/// space, the sphere's cone is elliptic. Its clipping at the horizon is approximated by that of the circular cone with
/// the same axis and form factor (Hill and Heitz 2016, "Real-Time Area Lighting: a Journey from Research to
/// Production"). A small cone counts as circular.
template <typename T>
T sphere_in_lobe(const CosineSpaceT<T>& lobe, const Vec3T<T>& d, T sine2, const MaskOf<T>& lanes) {
    const Vec3T<T> u = lobe(d);
    const T squared = dot(u, u), inverse = inverse_sqrt(squared);
    // The form factor of a small cone is its solid angle over π, which the transformation scales by its determinant.
    T form_factor = sine2 * lobe.determinant * (inverse * inverse * inverse), c = u.z * inverse;
    const T stretch2 = lobe.gram_xx + lobe.gram_yy + lobe.gram_zz; // bounds the square of the greatest stretch
    const MaskOf<T> large = sine2 * stretch2 > T(kSmallCone * kSmallCone) * squared;
    if (any_lane(large & lanes)) {
        // The directions w of the cone satisfy (w·d)² ≥ cos²σ w². The dual cone's matrix B = u uᵀ − sin²σ M Mᵀ has one
        // positive eigenvalue, which Cardano's formula finds from B less a third of its trace.
        const sphere::Symmetric<T> b{u.x * u.x - sine2 * lobe.gram_xx, u.x * u.y, u.x * u.z - sine2 * lobe.gram_xz,
                                     u.y * u.y - sine2 * lobe.gram_yy, u.y * u.z, u.z * u.z - sine2 * lobe.gram_zz};
        const T trace = b.xx + b.yy + b.zz, mean = trace * T(1.0f / 3);
        sphere::Symmetric<T> k = b;
        k.xx = k.xx - mean, k.yy = k.yy - mean, k.zz = k.zz - mean;
        const T p2 = (k.xx * k.xx + k.yy * k.yy + k.zz * k.zz +
                      T(2) * (k.xy * k.xy + k.xz * k.xz + k.yz * k.yz)) * T(1.0f / 6);
        const T inverse_p = inverse_sqrt(max(p2, T(1e-30f)));
        const sphere::Symmetric<T> cofactors = k.adjugate();
        const T half_determinant = (k.xx * cofactors.xx + k.xy * cofactors.xy + k.xz * cofactors.xz) * T(0.5f);
        const T q = clamp(half_determinant * (inverse_p * inverse_p * inverse_p), T(-1), T(1));
        const T det = (sine2 * lobe.determinant) * (sine2 * lobe.determinant) * (T(1) - sine2);
        // If the cone is much wider than the lobe, μ is a small difference of large numbers. Then it is the root of the
        // characteristic polynomial μ³ − trace μ² + minors μ − det, whose minors do not cancel: first without the cubic
        // term, then by Newton's method with it.
        const T xx = u.x * u.x, yy = u.y * u.y, zz = u.z * u.z, flat = lobe.determinant / lobe.yy;
        const T thin = (xx + zz) * lobe.gram_yy + yy * (lobe.gram_xx + lobe.gram_zz) + xx * lobe.gram_zz +
                       zz * lobe.gram_xx - T(2) * u.x * u.z * lobe.gram_xz;
        const T wide = (lobe.gram_xx + lobe.gram_zz) * lobe.gram_yy + flat * flat;
        const T minors = sine2 * (sine2 * wide - thin);
        T mu = mean + p2 * inverse_p * sphere::greatest_root(q);
        const T root = sqrt(max(minors * minors - T(4) * trace * det, T(0))) + abs(minors);
        const T quadratic = select(minors > T(0), T(2) * det / root, T(-0.5f) * root / trace);
        mu = select(mu < mean * T(-0.1f), quadratic, mu);
        for (int i = 0; i < 2; ++i) {
            const T value = ((mu - trace) * mu + minors) * mu - det, slope = (T(3) * mu - T(2) * trace) * mu + minors;
            mu = max(mu - value / max(slope, T(1e-30f)), T(0));
        }
        const T exact = inverse_sqrt(T(1) + mu * mu * (T(2) * mu - trace) / det);
        // The eigenvector is the longest column of the adjugate of B − μ.
        const sphere::Symmetric<T> a =
            sphere::Symmetric<T>{b.xx - mu, b.xy, b.xz, b.yy - mu, b.yz, b.zz - mu}.adjugate();
        const MaskOf<T> y_most = (a.yy > a.xx) & (a.yy >= a.zz), z_most = (a.zz > a.xx) & (a.zz > a.yy);
        Vec3T<T> axis = select(z_most, Vec3T<T>(a.xz, a.yz, a.zz),
                               select(y_most, Vec3T<T>(a.xy, a.yy, a.yz), Vec3T<T>(a.xx, a.xy, a.xz)));
        axis = axis * inverse_sqrt(max(T(dot(axis, axis)), T(1e-37f)));
        const T up = select(dot(axis, u) < T(0), -axis.z, axis.z);
        form_factor = select(large, exact, form_factor), c = select(large, up, c);
    }
    return sphere_form_factor_times_pi(c, min(form_factor, T(1 - 1e-6f)), lanes);
}

} // namespace duet::raster
