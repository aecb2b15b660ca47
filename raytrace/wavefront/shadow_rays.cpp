#include "raytrace/wavefront/shadow_rays.h"

#include "raytrace/acceleration/bvh_leaf.h"

#include <numeric>

namespace duet::raytrace {

void ShadowRays::find_closest_hits() {
    if (!plan_.prepared.accelerator.few_primitives()) return;
    for (std::size_t i = 0; i < rays_.size(); ++i) rays_[i].t_max = pending_[i].end.conservative().t;
    hits_.resize(rays_.size());
    indices_.resize(rays_.size());
    std::iota(indices_.begin(), indices_.end(), 0u);
    plan_.prepared.accelerator.closest_of_incoherent(rays_, indices_, hits_);
    for (Ray& ray : rays_) ray.t_max = kInfinity; // the exact end may lie beyond conservative()
}

bool ShadowRays::is_unoccluded(std::size_t i) const {
    const Ray& ray = rays_[i];
    const ShadowRayEnd& end = pending_[i].end;
    if (!plan_.prepared.accelerator.few_primitives()) return unoccluded(plan_, ray, end);
    const Hit& nearest = hits_[i];
    if (!nearest.valid()) return true;
    if (!end.is_surface()) return false;
    if (!end.is_flat()) return !plan_.prepared.accelerator.occluded(ray, end.exact(ray));
    // exact() is the ray's own hit on a flat light. The light is visible if and only if the closest hit does not
    // precede it.
    const bool is_end =
        nearest.object == end.conservative().object && nearest.primitive == end.conservative().primitive;
    return is_end || !precedes(nearest, end.exact(ray));
}

} // namespace duet::raytrace
