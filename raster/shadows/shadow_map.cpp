#include "raster/shadows/shadow_map.h"

#include "raster/raster_scene.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {

ShadowMap::ShadowMap(const RasterScene& casters, const Camera& camera, int side, int threads)
    : view_(CameraModel({camera, side, side}).pinhole()),
      orthographic_(camera.projection == Camera::Projection::kOrthographic), layered_(casters.data().has_layers()) {
    RasterSettings settings;
    settings.output = Output::kReversedDepth;
    settings.threads = threads;
    Control control;
    reversed_depth_ = std::move(render(casters, {camera, side, side}, settings, control).reversed_depth);
}

std::optional<Vec3d> ShadowMap::project(Vec3d p, double margin) const {
    const Vec4d h = view_.world_to_pixel * Vec4d(p, 1.0);
    const double most = side() - margin;
    if (!(h.z > view_.near) || !(h.x >= margin * h.w && h.x <= most * h.w && h.y >= margin * h.w && h.y <= most * h.w))
        return std::nullopt;
    return Vec3d(h.x / h.w, h.y / h.w, h.z);
}

double ShadowMap::texel(double depth) const {
    return orthographic_ ? length(view_.origin_dx) : length(view_.direction_dx) * depth;
}

/// This is the receiver's plane as a linear function of texel coordinates; its value is larger where the plane is
/// nearer to the light. It includes the tolerances within which a texel's surface still counts as the receiver's own.
struct ShadowMap::Plane {
    double at, dx, dy; ///< value at the receiver's position; change per texel
    double rounding; ///< rounding error, at every texel
    double of_depths; ///< rounding error of a surface perpendicular to the light
    double texel; ///< width of one texel
    /// Additional tolerance per texel of distance, above (`rising`) and below (`falling`) the plane. The components
    /// are for the light's side of the receiver and the opposite side.
    Vec2d rising, falling;
};

/// The plane n·(q − p) = 0 meets a texel's ray o + d·w at the depth d = n·(p − o)/n·w. In a perspective view o
/// is constant and 1/d is linear in w. In an orthographic view w is constant and d is linear in o.
ShadowMap::Plane ShadowMap::plane(const Receiver& receiver, Vec3d projected) const {
    const Vec3d n = receiver.n;
    const Vec3d direction =
        view_.direction + view_.direction_dx * projected.x + view_.direction_dy * projected.y; // at unit depth
    const double towards = max(-dot(n, direction), 1e-9), cosine = towards / length(direction);
    const double of_depths = 2 * receiver.error + projected.z * 0x1p-22, rounding = of_depths / towards;
    const double width = this->texel(projected.z), texel = width / towards;
    // These are the heights, per unit of distance from the light's ray through the receiver, of facets that rise from
    // the receiver's plane at the tangent t. The light has the elevation asin(cosine). The components are for the
    // near and the far side of the ray.
    const double sine = std::sqrt(max(1 - cosine * cosine, 0.0)), elevation = cosine / max(sine, 1e-9);
    const double scale = orthographic_ ? 1 : view_.near / sqr(projected.z); // derivative of 1/d with respect to depth
    const auto heights = [&](double of_elevation) {
        const double t = min(kSteepest, of_elevation * elevation);
        return Vec2d(t / (cosine - t * sine), kSteepest / (cosine + kSteepest * sine)) * (texel * scale);
    };
    const Vec2d rising = heights(kOfElevation), falling = heights(kFalling);
    if (orthographic_)
        return {-projected.z,
                dot(n, view_.origin_dx) / -towards,
                dot(n, view_.origin_dy) / -towards,
                rounding,
                of_depths,
                width,
                rising,
                falling};
    const double at = view_.near / projected.z;
    // 1/d changes by n·dw/(n·w d) for a change dw of w.
    return {at, at * dot(n, view_.direction_dx) / -towards, at * dot(n, view_.direction_dy) / -towards,
            rounding * scale, of_depths * scale, width * scale, rising, falling};
}

namespace {

/// Returns the weights of the quadratic B-spline for four samples. The first is at −1.5 + (1 − f) from the center,
/// with f in [0, 1). The spline is the box of a texel convolved twice with itself.
std::array<double, 4> spline(double f) {
    const auto b = [](double x) {
        x = std::abs(x);
        return x < 0.5 ? 0.75 - x * x : x < 1.5 ? 0.5 * sqr(1.5 - x) : 0.0;
    };
    return {b(1 + f), b(f), b(1 - f), b(2 - f)};
}

/// Returns the weights of a box of 4 texels over five. The box has left the first texel by f of its width, with f in
/// [0, 1).
std::array<double, 5> box(double f) { return {(1 - f) / 4, 0.25, 0.25, 0.25, f / 4}; }

} // namespace

float ShadowMap::lit_fraction(const Receiver& receiver, Vec3d projected) const {
    if (dot(receiver.n, view_.direction + view_.direction_dx * projected.x + view_.direction_dy * projected.y) >= 0)
        return 1;
    const double first = layered_ ? kLayeredRadius : 0.5;
    const double left = std::floor(projected.x - first), top = std::floor(projected.y - first);
    const double fx = projected.x - first - left, fy = projected.y - first - top;
    const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
    return layered_ ? lit_fraction<5>(receiver, projected, x0, y0, box(fx), box(fy))
                    : lit_fraction<4>(receiver, projected, x0 - 1, y0 - 1, spline(fx), spline(fy));
}

/// Returns the height above the receiver, on the light's ray through it, of the tangent plane of the surface at texel
/// (x, y). The unit is that surface's rounding error, which grows with its slope but is limited to that of the
/// receiver's plane.
/// The reversed depth of a surface that is convex from the receiver through the texel and beyond is a convex function
/// f of texel coordinates, for which f(c) − (f(c + e) − f(c)) |r| ≤ f(c − r e). So differences taken away from
/// the receiver never shade the receiver by its own concave surface, wherever the creases are.
double ShadowMap::roundings_over_receiver(const Plane& plane, Vec3d projected, int x, int y) const {
    const double right = x + 0.5 - projected.x, below = y + 0.5 - projected.y;
    // Slopes are taken in the direction away from the receiver. On a convex surface three successive slopes increase.
    // Their median ignores a single depth discontinuity.
    const auto slope = [&](int step_x, int step_y) {
        const int last = side() - 1;
        const auto at = [&](int i) {
            return value_at(std::clamp(x + i * step_x, 0, last), std::clamp(y + i * step_y, 0, last));
        };
        const double here = at(0), next = at(1), before = here - at(-1), after = next - here, beyond = at(2) - next;
        return max(min(before, after), min(max(before, after), beyond));
    };
    const double across = slope(right < 0 ? -1 : 1, 0), down = slope(0, below < 0 ? -1 : 1);
    const double height = value_at(x, y) - plane.at - across * std::abs(right) - down * std::abs(below);
    return height / min(plane.of_depths * std::sqrt(1 + (sqr(across) + sqr(down)) / sqr(plane.texel)), plane.rounding);
}

/// Returns whether all four texels around the position see a surface above the receiver. By convexity that surface
/// then covers the receiver's ray. This detects a roof that touches a steep wall, where most texels see the roof
/// below the wall's plane, as they would see a surface beyond a ridge.
bool ShadowMap::is_covered(const Plane& plane, Vec3d projected) const {
    const int x = static_cast<int>(std::floor(projected.x - 0.5)), y = static_cast<int>(std::floor(projected.y - 0.5));
    const auto over = [&](int column, int row) {
        return roundings_over_receiver(plane, projected, column, row) > kFourDepths;
    };
    return over(x, y) && over(x + 1, y) && over(x, y + 1) && over(x + 1, y + 1);
}

/// Returns the weighted lit fraction of N × N texels, the first at (x0, y0).
template <std::size_t N>
float ShadowMap::lit_fraction(const Receiver& receiver, Vec3d projected, int x0, int y0,
                              const std::array<double, N>& across, const std::array<double, N>& down) const {
    const Plane plane = this->plane(receiver, projected);
    constexpr int kSide = static_cast<int>(N);
    double dark = 0, contact = 0, known = 0, under = 0;
    bool touched = false; // also by a texel of zero weight
    for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column) {
            const int x = x0 + column, y = y0 + row;
            const double seen = this->value_at(x, y);
            const double right = x + 0.5 - projected.x, below = y + 0.5 - projected.y;
            const double change = plane.dx * right + plane.dy * below, over = seen - (plane.at + change);
            const double beside = max(std::abs(right), std::abs(below));
            const auto slack = [&](Vec2d heights) { return plane.rounding + (change < 0 ? heights.y : heights.x) *
                beside; };
            if (over < -slack(plane.falling)) continue;
            const bool near = over <= slack(plane.rising);
            const bool blocks =
                over > plane.rounding && (!near || roundings_over_receiver(plane, projected, x, y) > kDepths);
            if (blocks && seen <= plane.at) continue;
            const double weight = across[static_cast<std::size_t>(column)] * down[static_cast<std::size_t>(row)];
            (over < -plane.rounding ? under : known) += weight;
            if (blocks) (near ? contact : dark) += weight;
            touched |= blocks && near;
        }
    // Where facets are about as small as texels, depth differences mix the slopes of several facets, and some texels
    // wrongly seem to rise above the receiver's plane. Contact with an opaque surface therefore counts only if most
    // texels report it. Contact with a dithered alpha-blended layer always counts.
    if (layered_ || dark + contact > kContactsShade * (known + under)) dark += contact;
    if (!layered_ && dark > 0 && known < kUnsure && is_covered(plane, projected)) return 0;
    // Next to a contact, a surface below the plane may belong to the contacting object, so it does not prove a ridge.
    if (!touched) known += under;
    return static_cast<float>(1 - dark / max(known, kMinKnown));
}

} // namespace duet::raster
