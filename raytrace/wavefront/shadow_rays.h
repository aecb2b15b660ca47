// Declares ShadowRays, which collects shadow rays to trace them together.
#pragma once

#include "raytrace/integrator/light_sampling.h"

#include <vector>

namespace duet::raytrace {

/// Collects shadow rays, to trace them together.
class ShadowRays {
public:
    explicit ShadowRays(const RenderPlan& plan) : plan_(plan) {}

    /// Adds a ray from the surface point p to a light sample, and the light that it adds to a path if it is not
    /// occluded.
    void add(std::uint32_t path, const Ray& ray, Vec3 p, const LightLiSample& light_sample, Rgb light) {
        pending_.push_back({path, light, ShadowRayEnd(plan_.scene, ray, p, light_sample)});
        rays_.push_back(ray);
    }
    /// Traces all rays and calls on_unoccluded(path, light) for each one that is not occluded, in order. The list is
    /// empty afterwards.
    template <typename Unoccluded> void trace(const Unoccluded& on_unoccluded) {
        find_closest_hits();
        for (std::size_t i = 0; i < pending_.size(); ++i)
            if (is_unoccluded(i)) on_unoccluded(pending_[i].path, pending_[i].light);
        pending_.clear();
        rays_.clear();
    }

private:
    struct PendingRay {
        std::uint32_t path;
        Rgb light;
        ShadowRayEnd end;
    };

    void find_closest_hits();
    bool is_unoccluded(std::size_t i) const; ///< see `unoccluded`

    const RenderPlan& plan_;
    std::vector<PendingRay> pending_;
    std::vector<Ray> rays_;  ///< parallel to pending_
    std::vector<Hit> hits_;  ///< closest hits of the rays, if they have been traced
    std::vector<std::uint32_t> indices_; ///< indices of all rays
};

} // namespace duet::raytrace
