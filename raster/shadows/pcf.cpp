#include "raster/shadows/pcf.h"

namespace duet::raster {
namespace {

using Mask = Floats::batch_bool_type;

/// Facets of one surface must not shade each other. They may meet at up to 27 degrees (tangent kSteepest), or at the
/// fraction kOfElevation of the light's elevation above the surface. A greater fraction lets more light past the rim of
/// a coarse trough, a smaller one draws darker lines along its valleys.
constexpr float kSteepest = 0.5f, kOfElevation = 0.85f;
/// A texel's surface is continued to the point by its slope in the map. It is a roof over the point if it is then
/// higher above the receiver's plane than kRoof times the height that a facet at kSteepest reaches within one texel. A
/// facet that begins beside the point would be lower than the plane there. A surface that ends between two texels is
/// steep, and so counts as a roof, too. A surface whose normal is turned so far from the receiver's that the cosine
/// is below kTurned is no facet of the same surface, so it is a roof at any height.
constexpr float kRoof = 0.7f, kTurned = 0.5f;
/// Texels on the side of the point that is nearer to the light are ignored if their surface falls below the receiver's
/// plane by more than this fraction of the elevation. They lie beyond the end of the receiver's surface.
constexpr float kFalling = 0.23f;
constexpr float kLeastKnown = 0.25f; ///< lower bound of the total filter weight of texels that count
constexpr float kRounding = 0x1p-20f; ///< relative error of a depth, and of a point relative to the light

constexpr std::size_t kTaps = 5; ///< taps along each side of the filter

/// Returns the weights of the quadratic B-spline at four texels. The spline is a box of one texel convolved twice with
/// itself. The second texel is at the distance f, in [0, 1), before the point.
std::array<Floats, kTaps> spline(const Floats& f) {
    const Floats g = Floats(1.0f) - f, half(0.5f);
    const auto outer = [&](const Floats& x) { // for distances x in [1, 2)
        const Floats d = max(Floats(1.5f) - x, Floats(0.0f));
        return half * d * d;
    };
    const auto inner = [&](const Floats& x) { // for distances x in [0, 1)
        return xsimd::select(x < half, Floats(0.75f) - x * x, outer(x));
    };
    return {outer(Floats(1.0f) + f), inner(f), inner(g), outer(Floats(1.0f) + g), Floats(0.0f)};
}

/// Returns the weights of a box of four texels at five texels. The box begins at the fraction f, in [0, 1), of the
/// first texel. Along each axis, all ranks of a dither matrix of 4 × 4 texels have equal weight at any position, so the
/// dither pattern averages out.
std::array<Floats, kTaps> box(const Floats& f) {
    const Floats quarter(0.25f);
    return {quarter - f * quarter, quarter, quarter, quarter, f * quarter};
}

/// Returns the distance of a texel's center from the point at x along one axis. The filter's texels begin at x0.
Floats off(const Floats& x0, std::size_t i, const Floats& x) { return x0 + Floats(static_cast<float>(i) + 0.5f) - x; }

Floats dot_constant(const Vec3T<Floats>& a, Vec3 b) {
    return a.x * Floats(b.x) + a.y * Floats(b.y) + a.z * Floats(b.z);
}

} // namespace

SharpShadowMap::SharpShadowMap(const ShadowMap& map, const Vec3d& eye)
    : map_(map), direction_(map.view().direction), direction_dx_(map.view().direction_dx),
      direction_dy_(map.view().direction_dy), origin_dx_(map.view().origin_dx), origin_dy_(map.view().origin_dy),
      near_(static_cast<float>(map.near())) {
    for (std::size_t row = 0; row < 4; ++row) {
        const auto& m = map.view().world_to_pixel[row];
        to_texel_[row] = {static_cast<float>(m[0]), static_cast<float>(m[1]), static_cast<float>(m[2]),
                          static_cast<float>(m[0] * eye.x + m[1] * eye.y + m[2] * eye.z + m[3])};
    }
}

/// Returns the plane through the receiver with normal n. A texel's ray o + d·w meets the plane n·(q − p) = 0 at the
/// depth d = n·(p − o)/n·w. In a perspective view o is constant and 1/d is linear in w. In an orthographic view w is
/// constant and d is linear in o.
SharpShadowMap::Plane SharpShadowMap::plane(const Floats& x, const Floats& y, const Floats& depth,
                                            const Vec3T<Floats>& n) const {
    const bool flat = map_.orthographic();
    const Vec3T<Floats> ray = broadcast<Floats>(direction_) + broadcast<Floats>(direction_dx_) * x +
                              broadcast<Floats>(direction_dy_) * y; // vector to depth 1
    const Floats toward = max(-dot(n, ray), Floats(1e-6f));
    const Floats over_ray = inverse_sqrt(dot(ray, ray)), cosine = toward * over_ray, one(1.0f);
    const Floats sine = xsimd::sqrt(max(one - cosine * cosine, Floats(0.0f)));
    const auto tangent = [&](float of_elevation) {
        return min(Floats(kSteepest), Floats(of_elevation) * cosine / max(sine, Floats(1e-6f)));
    };
    const Floats t = tangent(kOfElevation), falling = tangent(kFalling);
    const Floats width = flat ? Floats(length(origin_dx_)) : Floats(length(direction_dx_)) * depth;
    const Floats at = flat ? -depth : Floats(near_) / depth, per_depth = flat ? one : at / depth;
    const Floats unit = width * over_ray * per_depth;
    const Floats slope = (flat ? one : at) / -toward;
    return {at, dot_constant(n, flat ? origin_dx_ : direction_dx_) * slope,
            dot_constant(n, flat ? origin_dy_ : direction_dy_) * slope,
            Floats(kRounding) * depth * per_depth / toward,
            t / (cosine - t * sine) * unit, falling / (cosine - falling * sine) * unit,
            Floats(kSteepest) / (cosine + Floats(kSteepest) * sine) * unit};
}

SharpShadowMap::Texels SharpShadowMap::texels(const Vec3T<Floats>& p, Mask& inside) const {
    const auto row = [&](std::size_t r) {
        const Vec4& m = to_texel_[r];
        return Floats(m.x) * p.x + Floats(m.y) * p.y + Floats(m.z) * p.z + Floats(m.w);
    };
    const Floats depth = row(2), over_w = Floats(1.0f) / row(3);
    const Floats x = row(0) * over_w, y = row(1) * over_w;
    const Floats low(static_cast<float>(ShadowMap::kMargin)),
        high(static_cast<float>(map_.side() - ShadowMap::kMargin));
    inside = (depth > Floats(near_)) & (x >= low) & (y >= low) & (x <= high) & (y <= high);
    return {x, y, depth};
}

Floats SharpShadowMap::depth(const Vec3T<Floats>& p, float spread, Mask& inside) const {
    const auto [x, y, depth] = texels(p, inside);
    const Floats reach = depth * Floats(spread / texel()), end = Floats(static_cast<float>(map_.side())) - reach;
    inside = inside & (x >= reach) & (y >= reach) & (x <= end) & (y <= end);
    return depth;
}

Vec3T<Floats> SharpShadowMap::surface(const Vec3T<Floats>& p) const {
    Mask inside;
    const auto [x, y, depth] = texels(p, inside);
    const Floats zero(0.0f), half(0.5f), last(static_cast<float>(map_.side() - 1));
    const Floats column = xsimd::floor(clamp(x, zero, last)), row = xsimd::floor(clamp(y, zero, last));
    const Floats stored = gather(map_.reversed_depth().pixels().data(),
                                 truncated(row) * Ints(map_.side()) + truncated(column));
    const Floats seen = Floats(near_) / max(stored, Floats(1e-25f));
    return p + broadcast<Floats>(direction_) * (seen - depth) +
           broadcast<Floats>(origin_dx_) * (column + half - x) + broadcast<Floats>(origin_dy_) * (row + half - y);
}

Floats SharpShadowMap::visibility(const Vec3T<Floats>& p, Mask& inside) const {
    const auto [x, y, depth] = texels(p, inside);
    if (!xsimd::any(inside)) return Floats(1.0f);
    const Floats one(1.0f), half(0.5f), zero(0.0f);
    const Floats x0 = xsimd::floor(x - half), y0 = xsimd::floor(y - half), fx = x - half - x0, fy = y - half - y0;
    const Ints first = truncated(xsimd::select(inside, y0, zero)) * Ints(map_.side()) +
                       truncated(xsimd::select(inside, x0, zero));
    // A texel shades the point if its reversed depth exceeds this limit. A reversed depth of 0 means that it sees
    // nothing.
    const Floats limit = Floats(near_ * (1 + kRounding)) / max(depth, Floats(near_));
    const auto row = [&](int j) {
        const float* texels = map_.reversed_depth().pixels().data() + j * map_.side();
        const auto lit = [&](int i) { return xsimd::select(gather(texels + i, first) > limit, zero, one); };
        return lit(0) * (one - fx) + lit(1) * fx;
    };
    return row(0) * (one - fy) + row(1) * fy;
}

Floats SharpShadowMap::visibility(const Vec3T<Floats>& p, const Vec3T<Floats>& n, Mask& inside) const {
    const auto [x, y, depth] = texels(p, inside);
    if (!xsimd::any(inside)) return Floats(1.0f);
    const Floats zero(0.0f), half(0.5f);
    const Plane plane = this->plane(x, y, max(depth, Floats(near_)), n);
    const bool dithered = map_.dithered();
    const auto weights = dithered ? box : spline;
    // This is the distance from the first texel to the point, without the fraction f. It counts from the texel's
    // beginning for the box, and from its center for the spline.
    const Floats before(dithered ? 2.0f : 1.5f);
    const Floats x0 = xsimd::floor(x - before), y0 = xsimd::floor(y - before);
    const std::array<Floats, kTaps> across = weights(x - before - x0), down = weights(y - before - y0);
    const std::size_t taps = dithered ? kTaps : kTaps - 1; // the spline's last weight is 0
    const Ints side(map_.side());
    const Ints first = truncated(xsimd::select(inside, y0, zero)) * side +
                       truncated(xsimd::select(inside, x0, zero));
    const float* texels = map_.reversed_depth().pixels().data();
    std::array<std::array<Floats, kTaps>, kTaps> height; // of the texels' surfaces above the receiver's plane
    Mask any_above(false);
    for (std::size_t j = 0; j < taps; ++j)
        for (std::size_t i = 0; i < taps; ++i) {
            const Floats stored = gather(texels + static_cast<int>(j) * map_.side() + i, first);
            const Floats seen = map_.orthographic() ? Floats(-near_) / max(stored, Floats(1e-25f)) : stored;
            height[j][i] = seen - (plane.at + plane.dx * off(x0, i, x) + plane.dy * off(y0, j, y));
            any_above = any_above | (height[j][i] > plane.rounding);
        }
    if (!xsimd::any(inside & any_above)) return Floats(1.0f); // only a surface above the plane may shade
    const Floats roof_height = plane.steepest * Floats(kRoof);
    const Mask may_be_roof(!dithered); // a dithered map has several surfaces in turn
    // Returns where the surface with these slopes above the plane is turned from the plane by more than kTurned. In a
    // perspective view, slopes of the map's values are no slopes of the surface.
    const Floats per_texel(map_.orthographic() ? 1 / length(origin_dx_) : 0), one(1.0f);
    const Floats plane_x = plane.dx * per_texel, plane_y = plane.dy * per_texel,
                 plane_length = one + plane_x * plane_x + plane_y * plane_y;
    const auto turned = [&](const Floats& slope_x, const Floats& slope_y) {
        const Floats sx = multiply_add(slope_x, per_texel, plane_x), sy = multiply_add(slope_y, per_texel, plane_y);
        const Floats product = max(one + sx * plane_x + sy * plane_y, zero);
        return product * product < Floats(kTurned * kTurned) * plane_length * (one + sx * sx + sy * sy);
    };
    Floats dark(0.0f), known(0.0f);
    for (std::size_t j = 0; j < taps; ++j) {
        const Floats off_y = off(y0, j, y);
        Floats row_dark(0.0f), row_known(0.0f);
        for (std::size_t i = 0; i < taps; ++i) {
            const Floats off_x = off(x0, i, x), here = height[j][i];
            // The slope is that between two texels on one side of the point.
            const std::size_t a = i < 2 ? 0 : 2, b = j < 2 ? 0 : 2;
            const Floats slope_x = height[j][a + 1] - height[j][a], slope_y = height[b + 1][i] - height[b][i];
            const Floats continued = here - slope_x * off_x - slope_y * off_y;
            const Floats least = xsimd::select(turned(slope_x, slope_y), plane.rounding, roof_height);
            const Mask roof = may_be_roof & (here > plane.rounding) & (continued > plane.rounding + least);
            const Floats distance = xsimd::sqrt(off_x * off_x + off_y * off_y);
            const Mask shades = (here > plane.rounding + plane.rising * distance) | roof;
            row_dark += xsimd::select(shades, across[i], zero);
            const Mask away = plane.dx * off_x + plane.dy * off_y < zero; // lanes in which the plane recedes
            const Floats lowest = -plane.rounding - xsimd::select(away, plane.steepest, plane.falling) * distance;
            row_known += xsimd::select(here < lowest, zero, across[i]);
        }
        dark += row_dark * down[j], known += row_known * down[j];
    }
    return max(Floats(1.0f) - dark / max(known, Floats(kLeastKnown)), zero);
}

} // namespace duet::raster
