#include "common/medium/medium.h"

#include <algorithm>

namespace duet {

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

} // namespace duet
