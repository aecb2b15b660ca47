#include "common/medium/medium.h"

#include <algorithm>
#include <cmath>

namespace duet {

namespace {

// Shortens an interval to where a coordinate of the ray lies between two planes.
void clip(Interval& interval, float origin, float direction, float low, float high) {
    if (direction == 0) {
        if (!(low <= origin && origin <= high)) interval.end = interval.begin;
        return;
    }
    const float a = (low - origin) / direction, b = (high - origin) / direction;
    interval.begin = std::max(interval.begin, std::min(a, b));
    interval.end = std::min(interval.end, std::max(a, b));
}

// Returns the optical depth of a distance, which may be infinite, for a coefficient, which may be 0.
float optical_depth(float coefficient, float distance) { return coefficient > 0 ? coefficient * distance : 0.0f; }

} // namespace

Interval overlap(const Box3& box, const Ray& ray, float t_end) {
    Interval interval{0, t_end};
    clip(interval, ray.origin.x, ray.direction.x, box.low.x, box.high.x);
    clip(interval, ray.origin.y, ray.direction.y, box.low.y, box.high.y);
    clip(interval, ray.origin.z, ray.direction.z, box.low.z, box.high.z);
    return interval;
}

MediumStretch stretch_at(std::span<const Medium> media, const Ray& ray, float t, float t_end) {
    MediumStretch stretch;
    stretch.end = t_end;
    for (const Medium& medium : media) {
        const Interval inside = overlap(medium.box, ray, t_end);
        if (inside.empty() || inside.end <= t) continue;
        if (inside.begin > t) {
            stretch.end = std::min(stretch.end, inside.begin);
            continue;
        }
        stretch.end = std::min(stretch.end, inside.end);
        stretch.scattering += medium.scattering;
        stretch.absorption += medium.absorption;
        stretch.emission += medium.absorption * medium.radiance;
    }
    return stretch;
}

Rgb transmittance(std::span<const Medium> media, const Ray& ray, float t_end) {
    Rgb depth;
    for (const Medium& medium : media) {
        const Interval inside = overlap(medium.box, ray, t_end);
        if (inside.empty()) continue;
        const float distance = inside.end - inside.begin;
        const Rgb extinction = medium.scattering + medium.absorption;
        depth += Rgb(optical_depth(extinction.r, distance), optical_depth(extinction.g, distance),
                     optical_depth(extinction.b, distance));
    }
    return {std::exp(-depth.r), std::exp(-depth.g), std::exp(-depth.b)};
}

} // namespace duet
