// ShadowRays collects shadow rays, to trace them together.
#pragma once

#include "raytrace/integrator/light_sampling.h"

#include <vector>

namespace duet::raytrace {

class ShadowRays {
public:
    explicit ShadowRays(const RenderPlan& plan) : plan_(plan) {}

    /// Adds a ray from the surface point p to a light sample, and the light that it adds to a path if it is not
    /// occluded.
    void add(std::uint32_t path, const Ray& ray, Vec3 p, const Arrival& arrival, Rgb light) {
        waiting_.push_back({path, light, ShadowEnd(plan_.scene, ray, p, arrival)});
        rays_.push_back(ray);
    }
    /// Traces all rays. Calls arrived(path, light) for each that is not occluded, in order. Then the list is empty.
    template <typename Arrived> void send(const Arrived& arrived) {
        look();
        for (std::size_t i = 0; i < waiting_.size(); ++i)
            if (reached(i)) arrived(waiting_[i].path, waiting_[i].light);
        waiting_.clear();
        rays_.clear();
    }

private:
    struct Waiting {
        std::uint32_t path;
        Rgb light;
        ShadowEnd end;
    };

    void look();
    bool reached(std::size_t i) const; ///< see `reaches`

    const RenderPlan& plan_;
    std::vector<Waiting> waiting_;
    std::vector<Ray> rays_;  ///< parallel to waiting_
    std::vector<Hit> hits_;  ///< the closest hits, where they have been traced
    std::vector<std::uint32_t> all_; ///< indices of all rays
};

} // namespace duet::raytrace
