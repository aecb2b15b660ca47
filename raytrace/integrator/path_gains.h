// PathGains records what each step of a path gained: the light found after it, and the rays that this took.
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
class PathGains {
public:
    void vertex(const Vertex&, const Hit&, int depth) {
        send();
        first_ = depth == 0;
    }
    void escape(const Ray&, int) { send(); }
    void found(Rgb, float, Rgb light) { find(light); }
    void no_light_sample(const char*) {}
    void light_sample(const Arrival&, Rgb, bool, float, Rgb light) {
        send();
        find(light);
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
    void send() {
        if (steps_.empty())
            ++camera_rays_;
        else
            ++steps_.back().next_rays;
    }
    void find(Rgb light) {
        const float mean = (light.r + light.g + light.b) / 3;
        for (PathStep& step : steps_) step.light += mean / step.weight;
        light_ += static_cast<double>(mean);
    }

    std::vector<PathStep> steps_;
    float weight_ = 1;
    double light_ = 0, camera_rays_ = 0;
    bool first_ = false;
};

/// Traces the path of a camera ray and logs it in `gains` (path.cpp).
void follow_path(const RenderPlan& plan, const Ray& ray, const Hit& hit, Sampler& sampler, PathGains& gains);

} // namespace duet::raytrace
