#include "raster/ambient_occlusion.h"

#include "common/sampling/hash.h"
#include "common/sampling/warp.h"
#include "common/vec/frame.h"

#include <algorithm>
#include <cmath>

namespace duet::raster {
namespace {

constexpr float kSlack = 1e-3f;   ///< of the distance between two points: lower is no step over a plane, but rounding
constexpr float kClosest = 3e-4f;  ///< of the distance to the eye: closer points' directions are rounding
constexpr float kFadeFrom = 0.5f; ///< of the radius: where horizons begin to count less

float random(std::uint64_t key, int i) { return unit_float(high_bits(stream_number(key, static_cast<std::uint64_t>(i)))); }

/// The greatest cosine to the viewer of what the picture shows along a line from the point, at least `lowest`.
class HorizonSearch {
public:
    HorizonSearch(const Screen& screen, const OcclusionPoint& point, float radius, int steps)
        : screen_(screen), point_(point), place_(screen.project(point.p)), radius_(radius),
          closest_(kClosest * length(point.p)), steps_(steps) {}

    /// `way`: unit, across the view.
    float operator()(Vec3 way, float lowest, float jitter) const {
        const Vec3 near = screen_.project(point_.p + way * (radius_ * 1e-3f));
        Vec2 step(near.x - place_.x, near.y - place_.y);
        float pixels = std::sqrt(dot(step, step)) * 1e3f; // the radius, in the picture
        if (!(pixels > 1)) return lowest;
        step = step * (1e3f / pixels);
        pixels = std::min(pixels, to_edge(step));
        float highest = lowest;
        for (int i = 0; i < steps_; ++i) {
            const float part = (static_cast<float>(i) + jitter) / static_cast<float>(steps_);
            const float reach = 1 + part * part * pixels; // closer together near the point
            const auto x = static_cast<int>(place_.x + step.x * reach), y = static_cast<int>(place_.y + step.y * reach);
            if (const auto seen = screen_.seen(x, y))
                highest = std::max(highest, cosine(*seen, lowest));
        }
        return highest;
    }

private:
    /// How far the picture goes on in a unit direction, pixels.
    float to_edge(Vec2 step) const {
        const auto along = [](float at, float way, int size) {
            return way == 0 ? kInfinity : ((way > 0 ? static_cast<float>(size) : 0.0f) - at) / way;
        };
        return std::max(std::min(along(place_.x, step.x, screen_.width()), along(place_.y, step.y, screen_.height())), 0.0f);
    }

    float cosine(Vec3 seen, float lowest) const {
        const Vec3 way = seen - point_.p;
        const float distance = length(way);
        if (!(distance > closest_) || distance >= radius_ || dot(point_.n, way) < kSlack * distance) return lowest;
        const float fade = clamp((distance / radius_ - kFadeFrom) / (1 - kFadeFrom), 0.0f, 1.0f);
        return lerp(dot(way, point_.to_viewer) / distance, lowest, fade);
    }

    const Screen& screen_;
    const OcclusionPoint& point_;
    Vec3 place_;
    float radius_, closest_;
    int steps_;
};

/// ∫ cos(θ − γ) |sin θ| dθ from the viewer's direction to a horizon at angle h, twice (Jimenez et al., eq. 7).
float arc(float h, float gamma) { return -std::cos(2 * h - gamma) + std::cos(gamma) + 2 * h * std::sin(gamma); }

} // namespace

float screen_space_occlusion(const Screen& screen, const OcclusionPoint& point, float radius, int samples,
                             std::uint64_t key) {
    const Frame frame = frame_from_normal(point.n);
    int open = 0;
    for (int i = 0; i < samples; ++i) {
        const Vec2 u{(static_cast<float>(i) + random(key, 3 * i)) / static_cast<float>(samples), random(key, 3 * i + 1)};
        const Vec3 q = point.p + frame.to_world(cosine_hemisphere(u)) * (radius * sqr(random(key, 3 * i + 2)));
        const Vec3 place = screen.project(q);
        ++open;
        if (!(place.z > 0) || !screen.contains(place.x, place.y)) continue;
        const int x = static_cast<int>(place.x), y = static_cast<int>(place.y);
        const auto seen = screen.seen(x, y);
        if (!seen || screen.depth(x, y) >= place.z) continue;
        const Vec3 way = *seen - point.p;
        // Far in front of the point it hides the view, but hardly its light.
        const float distance = length(way);
        if (distance > kClosest * length(point.p) && distance < radius && dot(point.n, way) > kSlack * distance) --open;
    }
    return static_cast<float>(open) / static_cast<float>(samples);
}

float horizon_occlusion(const Screen& screen, const OcclusionPoint& point, float radius, int lines, int steps,
                        std::uint64_t key) {
    const HorizonSearch search(screen, point, radius, steps);
    const Vec3 v = point.to_viewer;
    const Frame frame = frame_from_normal(v);
    float seen = 0, all = 0;
    for (int i = 0; i < lines; ++i) {
        const float turn = kPi * (static_cast<float>(i) + random(key, 0)) / static_cast<float>(lines);
        const Vec3 t = frame.s * std::cos(turn) + frame.t * std::sin(turn), across = cross(v, t);
        const Vec3 in_plane = point.n - across * dot(point.n, across); // the normal in the plane of v and t
        const float size = length(in_plane);
        if (!(size > 1e-6f)) continue;
        const float gamma = std::copysign(std::acos(clamp(dot(in_plane, v) / size, -1.0f, 1.0f)), dot(in_plane, t));
        const float right = std::min(gamma + kPi / 2, kPi), left = std::max(gamma - kPi / 2, -kPi); // its own horizon
        const float h2 = std::acos(clamp(search(t, std::cos(right), random(key, 2 * i + 1)), -1.0f, 1.0f));
        const float h1 = -std::acos(clamp(search(-t, std::cos(left), random(key, 2 * i + 2)), -1.0f, 1.0f));
        seen += size * (arc(std::max(h1, left), gamma) + arc(std::min(h2, right), gamma));
        all += size * (arc(left, gamma) + arc(right, gamma));
    }
    return all > 0 ? clamp(seen / all, 0.0f, 1.0f) : 1.0f;
}

} // namespace duet::raster
