#include "raster/screen/screen_reflection.h"

#include "raster/screen/crossing.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

constexpr float kSlack = 2e-3f; ///< of the distance between two points: lower is no step over a plane, but rounding
constexpr float kHiddenBlur = 12; ///< ScreenHit::gap for each metre behind the nearer side of what hides: deep in, means alone are known
constexpr int kBesideFirst = 4; ///< pixels along the edge that are looked at beyond twice as far as the first that a ray goes on to
constexpr int kLeastLevel = 3, kMostLevel = 8; ///< blocks of 2^level pixels of the picture before which a ray is are passed at once

/// The distance at which a ray comes through the plane of what a pixel sees, from its front; infinity where it does not.
float meets_plane(const Screen& screen, Vec3 p, Vec3 way, int x, int y) {
    const std::optional<Vec3> seen = screen.seen(x, y);
    if (!seen) return kInfinity;
    const Vec3 n = screen.normal(x, y);
    const float towards = -dot(n, way), height = dot(n, p - *seen);
    return towards > 1e-3f && height > 0 ? height / towards : kInfinity;
}

/// Whether what a pixel shows is a lamp that rays look for: that has an end, wherever it is.
bool shows_lamp(const Screen& screen, int x, int y) { return screen.first_look().lamps(x, y) != 0; }
/// Whether what a pixel shows may be guessed to go on.
bool goes_on_flat(const Screen& screen, int x, int y) { return !shows_lamp(screen, x, y) && is_flat(screen, x, y); }

/// The greatest width that fits, of those that fall by a fixed part from `width` on; one, where none does or it is not finite.
template <typename F> float widest(float width, const F& fits) {
    if (!(width < kInfinity)) return 1;
    for (; width > 1; width *= 0.7f)
        if (fits(width)) return width;
    return 1;
}

/// One ray on its way.
class ScreenTrace {
public:
    ScreenTrace(const Scenery& scenery, const Box3& scene, const ScreenRay& ray)
        : scenery_(scenery), scene_(scene), ray_(ray), line_(scenery.all, ray.p, ray.way), per_step_x_(per(line_.step_x())),
          per_step_y_(per(line_.step_y())) {}

    std::optional<ScreenHit> follow() {
        if (!(line_.from().z > 0)) return std::nullopt;
        if (!line_.moves()) return in_one_pixel();
        float before = line_.nearness(line_.part(line_.first() - 1));
        for (int i = line_.first(); i <= line_.last(); ++i) {
            i += passed_at_once(i, before);
            const float t = line_.part(i), fx = line_.x(t), fy = line_.y(t), nearness = line_.nearness(t);
            if (scenery_.all.contains(fx, fy) && (i > 1 || !ray_.from_picture)) { // (outside only by rounding)
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
        const float beyond = scenery_.at(x, y).depth(x, y) - from.z, deeper = scenery_.all.homogeneous_change(ray_.way)[2];
        return deeper > 0 && beyond > 0 && beyond < kInfinity ? std::optional(ScreenHit{from.x, from.y, beyond / deeper}) : std::nullopt;
    }

    /// Steps from the i-th to the last one in a block of the picture before all of which the ray stays: after one that is passed
    /// larger ones are looked at, where it does not pass them smaller ones. `before`: nearness at the step before, then at the last.
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
    /// How many steps from a place stay in its block of 2^level pixels, or fewer.
    int steps_in_block(float x, float y, int level) const {
        const auto side = static_cast<float>(1 << level), per_side = 1 / side;
        const auto along = [&](float at, float step, float per_step) {
            const float from_edge = at - side * std::floor(at * per_side);
            return (step > 0 ? side - from_edge : from_edge) * per_step;
        };
        return static_cast<int>(std::min({along(x, line_.step_x(), per_step_x_), along(y, line_.step_y(), per_step_y_), 1e6f}) - 0.01f);
    }

    /// A step at which the ray may not be before what is seen.
    std::optional<ScreenHit> visit(int i, float t, float fx, float fy) {
        const auto x = static_cast<int>(fx), y = static_cast<int>(fy);
        const Screen& screen = scenery_.at(x, y);
        const float before = line_.depth(line_.part(i - 1)), depth = line_.depth(t), distance = line_.distance(t, depth);
        const float seen_depth = screen.depth(x, y), far = std::max(before, depth), near = std::min(before, depth);
        const float known = screen.thickness(x, y), thickness = known > 0 ? known : std::max(2 * (far - near), kThickness * seen_depth);
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
        const auto flat = goes_on(last_flat(i), hidden_from_); // it may have gone under that, hidden
        return flat && flat->distance < hit->distance ? flat : hit;
    }

    float distance_at(int step) const {
        const float t = line_.part(step);
        return std::max(line_.distance(t, line_.depth(t)), 0.0f); // at its start rounding may have it before that
    }

    /// Whether a pixel shows what is not met: a lamp, or glass that the ray comes through the other way, for what that shows the
    /// viewer it does not show the ray.
    bool is_passed(const Screen& screen, int x, int y) const {
        if (ray_.past_lamps && shows_lamp(screen, x, y)) return true;
        const Screen* behind = screen.behind();
        return behind != nullptr && line_.comes_nearer() && behind->first_look().objects(x, y) != screen.first_look().objects(x, y);
    }

    /// What is seen at a pixel, where the ray is no nearer and not behind it.
    std::optional<ScreenHit> meet(const Screen& screen, int i, float t, int x, int y, float near, bool closed) const {
        const std::optional<Vec3> seen = screen.seen(x, y);
        if (!seen) return std::nullopt;
        const Vec3 step = *seen - ray_.p;
        const float depth = screen.depth(x, y);
        const bool inside = closed && near > depth; // it has come from behind or beside
        if (!(dot(ray_.n, step) > kSlack * length(step)) && !(inside && !scenery_.is_own(x, y))) return std::nullopt;
        if (inside && screen.turn(x, y) >= kSmallTurn) return std::nullopt; // too little of it is seen to tell
        if (inside) return guess(screen, line_.x(t), line_.y(t), line_.distance(t, line_.depth(t)));
        if (closed && dot(screen.normal(x, y), ray_.way) >= 0) return std::nullopt; // it comes past its edge
        const float met = clamp(line_.part_at(depth), line_.part(i - 1), t);
        return ScreenHit{in_pixel(line_.x(met), x), in_pixel(line_.y(met), y), length(step)};
    }

    /// The last pixel that it has come to.
    Pixel last() const {
        for (int i = line_.last(); i >= line_.first(); --i)
            if (const Pixel at = pixel(i); at.valid()) return at;
        const auto [x, y] = scenery_.all.pixel_at(line_.from());
        return {x, y};
    }
    /// The last one that shows no lamp: what is behind a lamp is what is beside it.
    Pixel last_but_lamps() const {
        for (int i = line_.last(); i >= line_.first(); --i)
            if (const Pixel at = pixel(i); at.valid() && !shows_lamp(scenery_.at(at.x, at.y), at.x, at.y)) return at;
        return last();
    }
    /// The last one, up to a step, that shows a flat surface that it is before.
    Pixel last_flat(int i) const {
        for (; i >= line_.first(); --i) {
            const Pixel at = pixel(i);
            if (!at.valid() || scenery_.is_own(at.x, at.y)) continue;
            const Screen& screen = scenery_.at(at.x, at.y);
            const float depth = screen.depth(at.x, at.y);
            if (!(depth < kInfinity)) return {}; // what it was before has ended there
            if (!goes_on_flat(screen, at.x, at.y)) continue;
            if (std::max(line_.depth(line_.part(i - 1)), line_.depth(line_.part(i))) < depth) return at;
        }
        return {};
    }
    /// None where rounding takes it out of the picture.
    Pixel pixel(int step) const {
        const float t = line_.part(step), fx = line_.x(t), fy = line_.y(t);
        return scenery_.all.contains(fx, fy) ? Pixel{static_cast<int>(fx), static_cast<int>(fy)} : Pixel{};
    }

    /// Where it meets the plane of a flat surface that a pixel shows, farther than `from`: as that pixel shows it,
    std::optional<ScreenHit> meets_flat(Pixel at, float from) const {
        const Screen& screen = scenery_.at(at.x, at.y);
        const float crossed = meets_plane(screen, ray_.p, ray_.way, at.x, at.y);
        if (!(crossed > from) || crossed == kInfinity || !scene_.contains(ray_.p + ray_.way * crossed)) return std::nullopt;
        return guess(screen, middle(at.x), middle(at.y), crossed);
    }
    /// and as the flat look does.
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
            return line_.leaves() ? std::optional(at_end(shown)) : std::nullopt; // it has come out before the viewer
        }
        const bool flat = goes_on_flat(screen, shown.x, shown.y); // else something round stands before it there
        if (!own && (!flat || !line_.leaves()))
            if (const auto hit = goes_on(flat ? shown : last_flat(line_.last()), 0)) return hit;
        return line_.leaves() ? along_edge(end) : std::nullopt;
    }

    /// Of a ray that leaves the picture before what the edge shows there, or over the mirror itself: of what is seen along the edge, at
    /// distances that grow, and goes on there to the ray, what that meets first, as it seems a little beyond the first that it meets.
    std::optional<ScreenHit> along_edge(Pixel end) const {
        const bool at_side = line_.leaves_at_side();
        const float t = line_.part(line_.last()), left = line_.distance(t, line_.depth(t));
        std::optional<ScreenHit> nearest;
        for (int i = 0, most = at_side ? scenery_.all.height() : scenery_.all.width(); i < most; i += 1 + i / 4)
            for (const int step : {-i, i}) {
                const Pixel at = at_side ? Pixel{end.x, end.y + step} : Pixel{end.x + step, end.y};
                const std::optional<ScreenHit> hit = flat_beyond(at, i == 0 ? 0 : left);
                if (!hit || (nearest && nearest->distance <= hit->distance) || !is_before_plane(edge_before(*hit, end), at)) continue;
                if (!nearest) most = std::min(most, 2 * i + kBesideFirst);
                nearest = hit;
            }
        return nearest ? std::optional(of_hidden(flat_at(*nearest, *nearest))) : std::nullopt;
    }
    /// Where what a pixel of the edge shows, if flat, is met farther than `left`, where the ray leaves the picture.
    std::optional<ScreenHit> flat_beyond(Pixel at, float left) const {
        if (!scenery_.all.contains(middle(at.x), middle(at.y)) || scenery_.is_own(at.x, at.y)) return std::nullopt;
        return goes_on_flat(scenery_.at(at.x, at.y), at.x, at.y) ? meets_flat(at, left) : std::nullopt;
    }
    /// Whether what a pixel shows stands on or before the plane of what another does, which may go on behind it.
    bool is_before_plane(Pixel at, Pixel other) const {
        const Screen& screen = scenery_.at(other.x, other.y);
        const std::optional<Vec3> seen = scenery_.at(at.x, at.y).seen(at.x, at.y), on = screen.seen(other.x, other.y);
        return seen && on && dot(screen.normal(other.x, other.y), *seen - *on) >= -kSlack * length(*seen - *on);
    }
    /// The pixel of the edge next to a place outside the picture; beside the viewer or behind him, `end`.
    Pixel edge_before(const ScreenHit& hit, Pixel end) const {
        const Vec3 place = scenery_.all.project(ray_.p + ray_.way * hit.distance);
        if (!(place.z > scenery_.all.near())) return end;
        const auto [x, y] = scenery_.all.pixel_at(place);
        return line_.leaves_at_side() ? Pixel{end.x, y} : Pixel{x, end.y};
    }

    /// Whether the picture shows where the ray goes to: no edge of it cuts it off.
    bool ends_far_off() const { return !line_.leaves() && !line_.comes_nearer(); }
    /// Hidden up to its end, it meets the first flat surface past what hides it whose plane it crosses, or what is behind all.
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

    /// What a pixel shows stands for what is met at a distance.
    ScreenHit guess(const Screen& screen, float x, float y, float distance) const {
        const std::optional<Vec3> seen = screen.seen(static_cast<int>(x), static_cast<int>(y));
        return {x, y, distance, seen ? length(*seen - ray_.p - ray_.way * distance) : 0.0f};
    }
    /// Whether across the ray's way another object than at a place begins behind it.
    bool at_own_edge(float fx, float fy) const {
        const auto [x, y] = scenery_.all.pixel_at({fx, fy, 0});
        const std::uint32_t object = scenery_.at(x, y).first_look().objects(x, y);
        for (const float side : {-1.0f, 1.0f}) {
            const auto [i, k] = scenery_.all.pixel_at({fx - side * line_.step_y(), fy + side * line_.step_x(), 0});
            const Screen& screen = scenery_.at(i, k);
            if (screen.first_look().objects(i, k) != object && screen.depth(i, k) > scenery_.at(x, y).depth(x, y)) return true;
        }
        return false;
    }
    /// A flat surface's hit, moved to where it would be seen: in the flat look surfaces go on behind round things as they are about
    /// them, and at the picture's edge as they are there. `otherwise` behind a flat thing, and at the surface's own edge.
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
    /// What hides the ray ends before this place: its colour is none of what is met, however blurred that is.
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
    /// What is met is what that pixel shows, not the one before.
    static float in_pixel(float at, int pixel) { return clamp(at, static_cast<float>(pixel), static_cast<float>(pixel) + 0.99f); }
    static float per(float step) { return std::min(1 / std::abs(step), 1e9f); } ///< (of no step, infinity: the bound)
    static float middle(int pixel) { return static_cast<float>(pixel) + 0.5f; }

    const Scenery& scenery_;
    const Box3& scene_;
    ScreenRay ray_;
    Crossing line_;
    float per_step_x_, per_step_y_; ///< steps a pixel
    int level_ = kLeastLevel, look_again_ = 3; ///< of the block to be looked at next; the step from which on, as the last was not passed
    int in_front_ = 0;       ///< the last step before what is seen
    float hidden_from_ = -1; ///< at which distance it went behind that; negative: it did not
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
    if (without != nullptr) return false; // what the look does not see
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
    return widest(width, [&](float wide) { return one_object(x, y, 2 * wide); }); // of the coarser level, between its pixels
}

std::optional<ScreenHit> trace_screen(const Scenery& scenery, const Box3& scene, const ScreenRay& ray) {
    return ScreenTrace(scenery, scene, ray).follow();
}

} // namespace duet::raster
