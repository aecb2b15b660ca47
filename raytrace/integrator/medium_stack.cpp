#include "raytrace/integrator/medium_stack.h"

#include <algorithm>
#include <cmath>

namespace duet::raytrace {

const Dielectric& MediumStack::dielectric(std::uint32_t material) const {
    return std::get<Dielectric>(plan_->scene.materials[material]);
}

const Dielectric* MediumStack::current_medium(std::int64_t without) const {
    const Dielectric* found = nullptr;
    for (std::size_t i = count_; i-- > 0;) { // of equal priorities, the last entered wins
        if (static_cast<std::int64_t>(materials_[i]) == without) {
            without = -1;
            continue;
        }
        const Dielectric& candidate = dielectric(materials_[i]);
        if (found == nullptr || candidate.priority > found->priority) found = &candidate;
    }
    return found;
}

void MediumStack::cross(std::uint32_t material, bool inwards) {
    if (inwards) {
        if (count_ < materials_.size())
            materials_[count_++] = material;
        else
            ++overflow_;
        return;
    }
    if (overflow_ > 0) { // the last entered is left first
        --overflow_;
        return;
    }
    const auto end = materials_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto last = std::find(std::make_reverse_iterator(end), materials_.rend(), material);
    if (last == materials_.rend()) return; // the path started inside this dielectric
    std::copy(last.base(), end, last.base() - 1);
    --count_;
}

Rgb MediumStack::transmittance(float distance) const {
    const Dielectric* medium = current_medium();
    if (medium == nullptr || is_black(medium->absorption)) return Rgb(1.0f);
    const auto transmitted = [distance](float absorption) {
        return absorption > 0 ? std::exp(-absorption * distance) : 1.0f;
    };
    return {transmitted(medium->absorption.r), transmitted(medium->absorption.g), transmitted(medium->absorption.b)};
}

Hit MediumStack::skip_ignored_boundaries(Ray& ray, Hit hit, Rgb& throughput, int& ignored) {
    const Scene& scene = plan_->scene;
    for (ignored = 0;; ++ignored) {
        relative_ = 0;
        if (count_ > 0) throughput *= transmittance(hit.valid() ? hit.t : std::numeric_limits<float>::infinity());
        if (!hit.valid()) return hit;
        const std::uint32_t material = material_index(scene, hit.object, hit.primitive);
        const auto* boundary = std::get_if<Dielectric>(&scene.materials[material]);
        if (boundary == nullptr || boundary->thin || boundary->priority == 0) return hit;
        const SurfacePoint point = surface_point(scene, ray, hit, nullptr, plan_->details[material]);
        const bool inwards = dot(point.ng, ray.direction) < 0;
        const Dielectric* around = current_medium(inwards ? -1 : static_cast<std::int64_t>(material));
        if (around == nullptr || around->priority == 0 || ignored == kMaxIgnored) return hit;
        if (around->priority <= boundary->priority) {
            relative_ = boundary->ior / around->ior;
            return hit;
        }
        cross(material, inwards);
        ray.origin = offset_origin(point, ray.direction);
        ray.t_min = 0;
        hit = plan_->prepared.accelerator.closest(ray);
    }
}

} // namespace duet::raytrace
