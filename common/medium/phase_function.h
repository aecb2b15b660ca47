// The phase function of Henyey and Greenstein (1941, "Diffuse Radiation in the Galaxy") says into which directions a
// medium scatters light: mostly ahead for an asymmetry g > 0, mostly back for g < 0, and evenly for g = 0.
#pragma once

#include "common/sampling/warp.h"
#include "common/vec/frame.h"

#include <cmath>

namespace duet {

/// Returns the density by solid angle with which light that travels along `from` is scattered to `to` (both unit).
/// Its integral over all directions is 1, so it is the density of sample_phase(), too. |g| must be below 1.
/// T is float or a batch of floats.
template <typename T> T phase(const Vec3T<T>& from, const Vec3T<T>& to, float g) {
    // 1 + g² − 2g·cos θ is computed as (1 − |g|)² + 2|g|·(distance of the cosine from the peak), which does not cancel
    // there.
    const T from_peak = g < 0 ? T(1) + dot(from, to) : T(1) - dot(from, to);
    const float size = std::abs(g);
    const T squared = T(sqr(1 - size)) + T(2 * size) * max(from_peak, T(0));
    return T(kInvPi / 4 * (1 - size) * (1 + size)) / (squared * sqrt(squared));
}

/// Draws the direction (unit) to which light that travels along `from` is scattered, with density phase(). u is in
/// [0, 1)².
inline Vec3 sample_phase(Vec3 from, float g, Vec2 u) {
    const float size = std::abs(g);
    // The distribution of the distance 1 − cos θ from the peak is inverted in closed form. With s = (1 − g²) / (1 − g +
    // 2gv), the cosine (1 + g² − s²) / 2g loses all digits for small g. The quotient below is the same without that
    // loss: 1 − cos θ = 2(1 − v)(1 − g)² (1 + gv) / (1 − g + 2gv)².
    const float v = 1 - u.y;
    const float denominator = 1 - size + 2 * size * v;
    const float from_peak = 2 * u.y * sqr(1 - size) * (1 + size * v) / sqr(denominator);
    const float sine = safe_sqrt(from_peak * (2 - from_peak));
    const Vec2 circle = unit_circle(u.x);
    const Frame frame = frame_from_normal(g < 0 ? -from : from);
    return normalize(frame.to_world({sine * circle.x, sine * circle.y, 1 - from_peak}));
}

} // namespace duet
