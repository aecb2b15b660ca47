// The examiner's own shadow maps for assignment 5. They can make each of the typical mistakes, so that a wrong answer
// is recognized by its likeness.
#pragma once

#include "common/vec/ray.h"
#include "compare/lessons/assignments/5-shadow-maps/reference_shadows.h"
#include "tests/grading/judge.h"

namespace duet::grading {

using lab::LightView, lab::ShadowMap;

inline double depth_at(const LightView& view, bool spot, double t) {
    const double near = view.near, far = view.far;
    return spot ? far * (t - near) / (t * (far - near)) : (t - near) / (far - near);
}
inline double distance_at(const LightView& view, bool spot, double depth) {
    const double near = view.near, far = view.far;
    if (depth == kInfinity) return kInfinity;
    return spot ? far * near / (far - depth * (far - near)) : near + depth * (far - near);
}

/// The examiner's camera of a light. `center` is the middle of what the sun's map shows, `size` its width.
inline LightView view_of(const Light& light, double near, double far, Vec3d center = {}, double size = 0) {
    const LightFrame frame(light);
    const double width = light.spot ? 2 * std::tan(d(light.half_angle)) : size;
    const auto row = [&](Vec3d axis, double scale, double constant) {
        return std::array{axis.x * scale, axis.y * scale, axis.z * scale,
                          constant - scale * dot(axis, light.spot ? frame.position : center)};
    };
    Mat4d m;
    m[0] = row(frame.right, 2 / width, 0), m[1] = row(frame.up, 2 / width, 0);
    m[2] = light.spot ? row(frame.forward, far / (far - near), -far * near / (far - near))
                      : row(frame.forward, 1 / (far - near), 0.5);
    if (light.spot) m[3] = row(frame.forward, 1, 0);
    return {Mat4(m), static_cast<float>(near), static_cast<float>(far), static_cast<float>(width)};
}
inline LightView view_of(const Light& light, const Scene& scene) {
    const Extent e = extent_of(light, scene);
    const double size = 1.05 * length(e.box.diagonal());
    return light.spot ? view_of(light, e.near < 0.05 ? 0.05 : 0.9 * e.near, 1.05 * e.far)
                      : view_of(light, 0, size, e.box.center(), size);
}

/// The light's ray through a column and a row of a map, with fractions: t is the distance along the light.
inline Rayd map_ray(const Light& light, const LightView& view, int side, double column, double row) {
    const Mat4d m(view.clip_from_world);
    const double x = 2 * column / side - 1, y = 1 - 2 * row / side;
    const auto axis = [&](std::size_t i) { return Vec3d(m[i][0], m[i][1], m[i][2]); };
    const auto origin = [&](std::size_t i, double at) { return axis(i) * ((at - m[i][3]) / dot(axis(i), axis(i))); };
    if (!light.spot) return {origin(0, x) + origin(1, y) + origin(2, 0), Vec3d(light.direction)};
    const double half = d(view.width) / 2;
    return {Vec3d(light.position), Vec3d(light.direction) + (normalize(axis(0)) * x + normalize(axis(1)) * y) * half};
}
inline double first_distance(const Scene& scene, const Rayd& ray, const LightView& view) {
    return first_hit(scene, ray.origin, ray.direction, view.near).t;
}
/// The same as a wrong depth_map finds it.
enum DepthMistake { kFarthest, kLast, kUnclipped, kDropped };
inline double first_distance(const Scene& scene, const Rayd& ray, const LightView& view, DepthMistake mode) {
    double best = kInfinity;
    for (const Triangle& t : scene.triangles) {
        const auto in_front = [&](Vec3 p) { return (Mat4d(view.clip_from_world) * Vec4d(Vec3d(p), 1.0)).z >= 0; };
        const bool whole = in_front(t.a) && in_front(t.b) && in_front(t.c);
        const double hit = hit_triangle(t.a, t.b, t.c, ray.origin, ray.direction);
        if (hit == kInfinity || hit < (mode == kUnclipped ? 1e-3 : d(view.near)) || (mode == kDropped && !whole))
            continue;
        if (best == kInfinity || mode == kLast || (mode == kFarthest ? hit > best : hit < best)) best = hit;
    }
    return best;
}
inline ShadowMap traced_map(const Scene& scene, const Light& light, const LightView& view, int side) {
    return {view, each_pixel(side, side, [&](int x, int y) {
                const double t = first_distance(scene, map_ray(light, view, side, x + 0.5, y + 0.5), view);
                const double depth = t < kInfinity ? depth_at(view, light.spot, t) : kInfinity;
                return static_cast<float>(depth);
            })};
}

/// How a student may ask the map. The right way has nothing set.
struct LookupMistake {
    bool flipped = false, undivided = false, rounded = false, no_bias = false, bias_added = false, reversed = false,
         outside_dark = false, empty_dark = false, cone_ignored = false, cut = false, dark_share = false,
         mean_of_depths = false;
};
inline double looked_up_visibility(const ShadowMap& map, const Light& light, Vec3d p, Vec3d n, int reach,
                                   LookupMistake way = {}) {
    const LightFrame frame(light);
    if (!frame.shines_on(p, n) && !(way.cone_ignored && dot(n, frame.toward(p)) > 0)) return 0;
    const int side = map.depth.width();
    const Vec4d q = Mat4d(map.view.clip_from_world) * Vec4d(p, 1.0);
    const double w = way.undivided ? 1 : q.w, t = light.spot ? q.w : distance_at(map.view, false, q.z);
    const double x = (1 + q.x / w) / 2 * side, y = (way.flipped ? 1 + q.y / w : 1 - q.y / w) / 2 * side;
    const double texel = d(map.view.width) / side * (light.spot ? t : 1), along = std::max(-dot(n, frame.ray(p)), 0.1);
    const double slope = std::sqrt(std::max(0.0, 1 - sqr(dot(n, frame.forward)))) / along;
    double bias = (reach + 0.51) * std::sqrt(2.0) * texel * slope + 2e-4 * t;
    if (way.no_bias) bias = 0;
    if (way.bias_added) bias = -bias;
    const auto whole = [&](double v) { return static_cast<int>(way.rounded ? std::round(v) : std::floor(v)); };
    double lit = 0, all = 0, sum = 0;
    for (int j = whole(y) - reach; j <= whole(y) + reach - way.cut; ++j)
        for (int i = whole(x) - reach; i <= whole(x) + reach - way.cut; ++i) {
            const bool outside = i < 0 || j < 0 || i >= side || j >= side;
            double stored =
                outside ? (way.outside_dark ? -1e9 : kInfinity) : distance_at(map.view, light.spot, d(map.depth(i, j)));
            if (way.empty_dark && !outside && stored == kInfinity) stored = 0;
            all += 1, sum += std::min(stored, 1e3), lit += (t - bias <= stored) != way.reversed;
        }
    if (way.mean_of_depths) return t - bias <= sum / all;
    return way.dark_share ? 1 - lit / all : lit / all;
}
inline ImageFloat looked_up_visibility(const ShadowMap& map, const Light& light, const GBuffer& gbuffer, int reach,
                                       LookupMistake way = {}) {
    return each_pixel(gbuffer.point.width(), gbuffer.point.height(), [&](int x, int y) {
        return static_cast<float>(
            looked_up_visibility(map, light, Vec3d(gbuffer.point(x, y)), Vec3d(gbuffer.normal(x, y)), reach, way));
    });
}
/// What each way gives, and its text.
inline std::vector<Mistake<ImageFloat>> mistakes_of(const ShadowMap& map, const Light& light, const GBuffer& gbuffer,
                                                    int reach) {
    const std::vector<WrongMethod<LookupMistake>> ways{
        {{.flipped = true}, "The rows are upside down: y points up in clip space, but row 0 is the top row."},
        {{.undivided = true}, "The division by w is missing: the map of a spot light is in perspective."},
        {{.rounded = true}, "The middle texel is not the one in which the point lies: use std::floor."},
        {{.reversed = true}, "The comparison is turned around: a point is lit if nothing is nearer to the light."},
        {{.bias_added = true},
         "The bias has the wrong sign: the surface must count as nearer to the light than it is."},
        {{.no_bias = true}, "This is shadow acne as without any bias: each texel is a step that shades the next one."},
        {{.outside_dark = true}, "What the map doesn't hold is dark: it must be lit."},
        {{.empty_dark = true},
         "Empty texels throw shadows. Their depth is infinite: put into the formula of the "
         "distance, it gives 0."},
        {{.cone_ignored = true}, "The spot light shines outside of its cone: there it must be dark."},
        {{.cut = true}, "One row and one column are missing: from -reach to +reach, both included."},
        {{.mean_of_depths = true}, "The depths are averaged and compared then. Compare each, and average the answers."},
        {{.dark_share = true}, "This is the fraction that is in shadow."}};
    const ShadowMap empty{map.view, ImageFloat(1, 1, kInfinity)};
    std::vector<Mistake<ImageFloat>> mistakes{
        {looked_up_visibility(empty, light, gbuffer, 0), "There are no shadows: all that faces the light is lit."}};
    for (const auto& [way, text] : ways)
        mistakes.push_back({looked_up_visibility(map, light, gbuffer, reach, way), text});
    return mistakes;
}

} // namespace duet::grading
