// Which texels a sample averages: a line of equal, round probes along its footprint.
#pragma once

#include "common/texture/texture.h"
#include "common/vec/float_bits.h"
#include "common/vec/vec.h"

#include <cmath>

namespace duet {

/// More than this many times longer than wide, a footprint is widened: the picture blurs rather than shimmers.
inline constexpr int kMaxProbes = 16;
inline int max_probes(TextureFilter filter) { return filter == TextureFilter::kAnisotropic ? kMaxProbes : 1; }

/// `count` probes, `step` texels of the image apart. A probe interpolates between two sizes of the image, `level` times
/// halved and once more, weighed 1 − blend and blend; each is looked up bilinearly. T is float, or a batch of them.
template <typename T> struct ProbeLineT {
    T count = T(1);
    Vec2T<T> step{T(0), T(0)};
    T level = T(0);
    T blend = T(0);
};
using ProbeLine = ProbeLineT<float>;

/// Of the parallelogram spanned by a sample's steps along the picture's x and y, in texels. The probes have the second
/// moments of its box filter: the width across and, as long as max_probes suffices, the length along its axes (the ellipse
/// of Heckbert 1989, «Fundamentals of Texture Mapping and Image Warping», §3.5.8, here of equal covariance; probes along
/// its major axis after McCormack et al. 1999, «Feline: Fast Elliptical Lines for Anisotropic Texture Mapping»). Where a
/// texel is larger than that: one bilinear look-up of the image itself. Steps that are not finite give the smallest
/// size.
template <typename T = float> ProbeLineT<T> probe_line(Vec2T<T> dx, Vec2T<T> dy, int max_probes) {
    using std::ceil, std::floor;
    constexpr float kManyLevels = 30; // no image has as many sizes
    const T zero(0), one(1), third(1.0f / 3), most(static_cast<float>(max_probes));
    ProbeLineT<T> line;
    // The box's covariance is M/12, M = dx dxᵀ + dy dyᵀ; M's eigenvalues are the squares of the box's length and width.
    const T xx = sqr(dx.x) + sqr(dy.x), yy = sqr(dx.y) + sqr(dy.y), xy = dx.x * dx.y + dy.x * dy.y;
    // (Of squares: what overflows is sent away below, what underflows matters to no texel; std::hypot's care for them costs more
    // than all the rest.)
    const T mean = (xx + yy) * T(0.5f), spread = sqrt(sqr((xx - yy) * T(0.5f)) + sqr(xy));
    const T length2 = mean + spread;
    const auto bounded = length2 < T(0x1p56f); // neither it nor what is made of it is infinite or NaN
    // det M / length² rather than mean − spread, which cancels.
    const T width2 = select(length2 > zero, sqr(dx.x * dy.y - dx.y * dy.x) / length2, zero);
    const T probe2 = max(width2, length2 * T(1 / sqr(static_cast<float>(max_probes))));

    // A bilinear look-up among texels of width w, themselves means over their areas, has variance w²/6 + w²/12 = w²/4
    // along each axis; a box of width p has p²/12. Between two sizes variances interpolate like their weights.
    const T texel2 = probe2 * third;
    const auto larger = bounded && texel2 > one;
    line.level = select(larger, min(floor(whole_log2(texel2) * T(0.5f)), T(kManyLevels)), select(bounded, zero, T(kManyLevels)));
    line.blend = select(larger, clamp((texel2 * power_of_two(line.level * T(-2)) - one) * third, zero, one), zero);
    // The probes' own variance, and that of their places along the line, make up the length's: step² (n² − 1)/12.
    const T bilinear2 = max(probe2, T(3)), rest2 = length2 - bilinear2;
    const auto longer = bounded && rest2 > zero;
    if (max_probes == 1 || none_of_lanes(longer)) return line;
    line.count = select(longer, clamp(ceil(sqrt(length2 / bilinear2)), T(2), most), one);
    // The major axis: the larger column of M − width² I.
    const Vec2T<T> a(xx - width2, xy), b(xy, yy - width2);
    const auto first = dot(a, a) > dot(b, b);
    const Vec2T<T> axis(select(first, a.x, b.x), select(first, a.y, b.y));
    const T scale = sqrt(rest2 / ((sqr(line.count) - one) * dot(axis, axis)));
    line.step = {select(longer, axis.x * scale, zero), select(longer, axis.y * scale, zero)};
    return line;
}

} // namespace duet
