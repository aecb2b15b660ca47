// This file computes the texels that a sample averages for anisotropic filtering: a line of equal round probes along
// the footprint.
#pragma once

#include "common/texture/texture.h"
#include "common/vec/float_bits.h"
#include "common/vec/vec.h"

#include <cmath>

namespace duet {

/// A footprint whose length exceeds its width by more than this factor is widened, so that the image blurs instead of
/// flickering.
inline constexpr int kMaxAnisotropy = 16;
/// Returns the largest ratio of a footprint's length to its width that a filter resolves; 1 for filters of round
/// footprints.
inline int max_anisotropy(TextureFilter filter) { return filter == TextureFilter::kAnisotropic ? kMaxAnisotropy : 1; }

/// AnisotropicProbesT describes `count` probes that are `step` texels of the image apart. A probe interpolates between
/// two mip levels, `level` and level + 1, with weights 1 − blend and blend. Each level is sampled bilinearly. T is
/// float, or a batch of floats.
template <typename T> struct AnisotropicProbesT {
    T count = T(1);
    Vec2T<T> step{T(0), T(0)};
    T level = T(0);
    T blend = T(0);
};
using AnisotropicProbes = AnisotropicProbesT<float>;

/// Returns the probes for a footprint: the parallelogram spanned by the sample's steps along the image's x and y, in
/// texels. The probes have the second moments of the parallelogram's box filter across its major axis and, as far as
/// max_anisotropy suffices, along it. The ellipse is that of Heckbert 1989, "Fundamentals of Texture Mapping and Image
/// Warping", §3.5.8, here of equal covariance; probes along its major axis follow McCormack et al. 1999, "Feline:
/// Fast Elliptical Lines for Anisotropic Texture Mapping". Where a texel is larger than the footprint, the result is
/// one bilinear sample of the image itself. Steps that are not finite select the smallest mip level.
template <typename T = float> AnisotropicProbesT<T> anisotropic_probes(Vec2T<T> dx, Vec2T<T> dy, int max_anisotropy) {
    using std::ceil, std::floor;
    constexpr float kMaxLevels = 30; // no image has this many mip levels
    const T zero(0), one(1), third(1.0f / 3), max_count(static_cast<float>(max_anisotropy));
    AnisotropicProbesT<T> probes;
    // The box's covariance is M/12 with M = dx dxᵀ + dy dyᵀ. The eigenvalues of M are the squares of the box's
    // length and width.
    const T xx = sqr(dx.x) + sqr(dy.x), yy = sqr(dx.y) + sqr(dy.y), xy = dx.x * dx.y + dy.x * dy.y;
    // The code works with squares. Overflow is handled by `bounded` below, and underflow affects no texel. std::hypot
    // would handle both, but costs more than the rest of the function.
    const T mean = (xx + yy) * T(0.5f), spread = sqrt(sqr((xx - yy) * T(0.5f)) + sqr(xy));
    const T length2 = mean + spread;
    const auto bounded = length2 < T(0x1p56f); // below this bound no derived value is infinite or NaN
    // The width is computed as det M / length², because mean − spread cancels.
    const T width2 = select(length2 > zero, sqr(dx.x * dy.y - dx.y * dy.x) / length2, zero);
    const T probe2 = max(width2, length2 * T(1 / sqr(static_cast<float>(max_anisotropy))));

    // A bilinear sample among texels of width w, which are themselves means over their areas, has variance
    // w²/6 + w²/12 = w²/4 along each axis. A box of width p has variance p²/12. Between two mip levels, variances
    // interpolate with the same weights as colors.
    const T texel2 = probe2 * third;
    const auto larger = bounded && texel2 > one;
    probes.level =
        select(larger, min(floor(floor_log2(texel2) * T(0.5f)), T(kMaxLevels)), select(bounded, zero, T(kMaxLevels)));
    probes.blend = select(larger, clamp((texel2 * power_of_two(probes.level * T(-2)) - one) * third, zero, one), zero);
    // The variance along the length is the probes' own variance plus that of their positions on the line, step²
    // (n² − 1)/12.
    const T bilinear2 = max(probe2, T(3)), remaining2 = length2 - bilinear2;
    const auto longer = bounded && remaining2 > zero;
    if (max_anisotropy == 1 || none_of(longer)) return probes;
    probes.count = select(longer, clamp(ceil(sqrt(length2 / bilinear2)), T(2), max_count), one);
    // The major axis is the larger column of M − width² I.
    const Vec2T<T> a(xx - width2, xy), b(xy, yy - width2);
    const auto first = dot(a, a) > dot(b, b);
    const Vec2T<T> axis(select(first, a.x, b.x), select(first, a.y, b.y));
    const T scale = sqrt(remaining2 / ((sqr(probes.count) - one) * dot(axis, axis)));
    probes.step = {select(longer, axis.x * scale, zero), select(longer, axis.y * scale, zero)};
    return probes;
}

} // namespace duet
