#include "common/texture/texture.h"

#include <cmath>

namespace duet {

namespace {

// Returns whether the cell of a coordinate, given in units of cells, has an odd index. The result is exact: beyond
// 2^53 all doubles are even.
bool is_odd(double x) {
    const double cell = std::floor(x);
    return cell - 2 * std::floor(cell / 2) == 1;
}

} // namespace

Rgb evaluate(const CheckerTexture& texture, const SurfacePoint& point) {
    const double scale = texture.scale;
    if (!texture.solid) {
        const bool odd = is_odd(scale * point.uv.x) != is_odd(scale * point.uv.y);
        return odd ? texture.odd : texture.even;
    }
    // Faces often lie on the borders of cells, for example a floor at y = 0. Rounding of p would then select the
    // color. The cells are therefore shifted by 1/4096 of their size, so that such a face lies wholly within the
    // cells on its upper side.
    constexpr double kShift = 1.0 / 4096;
    const Vec3d p = Vec3d(point.p_object) * scale + Vec3d(kShift, kShift, kShift);
    const bool odd = (is_odd(p.x) != is_odd(p.y)) != is_odd(p.z);
    return odd ? texture.odd : texture.even;
}

} // namespace duet
