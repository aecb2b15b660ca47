// This file holds Fresnel's equations and Schlick's approximation: the fraction of light that a smooth boundary
// reflects.
#pragma once

#include "common/image/rgb.h"

namespace duet {

/// Returns the squared cosine of the refracted direction; a negative value means total reflection. cos_i is the
/// cosine of the incident direction, and eta is the index beyond the boundary over the index before it. The form
/// ((η − 1)(η + 1) + cos²θ)/η² is exact for η = 1 and precise near the critical angle, where
/// 1 − sin²θ/η² suffers from cancellation.
template <typename T> T cos2_refracted(T cos_i, T eta) {
    return ((eta - T(1)) * (eta + T(1)) + cos_i * cos_i) / (eta * eta);
}

/// Returns the reflectance of unpolarized light at a boundary between dielectrics, in [0, 1] (Born and Wolf 1999,
/// §1.5.2). cos_i ≥ 0 is measured on the incident side, and eta is as for cos2_refracted. The result is 1 at total
/// reflection and at grazing incidence, and 0 for eta = 1.
template <typename T> T fresnel_dielectric(T cos_i, T eta) {
    const T cos2_t = cos2_refracted(cos_i, eta);
    const T cos_t = safe_sqrt(cos2_t);
    const T tiny = T(1e-30f); // both sums vanish only for eta = 1 at grazing incidence, where nothing is reflected
    const T parallel = (eta * cos_i - cos_t) / max(eta * cos_i + cos_t, tiny);
    const T perpendicular = (cos_i - eta * cos_t) / max(cos_i + eta * cos_t, tiny);
    const T reflectance = T(0.5f) * (parallel * parallel + perpendicular * perpendicular);
    return select(cos2_t <= T(0), select(eta == T(1), T(0), T(1)), min(reflectance, T(1)));
}

/// Returns the reflectance of unpolarized light at a conductor, in [0, 1] (Born and Wolf 1999, §14.2; |cos θₜ|²
/// and its real part as in Wolff and Kurlander 1990). n + ik is the complex index relative to the medium before it,
/// and cos_i is in [0, 1].
template <typename T> T fresnel_conductor(T cos_i, T n, T k) {
    const T cos2 = cos_i * cos_i, sin2 = T(1) - cos2;
    // (n + ik)² − sin²θ = (a + ib)² has the real part `real` and the imaginary part `twice`.
    const T real = (n - k) * (n + k) - sin2, twice = T(2) * n * k;
    const T size = sqrt(real * real + twice * twice);              // a² + b²
    const T a = safe_sqrt(T(0.5f) * (size + real));
    const T sum = size + cos2, cross = T(2) * a * cos_i;
    const T perpendicular = (sum - cross) / (sum + cross);
    const T sum_p = cos2 * size + sin2 * sin2, cross_p = cross * sin2;
    const T parallel = perpendicular * ((sum_p - cross_p) / (sum_p + cross_p));
    return min(T(0.5f) * (perpendicular + parallel), T(1));
}

/// Returns Schlick's approximation for metals, from the reflectance `f0` at normal incidence (Schlick 1994,
/// eq. 24). The result is 1 at grazing incidence and never below `f0`.
template <typename T> RgbT<T> fresnel_schlick(RgbT<T> f0, T cos_i) {
    const T x = T(1) - clamp(cos_i, T(0), T(1));
    const T x2 = x * x;
    return f0 + (RgbT<T>(T(1)) - f0) * (x2 * x2 * x);
}

} // namespace duet
