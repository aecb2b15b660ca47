#include "raster/screen/screen_reflection.h"

#include "raster/screen/crossing.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

/// A height above the plane below this fraction of the distance between two points is rounding error.
constexpr float kSlack = 2e-3f;
/// This is ScreenHit::gap per meter behind the nearer side of an occluder. It is large, since deep behind an
/// occluder only mean colors are known.
constexpr float kHiddenBlur = 12;
constexpr int kBesideFirst = 4; ///< pixels along the edge to search beyond twice the offset of the first intersection
constexpr int kLeastLevel = 3, kMostLevel = 8; ///< blocks of 2^level pixels that lie behind the ray are skipped at once

/// Returns the distance at which a ray hits the plane of a pixel's surface from its front; infinity if it does not.
float meets_plane(const Screen& screen, Vec3 p, Vec3 way, int x, int y) {
    const std::optional<Vec3> seen = screen.seen(x, y);
    if (!seen) return kInfinity;
    const Vec3 n = screen.normal(x, y);
    const float towards = -dot(n, way), height = dot(n, p - *seen);
    return towards > 1e-3f && height > 0 ? height / towards : kInfinity;
}

/// Returns whether a pixel shows a light that rays intersect directly. Such a light is not extrapolated.
bool shows_lamp(const Screen& screen, int x, int y) { return screen.first_look().lamps(x, y) != 0; }
/// Returns whether the surface at a pixel may be extrapolated as flat.
bool goes_on_flat(const Screen& screen, int x, int y) { return !shows_lamp(screen, x, y) && is_flat(screen, x, y); }

/// Returns the greatest of the geometrically decreasing widths from `width` on that fits. It is 1 if none fits or
/// `width` is not finite.
template <typename F> float widest(float width, const F& fits) {
    if (!(width < kInfinity)) return 1;
    for (; width > 1; width *= 0.7f)
        if (fits(width)) return width;
    return 1;
}

/// Traces one ray in screen space.
class ScreenTrace {
public:
    ScreenTrace(const Scenery& scenery, const Box3& scene, const ScreenRay& ray)
        : scenery_(scenery), scene_(scene), ray_(ray), line_(scenery.all, ray.p, ray.way),
          per_step_x_(per(line_.step_x())),
          per_step_y_(per(line_.step_y())) {}

    std::optional<ScreenHit> follow() {
        if (!(line_.from().z > 0)) return std::nullopt;
        if (!line_.moves()) return in_one_pixel();
        float before = line_.nearness(line_.part(line_.first() - 1));
        for (int i = line_.first(); i <= line_.last(); ++i) {
            i += passed_at_once(i, before);
            const float t = line_.part(i), fx = line_.x(t), fy = line_.y(t), nearness = line_.nearness(t);
            if (scenery_.all.contains(fx, fy) && (i > 1 || !ray_.from_picture)) { // outside only by rounding
                const auto x = static_cast<int>(fx), y = static_cast<int>(fy);
                if (std::min(before, nearness) > scenery_.at(x, y).nearness()(x, y))
                    hidden_from_ = -1, in_front_ = i;
                else if (const auto hit = visit(i, t, fx, fy))
                    return hit;
            }
            before = nearness;
        }
        return beyond_edge();
    }

private:
    struct Pixel {
        int x = -1, y = -1;
        bool valid() const { return x >= 0; }
    };

    std::optional<ScreenHit> in_one_pixel() const {
        const Vec3 from = line_.from();
        if (ray_.from_picture || !scenery_.all.contains(from.x, from.y)) return std::nullopt;
        const auto x = static_cast<int>(from.x), y = static_cast<int>(from.y);
        const float beyond = scenery_.at(x, y).depth(x, y) - from.z,
                    deeper = scenery_.all.homogeneous_change(ray_.way)[2];
        return deeper > 0 && beyond > 0 && beyond < kInfinity
                   ? std::optional(ScreenHit{from.x, from.y, beyond / deeper})
                   : std::nullopt;
    }

    /// Returns the number of steps from step i to the last one in a block of pixels that are all behind the ray,
    /// using the Hi-Z pyramid. The level increases after a block is skipped and decreases otherwise. `before` is the
    /// reversed depth at the previous step, and on return at the last skipped step.
    int passed_at_once(int i, float& before) {
        if (i < look_again_) return 0;
        const float t = line_.part(i), fx = line_.x(t), fy = line_.y(t), nearness = line_.nearness(t);
        if (!scenery_.all.contains(fx, fy)) return 0;
        for (;; --level_) {
            const int more = std::min(steps_in_block(fx, fy, level_), line_.last() - i);
            if (more > 0) {
                const float last = line_.nearness(line_.part(i + more)), farthest = std::min({before, nearness, last});
                if (farthest > scenery_.all.greatest_nearness(static_cast<int>(fx), static_cast<int>(fy), level_)) {
                    before = last, hidden_from_ = -1, in_front_ = i + more;
                    level_ = std::min(level_ + 1, kMostLevel);
                    return more;
                }
            }
            if (level_ == kLeastLevel) {
                look_again_ = i + std::max(more, 0) + 1;
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
        return static_cast<int>(std::min({along(x, line_.step_x(), per_step_x_), along(y, line_.step_y(), per_step_y_),
                                          1e6f}) - 0.01f);
    }

    /// Handles a step at which the ray may be behind the visible surface.
    std::optional<ScreenHit> visit(int i, float t, float fx, float fy) {
        const auto x = static_cast<int>(fx), y = static_cast<int>(fy);
        const Screen& screen = scenery_.at(x, y);
        const float before = line_.depth(line_.part(i - 1)), depth = line_.depth(t),
                    distance = line_.distance(t, depth);
        const float seen_depth = screen.depth(x, y), far = std::max(before, depth), near = std::min(before, depth);
        const float known = screen.thickness(x, y),
                    thickness = known > 0 ? known : std::max(2 * (far - near), kThickness * seen_depth);
        const bool passed = is_passed(screen, x, y);
        const bool behind = near > seen_depth + (passed ? 0 : thickness);
        if (behind && hidden_from_ < 0) hidden_from_ = distance_at(in_front_);
        if (hidden_from_ >= 0 && goes_on_flat(screen, x, y)) {
            const float crossed = meets_plane(screen, ray_.p, ray_.way, x, y);
            if (crossed > hidden_from_ && crossed <= distance) {
                const ScreenHit hit = guess(screen, fx, fy, crossed);
                return of_hidden(flat_at(hit, beside_edge(hit, seen_depth)));
            }
        }
        if (behind || passed) return std::nullopt;
        const auto hit = meet(screen, i, t, x, y, near, known > 0);
        if (!hit || hidden_from_ < 0) return hit;
        const auto flat = goes_on(last_flat(i), hidden_from_); // the ray may have crossed that surface while hidden
        return flat && flat->distance < hit->distance ? flat : hit;
    }

    float distance_at(int step) const {
        const float t = line_.part(step);
        return std::max(line_.distance(t, line_.depth(t)), 0.0f); // rounding may make it negative at the origin
    }

    /// Returns whether the ray ignores a pixel's surface. These are a light that is handled separately, and glass
    /// that the ray approaches from behind, whose refracted color is valid for the viewer only.
    bool is_passed(const Screen& screen, int x, int y) const {
        if (ray_.past_lamps && shows_lamp(screen, x, y)) return true;
        const Screen* behind = screen.behind();
        return behind != nullptr && line_.comes_nearer() &&
            behind->first_look().objects(x, y) != screen.first_look().objects(x, y);
    }

    /// Returns the hit with the surface at a pixel if the ray is within its thickness.
    std::optional<ScreenHit> meet(const Screen& screen, int i, float t, int x, int y, float near, bool closed) const {
        const std::optional<Vec3> seen = screen.seen(x, y);
        if (!seen) return std::nullopt;
        const Vec3 step = *seen - ray_.p;
        const float depth = screen.depth(x, y);
        const bool inside = closed && near > depth; // the ray came from behind or from the side
        if (!(dot(ray_.n, step) > kSlack * length(step)) && !(inside && !scenery_.is_own(x, y))) return std::nullopt;
        if (inside && screen.turn(x, y) >= kSmallTurn) return std::nullopt; // too little of the surface is visible
        if (inside) return guess(screen, line_.x(t), line_.y(t), line_.distance(t, line_.depth(t)));
        if (closed && dot(screen.normal(x, y), ray_.way) >= 0) return std::nullopt; // the ray passes its silhouette
        const float met = clamp(line_.part_at(depth), line_.part(i - 1), t);
        return ScreenHit{in_pixel(line_.x(met), x), in_pixel(line_.y(met), y), length(step)};
    }

    /// Returns the last pixel of the ray inside the image.
    Pixel last() const {
        for (int i = line_.last(); i >= line_.first(); --i)
            if (const Pixel at = pixel(i); at.valid()) return at;
        const auto [x, y] = scenery_.all.pixel_at(line_.from());
        return {x, y};
    }
    /// Returns the last pixel that shows no light. The surface behind a light is assumed to match the surface beside
    /// it.
    Pixel last_but_lamps() const {
        for (int i = line_.last(); i >= line_.first(); --i)
            if (const Pixel at = pixel(i); at.valid() && !shows_lamp(scenery_.at(at.x, at.y), at.x, at.y)) return at;
        return last();
    }
    /// Returns the last pixel, up to step i, that shows a flat surface behind the ray.
    Pixel last_flat(int i) const {
        for (; i >= line_.first(); --i) {
            const Pixel at = pixel(i);
            if (!at.valid() || scenery_.is_own(at.x, at.y)) continue;
            const Screen& screen = scenery_.at(at.x, at.y);
            const float depth = screen.depth(at.x, at.y);
            if (!(depth < kInfinity)) return {}; // the surface in front of which the ray was ends here
            if (!goes_on_flat(screen, at.x, at.y)) continue;
            if (std::max(line_.depth(line_.part(i - 1)), line_.depth(line_.part(i))) < depth) return at;
        }
        return {};
    }
    /// Returns the pixel of a step, or an invalid one if rounding moves it out of the image.
    Pixel pixel(int step) const {
        const float t = line_.part(step), fx = line_.x(t), fy = line_.y(t);
        return scenery_.all.contains(fx, fy) ? Pixel{static_cast<int>(fx), static_cast<int>(fy)} : Pixel{};
    }

    /// Returns the hit with the plane of a pixel's flat surface beyond the distance `from`, with that pixel's color.
    std::optional<ScreenHit> meets_flat(Pixel at, float from) const {
        const Screen& screen = scenery_.at(at.x, at.y);
        const float crossed = meets_plane(screen, ray_.p, ray_.way, at.x, at.y);
        if (!(crossed > from) || crossed == kInfinity || !scene_.contains(ray_.p + ray_.way * crossed))
            return std::nullopt;
        return guess(screen, middle(at.x), middle(at.y), crossed);
    }
    /// Returns the hit with the extrapolated flat surface of a pixel, with the color of the flat-surface pyramid.
    std::optional<ScreenHit> goes_on(Pixel at, float from) const {
        const auto hit = at.valid() ? meets_flat(at, from) : std::nullopt;
        return hit ? std::optional(of_hidden(flat_at(*hit, *hit))) : std::nullopt;
    }

    std::optional<ScreenHit> beyond_edge() const {
        const Pixel end = last(), shown = last_but_lamps();
        const Screen& screen = scenery_.at(shown.x, shown.y);
        const bool own = scenery_.is_own(shown.x, shown.y);
        if (!own && !screen.seen(shown.x, shown.y)) return std::nullopt;
        if (hidden_from_ >= 0) {
            if (const auto hit = goes_on(last_flat(line_.last()), hidden_from_)) return hit;
            if (ends_far_off()) return past_what_hides(end);
            // The ray emerged in front of the viewer.
            return line_.leaves() ? std::optional(at_end(shown)) : std::nullopt;
        }
        const bool flat = goes_on_flat(screen, shown.x, shown.y); // otherwise a curved object is in front of it there
        if (!own && (!flat || !line_.leaves()))
            if (const auto hit = goes_on(flat ? shown : last_flat(line_.last()), 0)) return hit;
        return line_.leaves() ? along_edge(end) : std::nullopt;
    }

    /// Handles a ray that leaves the image in front of the surface at the edge, or over the mirror itself. It tests
    /// the flat surfaces along the edge, at increasing offsets, that extend to the ray. It returns the nearest hit
    /// among those up to a little beyond the first one found.
    std::optional<ScreenHit> along_edge(Pixel end) const {
        const bool at_side = line_.leaves_at_side();
        const float t = line_.part(line_.last()), left = line_.distance(t, line_.depth(t));
        std::optional<ScreenHit> nearest;
        for (int i = 0, most = at_side ? scenery_.all.height() : scenery_.all.width(); i < most; i += 1 + i / 4)
            for (const int step : {-i, i}) {
                const Pixel at = at_side ? Pixel{end.x, end.y + step} : Pixel{end.x + step, end.y};
                const std::optional<ScreenHit> hit = flat_beyond(at, i == 0 ? 0 : left);
                if (!hit || (nearest && nearest->distance <= hit->distance) ||
                    !is_before_plane(edge_before(*hit, end), at)) continue;
                if (!nearest) most = std::min(most, 2 * i + kBesideFirst);
                nearest = hit;
            }
        return nearest ? std::optional(of_hidden(flat_at(*nearest, *nearest))) : std::nullopt;
    }
    /// Returns the hit with the flat surface of an edge pixel beyond `left`, the distance at which the ray leaves the
    /// image.
    std::optional<ScreenHit> flat_beyond(Pixel at, float left) const {
        if (!scenery_.all.contains(middle(at.x), middle(at.y)) || scenery_.is_own(at.x, at.y)) return std::nullopt;
        return goes_on_flat(scenery_.at(at.x, at.y), at.x, at.y) ? meets_flat(at, left) : std::nullopt;
    }
    /// Returns whether the surface at one pixel is on or in front of the plane of another, which may then continue
    /// behind it.
    bool is_before_plane(Pixel at, Pixel other) const {
        const Screen& screen = scenery_.at(other.x, other.y);
        const std::optional<Vec3> seen = scenery_.at(at.x, at.y).seen(at.x, at.y), on = screen.seen(other.x, other.y);
        return seen && on && dot(screen.normal(other.x, other.y), *seen - *on) >= -kSlack * length(*seen - *on);
    }
    /// Returns the edge pixel nearest to a hit outside the image, or `end` if the hit is beside or behind the viewer.
    Pixel edge_before(const ScreenHit& hit, Pixel end) const {
        const Vec3 place = scenery_.all.project(ray_.p + ray_.way * hit.distance);
        if (!(place.z > scenery_.all.near())) return end;
        const auto [x, y] = scenery_.all.pixel_at(place);
        return line_.leaves_at_side() ? Pixel{end.x, y} : Pixel{x, end.y};
    }

    /// Returns whether the ray's end is inside the image and away from the viewer.
    bool ends_far_off() const { return !line_.leaves() && !line_.comes_nearer(); }
    /// Handles a ray that is hidden up to its end. It hits the first flat surface beyond the occluder whose plane it
    /// crosses, or the background.
    std::optional<ScreenHit> past_what_hides(Pixel end) const {
        for (int i = line_.last() + 1;; ++i) {
            const Pixel at = pixel(i);
            if (!at.valid()) return at_end(end);
            const Screen& screen = scenery_.at(at.x, at.y);
            if (!screen.seen(at.x, at.y)) return std::nullopt;
            if (scenery_.is_own(at.x, at.y) || !goes_on_flat(screen, at.x, at.y)) continue;
            if (const auto hit = goes_on(at, hidden_from_)) return hit;
        }
    }
    ScreenHit at_end(Pixel end) const {
        return of_hidden(guess(scenery_.at(end.x, end.y), middle(end.x), middle(end.y), hidden_from_));
    }

    /// Returns a hit at a distance with the color of a pixel, as a guess.
    ScreenHit guess(const Screen& screen, float x, float y, float distance) const {
        const std::optional<Vec3> seen = screen.seen(static_cast<int>(x), static_cast<int>(y));
        return {x, y, distance, seen ? length(*seen - ray_.p - ray_.way * distance) : 0.0f};
    }
    /// Returns whether another object begins behind the position's object on either side of the ray.
    bool at_own_edge(float fx, float fy) const {
        const auto [x, y] = scenery_.all.pixel_at({fx, fy, 0});
        const std::uint32_t object = scenery_.at(x, y).first_look().objects(x, y);
        for (const float side : {-1.0f, 1.0f}) {
            const auto [i, k] = scenery_.all.pixel_at({fx - side * line_.step_y(), fy + side * line_.step_x(), 0});
            const Screen& screen = scenery_.at(i, k);
            if (screen.first_look().objects(i, k) != object && screen.depth(i, k) > scenery_.at(x, y).depth(x, y))
                return true;
        }
        return false;
    }
    /// Moves the hit of a flat surface to its projected position. In the flat-surface pyramid, surfaces continue
    /// behind curved objects and beyond the image's edge. Returns `otherwise` behind a flat object and at the
    /// surface's own border.
    ScreenHit flat_at(ScreenHit hit, const ScreenHit& otherwise) const {
        const Vec3 place = scenery_.all.project(ray_.p + ray_.way * hit.distance);
        if (!(place.z > 0) || !scenery_.all.contains(place.x, place.y)) {
            const Pixel end = last();
            hit.x = middle(end.x), hit.y = middle(end.y);
            return hit;
        }
        const auto [x, y] = scenery_.all.pixel_at(place);
        const Screen& there = scenery_.at(x, y);
        if (is_flat(there, x, y) && there.depth(x, y) < (1 - kSameSurface) * place.z) return otherwise;
        if (at_own_edge(hit.x, hit.y)) return otherwise;
        if (hidden_from_ >= 0) hit.gap = kHiddenBlur * std::min(hit.gap, hit.distance - hidden_from_);
        hit.x = place.x, hit.y = place.y;
        return hit;
    }
    /// Moves the hit away from the occluder, so that even a blurred lookup excludes the occluder's color.
    ScreenHit beside_edge(ScreenHit hit, float depth) const {
        const float most = 0.1f * static_cast<float>(scenery_.all.width());
        const float aside = std::min(0.5f * kGuessBlur * hit.gap / scenery_.all.pixel_size(depth), most);
        const float x = hit.x + aside * line_.step_x(), y = hit.y + aside * line_.step_y();
        if (scenery_.all.contains(x, y)) hit.x = x, hit.y = y;
        return hit;
    }
    static ScreenHit of_hidden(ScreenHit hit) {
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

    const Scenery& scenery_;
    const Box3& scene_;
    ScreenRay ray_;
    Crossing line_;
    float per_step_x_, per_step_y_; ///< steps per pixel
    /// Stores the pyramid level of the next block, and the step at which to test it after the last block was not
    /// skipped.
    int level_ = kLeastLevel, look_again_ = 3;
    int in_front_ = 0; ///< last step in front of the visible surface
    float hidden_from_ = -1; ///< distance at which the ray became hidden; negative: it did not
};

} // namespace

bool Scenery::one_object(float x, float y, float reach) const {
    const auto object_at = [&](float i, float k) {
        const auto [column, row] = all.pixel_at({i, k, 0});
        return at(column, row).first_look().objects(column, row);
    };
    const std::uint32_t seen = object_at(x, y);
    const auto same = [&](float dx, float dy) { return object_at(x + dx * reach, y + dy * reach) == seen; };
    return same(-1, -1) && same(1, -1) && same(-1, 1) && same(1, 1);
}

bool Scenery::own_within(float x, float y, float reach) const {
    if (without != nullptr) return false; // the layer without this object does not contain it
    for (const float dx : {-reach, reach})
        for (const float dy : {-reach, reach}) {
            const auto [column, row] = all.pixel_at({x + dx, y + dy, 0});
            if (is_own(column, row)) return true;
        }
    return false;
}

float Scenery::width_beside_own(float x, float y, float width) const {
    return own_within(x, y, 0) ? width : widest(width, [&](float wide) { return !own_within(x, y, 2 * wide); });
}

float Scenery::width_within(float x, float y, float width) const {
    // The reach is that of the coarser mip level, between its pixels.
    return widest(width, [&](float wide) { return one_object(x, y, 2 * wide); });
}

std::optional<ScreenHit> trace_screen(const Scenery& scenery, const Box3& scene, const ScreenRay& ray) {
    return ScreenTrace(scenery, scene, ray).follow();
}

} // namespace duet::raster
