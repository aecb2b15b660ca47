#include "common/texture/probe_line.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

/// No image has as many sizes.
constexpr int kManyLevels = 30;

} // namespace

ProbeLine probe_line(Vec2d dx, Vec2d dy, int max_probes) {
    ProbeLine line;
    // The box's covariance is M/12, M = dx dxᵀ + dy dyᵀ; M's eigenvalues are the squares of the box's length and width.
    const double xx = sqr(dx.x) + sqr(dy.x), yy = sqr(dx.y) + sqr(dy.y), xy = dx.x * dx.y + dy.x * dy.y;
    // (Of squares: what overflows is sent away below, what underflows matters to no texel; std::hypot's care for them costs more
    // than all the rest.)
    const double mean = (xx + yy) / 2, spread = std::sqrt(sqr((xx - yy) / 2) + sqr(xy));
    const double length2 = mean + spread;
    if (!(length2 < 0x1p60)) { // infinite and NaN, too
        line.level = kManyLevels;
        return line;
    }
    // det M / length² rather than mean − spread, which cancels.
    const double width2 = length2 > 0 ? sqr(dx.x * dy.y - dx.y * dy.x) / length2 : 0;
    const double probe2 = std::max(width2, length2 / sqr(max_probes));

    // A bilinear look-up among texels of width w, themselves means over their areas, has variance w²/6 + w²/12 = w²/4
    // along each axis; a box of width p has p²/12. Between two sizes variances interpolate like their weights.
    const double texel2 = probe2 / 3;
    if (texel2 > 1) {
        line.level = std::min(static_cast<int>(std::log2(texel2) / 2), kManyLevels);
        const double finer2 = std::ldexp(1.0, 2 * line.level);
        line.blend = static_cast<float>(std::clamp((texel2 / finer2 - 1) / 3, 0.0, 1.0));
    }
    // The probes' own variance, and that of their places along the line, make up the length's: step² (n² − 1)/12.
    const double rest2 = length2 - std::max(probe2, 3.0);
    if (max_probes == 1 || !(rest2 > 0)) return line;
    line.count = std::clamp(static_cast<int>(std::ceil(std::sqrt(length2 / std::max(probe2, 3.0)))), 2, max_probes);
    const double step = std::sqrt(rest2 / (sqr(line.count) - 1.0));
    // The major axis: the larger column of M − width² I.
    const Vec2d a(xx - width2, xy), b(xy, yy - width2);
    const Vec2d axis = dot(a, a) > dot(b, b) ? a : b;
    line.step = axis * (step / std::sqrt(dot(axis, axis)));
    return line;
}

} // namespace duet
