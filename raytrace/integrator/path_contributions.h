// PathContributions records what each step of a path contributed: the light found after it, and the rays that this
// took.
#pragma once

#include "raytrace/integrator/light_sampling.h"
#include "raytrace/integrator/path_state.h"

#include <vector>

namespace duet::raytrace {

/// Records a scattering from which a path continued. Its values are those of the path without roulette.
struct PathStep {
    bool first = false;   ///< at the first hit, where there is no roulette
    float throughput = 0; ///< throughput after the scattering, without the effect of refraction (see survival())
    float weight = 1;     ///< 1 / the probability that roulette let the path get here and continue
    float light = 0;      ///< light found from here on; the mean of the channels
    float next_rays = 0;  ///< rays from here to the next step, including shadow rays
};

/// Logs one path, like PathLog, which records its steps.
class PathContributions {
public:
    void vertex(const Vertex&, const Hit&, int depth) {
        count_ray();
        first_ = depth == 0;
    }
    void escape(const Ray&, int) { count_ray(); }
    void light_found(Rgb, float, Rgb light) { add_light(light); }
    void no_light_sample(const char*) {}
    void light_sample(const LightLiSample&, Rgb, bool, float, Rgb light) {
        count_ray();
        add_light(light);
    }
    void scattered(const Vertex&, const BsdfSample&, Vec3, const PathState& state) {
        steps_.push_back({first_, survival(state.throughput, state.refraction, 1.0f) / weight_, weight_});
    }
    void roulette(float probability, bool survived) {
        if (!survived) return steps_.pop_back();
        weight_ /= probability;
        steps_.back().weight = weight_;
    }
    void end(const char*) {}

    const std::vector<PathStep>& steps() const { return steps_; }
    double light() const { return light_; }               ///< light of the whole path, mean of the channels
    double camera_rays() const { return camera_rays_; }   ///< rays before the first step

private:
    void count_ray() {
        if (steps_.empty())
            ++camera_rays_;
        else
            ++steps_.back().next_rays;
    }
    void add_light(Rgb light) {
        const float mean = (light.r + light.g + light.b) / 3;
        for (PathStep& step : steps_) step.light += mean / step.weight;
        light_ += static_cast<double>(mean);
    }

    std::vector<PathStep> steps_;
    float weight_ = 1;
    double light_ = 0, camera_rays_ = 0;
    bool first_ = false;
};

/// Traces the path of a camera ray and logs it in `contributions` (path.cpp).
void record_path_contributions(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler,
                               PathContributions& contributions);

} // namespace duet::raytrace
