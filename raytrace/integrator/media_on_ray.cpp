#include "raytrace/integrator/media_on_ray.h"

#include <algorithm>

namespace duet::raytrace {

MediumOnRay::MediumOnRay(const Medium& medium, const Ray& ray, float t_end)
    : medium_(&medium), inside_(overlap(medium.box, ray, t_end)) {
    if (medium.density && !inside_.empty()) density_.emplace(*medium.density, medium.box, ray, inside_);
}

PassedColumn MediumOnRay::follow(float from, float column) {
    if (!density_) {
        const float length = inside_.end - from;
        return column < length ? PassedColumn{from + column, column} : PassedColumn{kInfinity, length};
    }
    const double before = from > inside_.begin ? density_->column(from) : 0;
    const DensityGrid::Reached reached = density_->follow(before + static_cast<double>(column));
    return {reached.t, static_cast<float>(reached.column - before)};
}

float MediumOnRay::passed_by(float from, float column) {
    if (!density_) return follow(from, column).t;
    const double before = from > inside_.begin ? density_->column(from) : 0;
    return density_->passed_by(before + static_cast<double>(column));
}

float MediumOnRay::column(float from, float to) {
    const float begin = std::max(from, inside_.begin), end = std::min(to, inside_.end);
    if (!(begin < end)) return 0;
    if (!density_) return end - begin;
    const double before = begin > inside_.begin ? density_->column(begin) : 0;
    return static_cast<float>(density_->column(end) - before);
}

MediaOnRay::MediaOnRay(std::span<const Medium> media, const Ray& ray, float t_end) : ray_(ray), t_end_(t_end) {
    media_.reserve(media.size());
    for (const Medium& medium : media) media_.emplace_back(medium, ray, t_end);
}

} // namespace duet::raytrace
