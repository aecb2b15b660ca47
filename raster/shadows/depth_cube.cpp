#include "raster/shadows/depth_cube.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

constexpr float kLeastReversed = 1e-25f; ///< near / depth where nothing is seen

} // namespace

DepthCube::DepthCube(const CubeMap& cube)
    : frame(cube.frame), center(cube.center), side_(static_cast<int>(std::lround(2 * cube.middle))), near_(cube.near),
      middle_(cube.middle), scale_(cube.scale) {
    const std::size_t texels = static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
    depths_.assign(6 * texels, near_ / kLeastReversed);
    for (std::size_t face = 0; face < 6; ++face)
        if (cube.faces[face]) {
            const ImageFloat& image = cube.faces[face]->reversed_depth();
            std::transform(image.begin(), image.end(), depths_.begin() + static_cast<std::ptrdiff_t>(face * texels),
                           [&](float reversed) { return near_ / std::max(reversed, kLeastReversed); });
        }
}

Vec3T<Floats> DepthCube::surface(const Vec3T<Floats>& w, Floats& texel) const {
    const Floats zero(0.0f), one(1.0f), half(0.5f);
    const Floats ax = abs(w.x), ay = abs(w.y), az = abs(w.z);
    const auto x_first = (ax >= ay) & (ax >= az), y_first = (!x_first) & (ay >= az);
    const auto pick = [&](const Floats& x, const Floats& y, const Floats& z) {
        return xsimd::select(x_first, x, xsimd::select(y_first, y, z));
    };
    // In a face's coordinates, as in to_face(), right is the axis before the face's own and up the axis after it.
    const Floats axis = pick(w.x, w.y, w.z), sign = xsimd::select(axis < zero, -one, one);
    const Floats scale = Floats(scale_) / max(axis * sign, Floats(1e-30f)), middle(middle_);
    const Floats last(static_cast<float>(side_ - 1));
    const Ints column = truncated(clamp(middle + pick(w.z, w.x, w.y) * sign * scale, zero, last)),
               row = truncated(clamp(middle - pick(w.y, w.z, w.x) * scale, zero, last)),
               face = truncated(pick(zero, Floats(2.0f), Floats(4.0f)) + xsimd::select(axis < zero, one, zero));
    const Floats depth = gather(depths_.data(), (face * Ints(side_) + row) * Ints(side_) + column);
    const Floats x = xsimd::to_float(column), y = xsimd::to_float(row);
    const Floats per_texel = depth * Floats(1 / scale_);
    texel = per_texel;
    const Floats right = (x + half - middle) * per_texel * sign, up = (middle - y - half) * per_texel,
                 out = depth * sign;
    return {pick(out, right, up), pick(up, out, right), pick(right, up, out)};
}

} // namespace duet::raster
