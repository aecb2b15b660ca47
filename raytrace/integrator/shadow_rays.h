// Shadow rays that wait to be sent together.
#pragma once

#include "raytrace/integrator/light_sampling.h"

#include <vector>

namespace duet::raytrace {

class ShadowRays {
public:
    explicit ShadowRays(const RenderPlan& plan) : plan_(plan) {}

    /// A ray that leaves the surface point p to an arrival's light, and what it brings to which path.
    void add(std::uint32_t path, const Ray& ray, Vec3 p, const Arrival& arrival, Rgb light) {
        waiting_.push_back({path, light, ShadowEnd(plan_.scene, ray, p, arrival)});
        rays_.push_back(ray);
    }
    /// Sends all. Calls arrived(path, light) for each that nothing stands in the way of, in order; none is left.
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
    bool reached(std::size_t i) const; ///< as `reaches`

    const RenderPlan& plan_;
    std::vector<Waiting> waiting_;
    std::vector<Ray> rays_;  ///< parallel to it
    std::vector<Hit> hits_;  ///< the nearest, where they have been looked for
    std::vector<std::uint32_t> all_; ///< indices of all
};

} // namespace duet::raytrace
