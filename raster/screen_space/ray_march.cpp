#include "raster/screen_space/ray_march.h"

#include "raster/screen_space/projected_ray.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// A height above the plane below this fraction of the distance between two points is rounding error.
constexpr float kSlack = 2e-3f;
/// This is ScreenHit::gap per meter behind the nearer side of an occluder. It is large, since deep behind an
/// occluder only mean colors are known.
constexpr float kHiddenBlur = 12;
constexpr int kExtraEdgePixels =
    4; ///< pixels along the edge to search beyond twice the offset of the first intersection
constexpr int kMinLevel = 3, kMaxLevel = 8; ///< blocks of 2^level pixels that lie behind the ray are skipped at once

/// Returns the distance at which a ray hits the plane of a pixel's surface from its front; infinity if it does not.
float distance_to_plane(const ScreenGBuffer& gbuffer, Vec3 p, Vec3 direction, int x, int y) {
    const std::optional<Vec3> seen = gbuffer.visible_point(x, y);
    if (!seen) return kInfinity;
    const Vec3 n = gbuffer.normal(x, y);
    const float towards = -dot(n, direction), height = dot(n, p - *seen);
    return towards > 1e-3f && height > 0 ? height / towards : kInfinity;
}

/// Returns whether a pixel shows a light that rays intersect directly. Such a light is not extrapolated.
bool shows_light(const ScreenGBuffer& gbuffer, int x, int y) { return gbuffer.color_prepass().light_mask(x, y) != 0; }
/// Returns whether the surface at a pixel may be extrapolated as flat.
bool continues_flat(const ScreenGBuffer& gbuffer, int x, int y) {
    return !shows_light(gbuffer, x, y) && is_flat(gbuffer, x, y);
}

/// Returns the greatest of the geometrically decreasing widths from `width` on that fits. It is 1 if none fits or
/// `width` is not finite.
template <typename F> float widest(float width, const F& fits) {
    if (!(width < kInfinity)) return 1;
    for (; width > 1; width *= 0.7f)
        if (fits(width)) return width;
    return 1;
}

/// Traces one ray in gbuffer space.
class RayMarch {
public:
    RayMarch(const ReflectionSource& source, const Box3& scene, const ScreenRay& ray)
        : source_(source), scene_(scene), ray_(ray), projected_(source.image, ray.p, ray.direction),
          per_step_x_(per(projected_.step_x())), per_step_y_(per(projected_.step_y())) {}

    std::optional<ScreenHit> march() {
        if (!(projected_.from().z > 0)) return std::nullopt;
        if (!projected_.spans_pixels()) return in_one_pixel();
        float before = projected_.reversed_depth(projected_.parameter(projected_.first() - 1));
        for (int i = projected_.first(); i <= projected_.last(); ++i) {
            i += skip_blocks(i, before);
            const float t = projected_.parameter(i), fx = projected_.x(t), fy = projected_.y(t),
                        reversed_depth = projected_.reversed_depth(t);
            if (source_.image.contains(fx, fy) && (i > 1 || !ray_.from_visible_surface)) { // outside only by rounding
                const auto x = static_cast<int>(fx), y = static_cast<int>(fy);
                if (std::min(before, reversed_depth) > source_.at(x, y).reversed_depth()(x, y))
                    hidden_since_ = -1, in_front_ = i;
                else if (const auto hit = test_step(i, t, fx, fy))
                    return hit;
            }
            before = reversed_depth;
        }
        return beyond_image();
    }

private:
    struct Pixel {
        int x = -1, y = -1;
        bool valid() const { return x >= 0; }
    };

    std::optional<ScreenHit> in_one_pixel() const {
        const Vec3 from = projected_.from();
        if (ray_.from_visible_surface || !source_.image.contains(from.x, from.y)) return std::nullopt;
        const auto x = static_cast<int>(from.x), y = static_cast<int>(from.y);
        const float beyond = source_.at(x, y).depth(x, y) - from.z,
                    deeper = source_.image.homogeneous_change(ray_.direction)[2];
        return deeper > 0 && beyond > 0 && beyond < kInfinity
                   ? std::optional(ScreenHit{from.x, from.y, beyond / deeper})
                   : std::nullopt;
    }

    /// Returns the number of steps from step i to the last one in a block of pixels that are all behind the ray,
    /// using the Hi-Z pyramid. The level increases after a block is skipped and decreases otherwise. `before` is the
    /// reversed depth at the previous step, and on return at the last skipped step.
    int skip_blocks(int i, float& before) {
        if (i < next_block_test_) return 0;
        const float t = projected_.parameter(i), fx = projected_.x(t), fy = projected_.y(t),
                    reversed_depth = projected_.reversed_depth(t);
        if (!source_.image.contains(fx, fy)) return 0;
        for (;; --level_) {
            const int more = std::min(steps_in_block(fx, fy, level_), projected_.last() - i);
            if (more > 0) {
                const float last = projected_.reversed_depth(projected_.parameter(i + more)),
                            farthest = std::min({before, reversed_depth, last});
                if (farthest > source_.image.max_reversed_depth(static_cast<int>(fx), static_cast<int>(fy), level_)) {
                    before = last, hidden_since_ = -1, in_front_ = i + more;
                    level_ = std::min(level_ + 1, kMaxLevel);
                    return more;
                }
            }
            if (level_ == kMinLevel) {
                next_block_test_ = i + std::max(more, 0) + 1;
                return 0;
            }
        }
    }
    /// Returns a lower bound of the number of steps that stay in the position's block of 2^level pixels.
    int steps_in_block(float x, float y, int level) const {
        const auto side = static_cast<float>(1 << level), per_side = 1 / side;
        const auto along = [&](float at, float step, float per_step) {
            const float from_edge = at - side * std::floor(at * per_side);
            return (step > 0 ? side - from_edge : from_edge) * per_step;
        };
        return static_cast<int>(
            std::min({along(x, projected_.step_x(), per_step_x_), along(y, projected_.step_y(), per_step_y_), 1e6f}) -
            0.01f);
    }

    /// Handles a step at which the ray may be behind the visible surface.
    std::optional<ScreenHit> test_step(int i, float t, float fx, float fy) {
        const auto x = static_cast<int>(fx), y = static_cast<int>(fy);
        const ScreenGBuffer& gbuffer = source_.at(x, y);
        const float before = projected_.depth(projected_.parameter(i - 1)), depth = projected_.depth(t),
                    distance = projected_.distance(t, depth);
        const float seen_depth = gbuffer.depth(x, y), far = std::max(before, depth), near = std::min(before, depth);
        const float known = gbuffer.thickness(x, y),
                    thickness = known > 0 ? known : std::max(2 * (far - near), kThickness * seen_depth);
        const bool passed = is_ignored(gbuffer, x, y);
        const bool behind = near > seen_depth + (passed ? 0 : thickness);
        if (behind && hidden_since_ < 0) hidden_since_ = distance_at(in_front_);
        if (hidden_since_ >= 0 && continues_flat(gbuffer, x, y)) {
            const float crossed = distance_to_plane(gbuffer, ray_.p, ray_.direction, x, y);
            if (crossed > hidden_since_ && crossed <= distance) {
                const ScreenHit hit = approximate_hit(gbuffer, fx, fy, crossed);
                return as_hidden(move_to_projection(hit, move_off_occluder(hit, seen_depth)));
            }
        }
        if (behind || passed) return std::nullopt;
        const auto hit = intersect_pixel(gbuffer, i, t, x, y, near, known > 0);
        if (!hit || hidden_since_ < 0) return hit;
        const auto flat =
            hit_on_extension(last_flat(i), hidden_since_); // the ray may have crossed that surface while hidden
        return flat && flat->distance < hit->distance ? flat : hit;
    }

    float distance_at(int step) const {
        const float t = projected_.parameter(step);
        return std::max(projected_.distance(t, projected_.depth(t)),
                        0.0f); // rounding may make it negative at the origin
    }

    /// Returns whether the ray ignores a pixel's surface. These are a light that is handled separately, and glass
    /// that the ray approaches from behind, whose refracted color is valid for the viewer only.
    bool is_ignored(const ScreenGBuffer& gbuffer, int x, int y) const {
        if (ray_.ignore_lights && shows_light(gbuffer, x, y)) return true;
        const ScreenGBuffer* behind = gbuffer.behind();
        return behind != nullptr && projected_.approaches_viewer() &&
               behind->color_prepass().objects(x, y) != gbuffer.color_prepass().objects(x, y);
    }

    /// Returns the hit with the surface at a pixel if the ray is within its thickness.
    std::optional<ScreenHit> intersect_pixel(const ScreenGBuffer& gbuffer, int i, float t, int x, int y, float near,
                                             bool closed) const {
        const std::optional<Vec3> seen = gbuffer.visible_point(x, y);
        if (!seen) return std::nullopt;
        const Vec3 step = *seen - ray_.p;
        const float depth = gbuffer.depth(x, y);
        const bool inside = closed && near > depth; // the ray came from behind or from the side
        if (!(dot(ray_.n, step) > kSlack * length(step)) && !(inside && !source_.is_own(x, y))) return std::nullopt;
        if (inside && gbuffer.normal_angle(x, y) >= kMaxSmoothAngle)
            return std::nullopt; // too little of the surface is visible
        if (inside)
            return approximate_hit(gbuffer, projected_.x(t), projected_.y(t),
                                   projected_.distance(t, projected_.depth(t)));
        if (closed && dot(gbuffer.normal(x, y), ray_.direction) >= 0)
            return std::nullopt; // the ray passes its silhouette
        const float crossing = clamp(projected_.parameter_at(depth), projected_.parameter(i - 1), t);
        return ScreenHit{in_pixel(projected_.x(crossing), x), in_pixel(projected_.y(crossing), y), length(step)};
    }

    /// Returns the last pixel of the ray inside the image.
    Pixel last() const {
        for (int i = projected_.last(); i >= projected_.first(); --i)
            if (const Pixel at = pixel(i); at.valid()) return at;
        const auto [x, y] = source_.image.pixel_at(projected_.from());
        return {x, y};
    }
    /// Returns the last pixel that shows no light. The surface behind a light is assumed to match the surface beside
    /// it.
    Pixel last_without_light() const {
        for (int i = projected_.last(); i >= projected_.first(); --i)
            if (const Pixel at = pixel(i); at.valid() && !shows_light(source_.at(at.x, at.y), at.x, at.y)) return at;
        return last();
    }
    /// Returns the last pixel, up to step i, that shows a flat surface behind the ray.
    Pixel last_flat(int i) const {
        for (; i >= projected_.first(); --i) {
            const Pixel at = pixel(i);
            if (!at.valid() || source_.is_own(at.x, at.y)) continue;
            const ScreenGBuffer& gbuffer = source_.at(at.x, at.y);
            const float depth = gbuffer.depth(at.x, at.y);
            if (!(depth < kInfinity)) return {}; // the surface in front of which the ray was ends here
            if (!continues_flat(gbuffer, at.x, at.y)) continue;
            if (std::max(projected_.depth(projected_.parameter(i - 1)), projected_.depth(projected_.parameter(i))) <
                depth)
                return at;
        }
        return {};
    }
    /// Returns the pixel of a step, or an invalid one if rounding moves it out of the image.
    Pixel pixel(int step) const {
        const float t = projected_.parameter(step), fx = projected_.x(t), fy = projected_.y(t);
        return source_.image.contains(fx, fy) ? Pixel{static_cast<int>(fx), static_cast<int>(fy)} : Pixel{};
    }

    /// Returns the hit with the plane of a pixel's flat surface beyond the distance `from`, with that pixel's color.
    std::optional<ScreenHit> hit_on_flat_plane(Pixel at, float from) const {
        const ScreenGBuffer& gbuffer = source_.at(at.x, at.y);
        const float crossed = distance_to_plane(gbuffer, ray_.p, ray_.direction, at.x, at.y);
        if (!(crossed > from) || crossed == kInfinity || !scene_.contains(ray_.p + ray_.direction * crossed))
            return std::nullopt;
        return approximate_hit(gbuffer, middle(at.x), middle(at.y), crossed);
    }
    /// Returns the hit with the extrapolated flat surface of a pixel, with the color of the flat-surface pyramid.
    std::optional<ScreenHit> hit_on_extension(Pixel at, float from) const {
        const auto hit = at.valid() ? hit_on_flat_plane(at, from) : std::nullopt;
        return hit ? std::optional(as_hidden(move_to_projection(*hit, *hit))) : std::nullopt;
    }

    std::optional<ScreenHit> beyond_image() const {
        const Pixel end = last(), shown = last_without_light();
        const ScreenGBuffer& gbuffer = source_.at(shown.x, shown.y);
        const bool own = source_.is_own(shown.x, shown.y);
        if (!own && !gbuffer.visible_point(shown.x, shown.y)) return std::nullopt;
        if (hidden_since_ >= 0) {
            if (const auto hit = hit_on_extension(last_flat(projected_.last()), hidden_since_)) return hit;
            if (ends_in_distance()) return behind_occluder(end);
            // The ray emerged in front of the viewer.
            return projected_.leaves_image() ? std::optional(at_end(shown)) : std::nullopt;
        }
        const bool flat =
            continues_flat(gbuffer, shown.x, shown.y); // otherwise a curved object is in front of it there
        if (!own && (!flat || !projected_.leaves_image()))
            if (const auto hit = hit_on_extension(flat ? shown : last_flat(projected_.last()), 0)) return hit;
        return projected_.leaves_image() ? along_edge(end) : std::nullopt;
    }

    /// Handles a ray that leaves the image in front of the surface at the edge, or over the mirror itself. It tests
    /// the flat surfaces along the edge, at increasing offsets, that extend to the ray. It returns the nearest hit
    /// among those up to a little beyond the first one found.
    std::optional<ScreenHit> along_edge(Pixel end) const {
        const bool at_side = projected_.leaves_at_side();
        const float t = projected_.parameter(projected_.last()), left = projected_.distance(t, projected_.depth(t));
        std::optional<ScreenHit> nearest;
        for (int i = 0, most = at_side ? source_.image.height() : source_.image.width(); i < most; i += 1 + i / 4)
            for (const int step : {-i, i}) {
                const Pixel at = at_side ? Pixel{end.x, end.y + step} : Pixel{end.x + step, end.y};
                const std::optional<ScreenHit> hit = flat_beyond(at, i == 0 ? 0 : left);
                if (!hit || (nearest && nearest->distance <= hit->distance) ||
                    !is_before_plane(edge_before(*hit, end), at))
                    continue;
                if (!nearest) most = std::min(most, 2 * i + kExtraEdgePixels);
                nearest = hit;
            }
        return nearest ? std::optional(as_hidden(move_to_projection(*nearest, *nearest))) : std::nullopt;
    }
    /// Returns the hit with the flat surface of an edge pixel beyond `left`, the distance at which the ray leaves the
    /// image.
    std::optional<ScreenHit> flat_beyond(Pixel at, float left) const {
        if (!source_.image.contains(middle(at.x), middle(at.y)) || source_.is_own(at.x, at.y)) return std::nullopt;
        return continues_flat(source_.at(at.x, at.y), at.x, at.y) ? hit_on_flat_plane(at, left) : std::nullopt;
    }
    /// Returns whether the surface at one pixel is on or in front of the plane of another, which may then continue
    /// behind it.
    bool is_before_plane(Pixel at, Pixel other) const {
        const ScreenGBuffer& gbuffer = source_.at(other.x, other.y);
        const std::optional<Vec3> seen = source_.at(at.x, at.y).visible_point(at.x, at.y),
                                  on = gbuffer.visible_point(other.x, other.y);
        return seen && on && dot(gbuffer.normal(other.x, other.y), *seen - *on) >= -kSlack * length(*seen - *on);
    }
    /// Returns the edge pixel nearest to a hit outside the image, or `end` if the hit is beside or behind the viewer.
    Pixel edge_before(const ScreenHit& hit, Pixel end) const {
        const Vec3 projected = source_.image.project(ray_.p + ray_.direction * hit.distance);
        if (!(projected.z > source_.image.near())) return end;
        const auto [x, y] = source_.image.pixel_at(projected);
        return projected_.leaves_at_side() ? Pixel{end.x, y} : Pixel{x, end.y};
    }

    /// Returns whether the ray's end is inside the image and away from the viewer.
    bool ends_in_distance() const { return !projected_.leaves_image() && !projected_.approaches_viewer(); }
    /// Handles a ray that is hidden up to its end. It hits the first flat surface beyond the occluder whose plane it
    /// crosses, or the background.
    std::optional<ScreenHit> behind_occluder(Pixel end) const {
        for (int i = projected_.last() + 1;; ++i) {
            const Pixel at = pixel(i);
            if (!at.valid()) return at_end(end);
            const ScreenGBuffer& gbuffer = source_.at(at.x, at.y);
            if (!gbuffer.visible_point(at.x, at.y)) return std::nullopt;
            if (source_.is_own(at.x, at.y) || !continues_flat(gbuffer, at.x, at.y)) continue;
            if (const auto hit = hit_on_extension(at, hidden_since_)) return hit;
        }
    }
    ScreenHit at_end(Pixel end) const {
        return as_hidden(approximate_hit(source_.at(end.x, end.y), middle(end.x), middle(end.y), hidden_since_));
    }

    /// Returns a hit at a distance with the color of a pixel, as an approximate hit.
    ScreenHit approximate_hit(const ScreenGBuffer& gbuffer, float x, float y, float distance) const {
        const std::optional<Vec3> seen = gbuffer.visible_point(static_cast<int>(x), static_cast<int>(y));
        return {x, y, distance, seen ? length(*seen - ray_.p - ray_.direction * distance) : 0.0f};
    }
    /// Returns whether another object begins behind the position's object on either side of the ray.
    bool at_own_edge(float fx, float fy) const {
        const auto [x, y] = source_.image.pixel_at({fx, fy, 0});
        const std::uint32_t object = source_.at(x, y).color_prepass().objects(x, y);
        for (const float side : {-1.0f, 1.0f}) {
            const auto [i, k] =
                source_.image.pixel_at({fx - side * projected_.step_y(), fy + side * projected_.step_x(), 0});
            const ScreenGBuffer& gbuffer = source_.at(i, k);
            if (gbuffer.color_prepass().objects(i, k) != object && gbuffer.depth(i, k) > source_.at(x, y).depth(x, y))
                return true;
        }
        return false;
    }
    /// Moves the hit of a flat surface to its projected position. In the flat-surface pyramid, surfaces continue
    /// behind curved objects and beyond the image's edge. Returns `otherwise` behind a flat object and at the
    /// surface's own border.
    ScreenHit move_to_projection(ScreenHit hit, const ScreenHit& otherwise) const {
        const Vec3 projected = source_.image.project(ray_.p + ray_.direction * hit.distance);
        if (!(projected.z > 0) || !source_.image.contains(projected.x, projected.y)) {
            const Pixel end = last();
            hit.x = middle(end.x), hit.y = middle(end.y);
            return hit;
        }
        const auto [x, y] = source_.image.pixel_at(projected);
        const ScreenGBuffer& there = source_.at(x, y);
        if (is_flat(there, x, y) && there.depth(x, y) < (1 - kSameSurface) * projected.z) return otherwise;
        if (at_own_edge(hit.x, hit.y)) return otherwise;
        if (hidden_since_ >= 0) hit.gap = kHiddenBlur * std::min(hit.gap, hit.distance - hidden_since_);
        hit.x = projected.x, hit.y = projected.y;
        return hit;
    }
    /// Moves the hit away from the occluder, so that even a blurred lookup excludes the occluder's color.
    ScreenHit move_off_occluder(ScreenHit hit, float depth) const {
        const float most = 0.1f * static_cast<float>(source_.image.width());
        const float aside = std::min(0.5f * kGuessBlur * hit.gap / source_.image.pixel_size(depth), most);
        const float x = hit.x + aside * projected_.step_x(), y = hit.y + aside * projected_.step_y();
        if (source_.image.contains(x, y)) hit.x = x, hit.y = y;
        return hit;
    }
    static ScreenHit as_hidden(ScreenHit hit) {
        hit.hidden = true;
        return hit;
    }
    /// Clamps a coordinate to the pixel that was hit.
    static float in_pixel(float at, int pixel) {
        return clamp(at, static_cast<float>(pixel), static_cast<float>(pixel) + 0.99f);
    }
    /// The inverse of a zero step is infinity, so it is bounded.
    static float per(float step) { return std::min(1 / std::abs(step), 1e9f); }
    static float middle(int pixel) { return static_cast<float>(pixel) + 0.5f; }

    const ReflectionSource& source_;
    const Box3& scene_;
    ScreenRay ray_;
    ProjectedRay projected_;
    float per_step_x_, per_step_y_; ///< steps per pixel
    /// Stores the pyramid level of the next block, and the step at which to test it after the last block was not
    /// skipped.
    int level_ = kMinLevel, next_block_test_ = 3;
    int in_front_ = 0;        ///< last step in front of the visible surface
    float hidden_since_ = -1; ///< distance at which the ray became hidden; negative: it did not
};

} // namespace

bool ReflectionSource::shows_one_object(float x, float y, float reach) const {
    const auto object_at = [&](float i, float k) {
        const auto [column, row] = image.pixel_at({i, k, 0});
        return at(column, row).color_prepass().objects(column, row);
    };
    const std::uint32_t seen = object_at(x, y);
    const auto same = [&](float dx, float dy) { return object_at(x + dx * reach, y + dy * reach) == seen; };
    return same(-1, -1) && same(1, -1) && same(-1, 1) && same(1, 1);
}

bool ReflectionSource::includes_own(float x, float y, float reach) const {
    if (behind_object != nullptr) return false; // the layer without this object does not contain it
    for (const float dx : {-reach, reach})
        for (const float dy : {-reach, reach}) {
            const auto [column, row] = image.pixel_at({x + dx, y + dy, 0});
            if (is_own(column, row)) return true;
        }
    return false;
}

float ReflectionSource::max_width_without_own(float x, float y, float width) const {
    return includes_own(x, y, 0) ? width : widest(width, [&](float wide) { return !includes_own(x, y, 2 * wide); });
}

float ReflectionSource::max_width_on_object(float x, float y, float width) const {
    // The reach is that of the coarser mip level, between its pixels.
    return widest(width, [&](float wide) { return shows_one_object(x, y, 2 * wide); });
}

std::optional<ScreenHit> march_ray(const ReflectionSource& source, const Box3& scene, const ScreenRay& ray) {
    return RayMarch(source, scene, ray).march();
}

} // namespace duet::raster
